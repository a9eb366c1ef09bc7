#include "pipeline/frame_renderer.hpp"

namespace fast_edi {

bool FrameRenderer::render(const Frame& frame, const LatentGains::Model& model,
                           const CameraResponse& response, const MutableImageView& image) {
  latent_image_.write(frame.blurry, frame.gains, {frame.counts, model.thresholds}, response, image);
  if (frame.quarters == nullptr || !Reblur::supports(image.format, response)) {
    return false;
  }
  reblur_.apply(
      {frame.window, latent_image_.blurryLevels().data(), latent_image_.meanCounts(),
       latent_image_.frameNoise(), frame.counts, frame.quarters, latent_image_.cleanLevels()},
      frame.lists, model, response, image);
  return true;
}

}  // namespace fast_edi
