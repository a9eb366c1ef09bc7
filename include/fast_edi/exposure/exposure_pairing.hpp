/// \file
/// Finds the exposure message that belongs to each image.
///
/// Exposure messages have no header. The driver sends one right after each image, so the n-th
/// message belongs to the n-th image, whichever of the two arrives first.
///
/// Rules
/// - An image waits for its message until the timeout; then the message counts as missing. A
///   message waits for its image just as long; then it counts as surplus.
/// - After a lost message, every later image gets its successor's message, one period late, and no
///   timeout expires if the period is shorter. So: if at least one image was waiting throughout a
///   timeout, that many messages are missing, and pairing restarts behind the images that waited
///   for them. The same holds for messages.
/// - After a lost image, every later image gets its predecessor's message. So: if throughout a
///   timeout each image found a message that had been waiting for more than half the time since the
///   previous image, one message is surplus.
/// - If no message arrives within the first timeout, images do not wait until one does. That
///   message belongs to an image that did not wait for it; pairing starts at the next image.
/// - A refused message (<= 0 or > 1 s) keeps its place in the order, so that later ones stay with
///   their images; its image gets none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "fast_edi/base/deblur_counters.hpp"

namespace fast_edi {

/// The end of an image's wait.
struct ExposureMatch {
  std::uint64_t image = 0;                ///< the number given to addImage()
  std::optional<std::int64_t> length_ns;  ///< by the image's own message, if it has a valid one
};

class ExposurePairing {
 public:
  /// \param counters exposures_in, _refused, _surplus and _missing are counted there; must outlive
  ///        this object
  ExposurePairing(std::int64_t timeout_ns, DeblurCounters& counters);

  /// Each call appends the images whose wait it ended to \p matches, in order.
  /// \param now_ns never goes back
  void addImage(std::uint64_t image, std::int64_t now_ns, std::vector<ExposureMatch>& matches);
  void addMessage(std::int32_t exposure_us, std::int64_t now_ns,
                  std::vector<ExposureMatch>& matches);
  void advance(std::int64_t now_ns, std::vector<ExposureMatch>& matches);
  /// Ends the wait of all images: no message will come any more.
  void finish(std::vector<ExposureMatch>& matches);

  /// Takes note of a message's value without pairing it.
  void note(std::int32_t exposure_us);
  /// Restarts with the next image or message. The last value received stays.
  void restart();
  void setTimeout(std::int64_t timeout_ns) { timeout_ns_ = timeout_ns; }

  /// The last valid value received.
  std::optional<std::int64_t> last() const { return last_ns_; }

 private:
  struct WaitingImage {
    std::uint64_t image;
    std::int64_t arrival_ns;
  };
  struct WaitingMessage {
    std::optional<std::int64_t> length_ns;
    std::int64_t arrival_ns = 0;
  };

  std::optional<std::int64_t> read(std::int32_t exposure_us);
  void dropImages(std::size_t count, std::vector<ExposureMatch>& matches);
  void dropMessages(std::size_t count);
  bool isOneMessageAhead(std::int64_t now_ns);
  void updateUnmatched(std::int64_t now_ns);
  void restartUnmatched(std::int64_t now_ns);

  DeblurCounters& counters_;
  std::int64_t timeout_ns_;
  std::optional<std::int64_t> last_ns_;

  // At most one of the two holds something.
  std::deque<WaitingImage> images_;
  std::deque<WaitingMessage> messages_;

  bool any_received_ = false;      ///< since the start
  bool without_messages_ = false;  ///< none within the first timeout: images do not wait
  std::optional<std::int64_t> first_image_ns_;

  // The smallest number that waited since unmatched_since_ns_.
  std::size_t min_unmatched_ = 0;
  std::int64_t unmatched_since_ns_ = 0;

  std::optional<std::int64_t> last_image_ns_;   ///< its arrival
  std::optional<std::int64_t> ahead_since_ns_;  ///< each image since then found an old message
};

}  // namespace fast_edi
