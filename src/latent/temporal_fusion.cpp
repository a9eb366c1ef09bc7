#include "fast_edi/latent/temporal_fusion.hpp"

#include "base/vector_clones.hpp"
#include "fast_edi/base/image_plane.hpp"

namespace fast_edi {
namespace {

/// own += w (carried - own), except where either is saturated.
FAST_EDI_VECTOR_CLONES
void blendPlanes(const float* __restrict carried, std::size_t count, float weight, float highest,
                 float* __restrict own) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool saturated = own[i] >= highest || carried[i] >= highest;
    own[i] += (saturated ? 0.0F : weight) * (carried[i] - own[i]);
  }
}

}  // namespace

bool TemporalFusion::apply(const Frame& frame, const EventStream& events,
                           const LatentGains::Model& model, const CameraResponse& response,
                           double weight, const MutableImageView& image) {
  const bool bridged = isBridged(frame, events, image);
  if (bridged) {
    const double exposures =
        static_cast<double>(frame.exposure_ns) / static_cast<double>(last_frame_.exposure_ns);
    gain_.assign(image.size.pixelCount(), static_cast<float>(exposures));
    change_.start(gain_.data(), *events.lists(), last_frame_.reference, model);
    change_.at(*events.lists(), frame.reference, gain_.data());
    response.applyGain(last_.view(), gain_.data(), carried_.reshape(image.size, image.format));
    blend(static_cast<float>(weight), image);
  }
  last_.assign({image.data, image.size, image.step, image.format});
  last_frame_ = frame;
  last_generation_ = events.generation();
  return bridged;
}

bool TemporalFusion::isBridged(const Frame& frame, const EventStream& events,
                               const MutableImageView& image) const {
  if (last_.empty() || last_generation_ != events.generation() ||
      last_frame_.epoch != frame.epoch) {
    return false;
  }
  const ImageView last = last_.view();
  const ExposureInterval between{last_frame_.reference.t_ns, frame.reference.t_ns};
  return last.size == image.size && last.format == image.format && between.length() > 0 &&
         between.length() <= kMaxGap_ns && events.covers(between) &&
         events.hasReached(between.end_ns);
}

void TemporalFusion::blend(float weight, const MutableImageView& image) {
  constexpr float kHighest_dn = 255.0F;
  const float highest = kHighest_dn * static_cast<float>(dnPerDn8(image.format));
  own_plane_.resize(image.size.pixelCount());
  carried_plane_.resize(image.size.pixelCount());
  for (int channel = 0; channel < channels(image.format); ++channel) {
    loadPlane({image.data, image.size, image.step, image.format}, channel, own_plane_.data());
    loadPlane(carried_.view(), channel, carried_plane_.data());
    blendPlanes(carried_plane_.data(), own_plane_.size(), weight, highest, own_plane_.data());
    storePlane(own_plane_.data(), channel, image);
  }
}

std::size_t TemporalFusion::memoryBytes() const {
  return last_.memoryBytes() + carried_.memoryBytes() + change_.memoryBytes() +
         (gain_.capacity() + own_plane_.capacity() + carried_plane_.capacity()) * sizeof(float);
}

}  // namespace fast_edi
