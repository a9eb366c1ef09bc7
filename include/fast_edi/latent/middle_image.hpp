/// \file
/// The latent image of mid-exposure for a frame that is shown at another instant, whose image is
/// stabilised with it (see motion_compensation.hpp).
///
///     gains at the reference -> LatentGains at mid-exposure -> LatentImage
///
/// Complexity. O(events between both instants + pixels). Memory once used: 12 B per pixel and an
/// image.
#pragma once

#include <cstddef>
#include <vector>

#include "fast_edi/base/image.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/integral/latent_gains.hpp"
#include "fast_edi/latent/camera_response.hpp"
#include "fast_edi/latent/latent_image.hpp"

namespace fast_edi {

class MiddleImage {
 public:
  /// \param latent_image must outlive this object
  explicit MiddleImage(LatentImage& latent_image) : latent_image_(latent_image) {}

  /// A frame was integrated: keeps its gains, before any filter touches them.
  /// \param reference of the gains, in event time
  void take(const std::vector<float>& gain, const PixelEventLists& lists,
            const LevelInstant& reference, const LatentGains::Model& model);

  /// \param blurry of the size of the gains
  /// \param middle in event time; the lists hold all events between it and the reference
  /// \return valid until the next call
  /// \pre take() was called for this frame
  /// \param events of the exposure
  ImageView show(const ImageView& blurry, const ExposureEvents& events,
                 const PixelEventLists& lists, const LevelInstant& middle,
                 const CameraResponse& response);

  std::size_t memoryBytes() const;

 private:
  LatentImage& latent_image_;
  LatentGains gains_;
  std::vector<float> gain_;
  StoredImage image_;
};

}  // namespace fast_edi
