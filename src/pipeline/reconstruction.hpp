/// \file
/// From the gains of a frame to its images: filters, stabilisation by motion compensation, temporal
/// fusion, and the high-rate video behind it.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fast_edi/base/frame_sink.hpp"
#include "fast_edi/base/image.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/latent/middle_image.hpp"
#include "fast_edi/latent/motion_compensation.hpp"
#include "fast_edi/latent/temporal_fusion.hpp"
#include "fast_edi/parameters/parameters.hpp"
#include "fast_edi/video/latent_video.hpp"
#include "pipeline/frame_renderer.hpp"
#include "pipeline/window_integral.hpp"

namespace fast_edi {

class Reconstruction {
 public:
  /// A frame whose integral was computed.
  struct Frame {
    const OutputFrame& output;      ///< with input, output stamp and exposure
    ExposureInterval window;        ///< the exposure in event time
    std::int64_t reference_ns = 0;  ///< of the gains, in event time
    std::uint64_t epoch = 0;        ///< of the frames' clock

    LevelInstant reference() const { return {reference_ns, window.end_ns}; }
  };

  /// \param sink must outlive this object
  Reconstruction(FrameSink& sink, const FilterParameters& filter)
      : sink_(sink),
        renderer_(filter),
        middle_(renderer_.latentImage()),
        video_(sink, renderer_.latentImage(), compensation_) {}

  void setFilter(const FilterParameters& filter);
  /// The next frame has no predecessor.
  void interrupt();

  /// Asks the sink for memory and writes the latent image there, or lets the sink do so later.
  /// \param integral of the frame; filters change its gains
  void render(const Frame& frame, WindowIntegral& integral, const EventStream& events,
              const DeblurParameters& parameters);
  /// Images of the video up to the end of the frame rendered last. \return their number
  std::size_t writeVideo(const EventStream& events, const DeblurParameters& parameters);
  /// Asks the sink for memory and copies the input there.
  void copy(const InputFrame& input);

  std::size_t memoryBytes() const;

 private:
  bool mayDefer(const DeblurParameters& parameters) const;
  ImageView stabilise(const Frame& frame, const ExposureEvents& counts, const EventStream& events,
                      const DeblurParameters& parameters, const MutableImageView& image);

  FrameSink& sink_;
  FrameRenderer renderer_;
  MiddleImage middle_;
  MotionCompensation compensation_;
  LatentVideo video_;
  TemporalFusion fusion_;
  bool wants_video_ = false;  ///< of the frame rendered last
};

}  // namespace fast_edi
