/// \file
/// Draws each latent image towards the one before it, carried on by the events between the two.
///
/// With L1' the image before as it was shown, T1 and T2 the lengths of both exposures and l the
/// change of a pixel's level between both references (see level_model.hpp),
///
///     P = L1' exp(l) T2 / T1,    L2' = L2 + w (P - L2)
///
/// Consecutive images then agree better with the events between them, which is what trackers go by
/// that follow an image by its events. Each of them alone is farther from the truth: P has the
/// noise of all the events of the way. Pixels that are saturated in either image stay as they are.
///
/// Complexity. O(events between both references + pixels). Memory once used: 24 B per pixel and two
/// images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/camera_response.hpp"

namespace fast_edi {

class TemporalFusion {
 public:
  /// Longer without a frame, and what events say of the way is worth nothing.
  static constexpr std::int64_t kMaxGap_ns = kNanosecondsPerSecond;

  /// A frame, by what carries an image from one to the next.
  struct Frame {
    LevelInstant reference;        ///< of the image, in event time
    std::int64_t exposure_ns = 0;  ///< > 0
    std::uint64_t epoch = 0;       ///< of the frames' clock
  };

  /// \param image latent image of the frame; changed in place, unless there is none before it, or
  ///        events between the two are missing
  /// \param weight w, within limits::kFilterTemporal
  /// \return whether it was drawn
  bool apply(const Frame& frame, const EventStream& events, const LatentGains::Model& model,
             const CameraResponse& response, double weight, const MutableImageView& image);

  /// The next image has none before it.
  void forget() { last_.clear(); }

  std::size_t memoryBytes() const;

 private:
  bool isBridged(const Frame& frame, const EventStream& events,
                 const MutableImageView& image) const;
  void blend(float weight, const MutableImageView& image);

  Frame last_frame_;
  std::uint64_t last_generation_ = 0;  ///< of the event lists
  StoredImage last_;                   ///< as it was shown; empty: none
  StoredImage carried_;
  LatentGains change_;
  std::vector<float> gain_;
  std::vector<float> own_plane_;
  std::vector<float> carried_plane_;
};

}  // namespace fast_edi
