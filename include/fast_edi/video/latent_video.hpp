/// \file
/// The high-rate video: latent images within each exposure, and between two exposures where events
/// bridge the gap.
///
///     gains at the reference time -> LatentGains at each instant -> LatentImage
///                                 -> MotionCompensation by the image of the middle -> FrameSink
///
/// Instants within an exposure are shown from its own frame. Those in the gap to the exposure
/// before are shown from the frame that is nearer, once the later one has come: their events are
/// complete then. No image where events are missing, none from a frame that was passed through,
/// none in a gap of more than kMaxGap_ns: what events say grows less certain with time.
///
/// Complexity. O(events from one exposure's end to the next, at most four times, + images *
/// pixels) for each frame. Memory once used: 20 B per pixel and two images.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/latent_image.hpp"
#include "fast_edi/latent/motion_compensation.hpp"
#include "fast_edi/parameters/parameters.hpp"

namespace fast_edi {

class LatentVideo {
 public:
  static constexpr std::int64_t kMaxGap_ns = kNanosecondsPerSecond;

  /// \param sink, latent_image, compensation must outlive this object
  LatentVideo(FrameSink& sink, LatentImage& latent_image, MotionCompensation& compensation)
      : sink_(sink), latent_image_(latent_image), compensation_(compensation) {}

  /// A frame was integrated: keeps its gains, before any filter touches them.
  /// \param output with input and exposure (in frame time)
  /// \param epoch of the frames' clock
  /// \param counts of the events in the exposure; copied
  /// \param reference of the gains, in event time
  /// \param parameters with the thresholds and the time offset of that integral
  void take(const OutputFrame& output, std::uint64_t epoch, const std::vector<float>& gain,
            const EventCounts& counts, const PixelEventLists& lists, const LevelInstant& reference,
            const DeblurParameters& parameters);

  /// Stabilises the images of this frame; without it, none is stabilised.
  /// \param middle its latent image at mid-exposure; copied
  /// \pre take() was called for this frame
  void setMiddle(const ImageView& middle) { current_.middle.assign(middle); }

  /// Writes the images between the frame before and the one taken, then those within its exposure.
  /// \pre take() was called for this frame; the events of its exposure are complete
  /// \return images written
  std::size_t write(const EventStream& events, const DeblurParameters& parameters);

  /// The next frame has no predecessor to bridge a gap to.
  void interrupt();

  std::size_t memoryBytes() const;

 private:
  /// A frame and the state of its pixels.
  struct Source {
    InputFrame input;
    ExposureInterval exposure;     ///< in frame time
    std::int64_t offset_ns = 0;    ///< event time minus frame time
    std::uint64_t epoch = 0;       ///< of the frames' clock
    std::uint64_t generation = 0;  ///< of the event lists
    LatentGains gains;
    std::vector<std::uint16_t> counts;  ///< of the events in the exposure, see EventCounts
    StoredImage middle;                 ///< latent image at mid-exposure; empty: none
  };

  std::size_t bridgeGap(const EventStream& events, const DeblurParameters& parameters);
  std::size_t show(Source& source, const std::vector<std::int64_t>& instants,
                   const EventStream& events, const DeblurParameters& parameters);

  FrameSink& sink_;
  LatentImage& latent_image_;
  MotionCompensation& compensation_;
  Source current_;
  Source last_;
  bool has_last_ = false;
  bool has_current_ = false;
  std::uint64_t stamp_epoch_ = 0;
  std::optional<std::int64_t> last_stamp_ns_;  ///< of the images written in that epoch
  std::vector<float> gain_;
};

}  // namespace fast_edi
