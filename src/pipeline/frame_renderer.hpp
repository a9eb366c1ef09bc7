/// \file
/// The filters that look at one frame alone: from its gains to its latent image.
///
/// Nothing is kept from one frame to the next but memory. So frames may be rendered in any order,
/// by any of several renderers at the same time, with the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/camera_response.hpp"
#include "fast_edi/latent/latent_image.hpp"
#include "reblur/later_quarters.hpp"
#include "reblur/reblur.hpp"

namespace fast_edi {

class FrameRenderer {
 public:
  /// A frame whose integral was computed.
  struct Frame {
    ImageView blurry;
    ExposureInterval window;                  ///< in event time
    float* gains = nullptr;                   ///< of its pixels, row-major; filtered in place
    const std::uint16_t* counts = nullptr;    ///< OFF and ON events of each pixel, interleaved
    const LaterQuarters* quarters = nullptr;  ///< null: the frame is not re-blurred
    const PixelEventLists& lists;             ///< hold the events of the window
  };

  explicit FrameRenderer(const FilterParameters& filter) : latent_image_(filter) {}

  void setFilter(const FilterParameters& filter) { latent_image_.setParameters(filter); }

  /// \param image of the blurry frame's size and format: the latent image is written there
  /// \return whether trust() is that of this frame
  bool render(const Frame& frame, const LatentGains::Model& model, const CameraResponse& response,
              const MutableImageView& image);

  /// How far filter_reblur trusted each pixel, 0 to 1, row-major.
  const std::vector<float>& trust() const { return reblur_.trust(); }
  LatentImage& latentImage() { return latent_image_; }
  std::size_t memoryBytes() const { return latent_image_.memoryBytes() + reblur_.memoryBytes(); }

 private:
  LatentImage latent_image_;
  Reblur reblur_;
};

}  // namespace fast_edi
