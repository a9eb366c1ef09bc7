#include "fast_edi/latent/middle_image.hpp"

namespace fast_edi {

void MiddleImage::take(const std::vector<float>& gain, const PixelEventLists& lists,
                       const LevelInstant& reference, const LatentGains::Model& model) {
  gains_.start(gain.data(), lists, reference, model);
  gain_.resize(gain.size());
}

ImageView MiddleImage::show(const ImageView& blurry, const ExposureEvents& events,
                            const PixelEventLists& lists, const LevelInstant& middle,
                            const CameraResponse& response) {
  gains_.at(lists, middle, gain_.data());
  latent_image_.write(blurry, gain_.data(), events, response,
                      image_.reshape(blurry.size, blurry.format));
  return image_.view();
}

std::size_t MiddleImage::memoryBytes() const {
  return gains_.memoryBytes() + gain_.capacity() * sizeof(float) + image_.memoryBytes();
}

}  // namespace fast_edi
