#include "fast_edi/core/middle_image.hpp"

namespace fast_edi {

void MiddleImage::take(const std::vector<float>& gain, std::int64_t reference_ns,
                       ContrastThresholds thresholds) {
  gains_.start(gain.data(), gain.size(), reference_ns, thresholds);
  gain_.resize(gain.size());
}

ImageView MiddleImage::show(const ImageView& blurry, const PixelEventLists& lists,
                            std::int64_t middle_ns, const CameraResponse& response) {
  gains_.at(lists, middle_ns, gain_.data());
  latent_image_.write(blurry, gain_.data(), response, image_.reshape(blurry.size, blurry.format));
  return image_.view();
}

std::size_t MiddleImage::memoryBytes() const {
  return gains_.memoryBytes() + gain_.capacity() * sizeof(float) + image_.memoryBytes();
}

}  // namespace fast_edi
