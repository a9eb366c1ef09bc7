#include "pipeline/reconstruction.hpp"

#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/filters/exposure_events.hpp"

namespace fast_edi {

void Reconstruction::setFilter(const FilterParameters& filter) {
  latent_image_.setParameters(filter);
  interrupt();
}

void Reconstruction::interrupt() {
  video_.interrupt();
  fusion_.reset();
}

void Reconstruction::render(const Frame& frame, WindowIntegral& integral, const EventStream& events,
                            const DeblurParameters& parameters) {
  const InputFrame& input = frame.output.input;
  const FilterParameters& filter = parameters.filter;
  const PixelEventLists& lists = *events.lists();
  const ExposureEvents counts{integral.counts().data(), parameters.thresholds};
  const LatentGains::Model model{parameters.thresholds, levelModel(parameters)};
  const bool stabilises = filter.enabled && filter.motion;

  wants_video_ = parameters.latent.isOn() && sink_.wantsLatentImages();
  if (wants_video_) {
    video_.take(frame.output, frame.epoch, integral.gains(), integral.counts(), lists,
                frame.reference(), parameters);
  } else {
    video_.interrupt();
  }
  if (stabilises && parameters.reference != ExposureInstant::kMid) {
    middle_.take(integral.gains(), lists, frame.reference(), model);
  }
  const MutableImageView image = sink_.begin(input);
  if (image.data != nullptr) {
    latent_image_.write(input.image, integral.gains().data(), counts, parameters.response, image);
    if (WindowIntegral::countingFor(parameters) == WindowIntegral::Counting::kQuarters &&
        Reblur::supports(image.format, parameters.response)) {
      reblur_.apply({frame.window, latent_image_.blurryLevels().data(), latent_image_.meanCounts(),
                     latent_image_.frameNoise(), integral.counts().data(), &integral.quarters(),
                     latent_image_.cleanLevels()},
                    lists, model, parameters.response, image);
      sink_.noteTrust(reblur_.trust());
    }
  }
  if (stabilises) {
    const ImageView middle = stabilise(frame, counts, events, parameters, image);
    if (wants_video_) {
      video_.setMiddle(middle);
    }
  }
  if (filter.enabled && filter.temporal > 0.0) {
    fusion_.apply({frame.reference(), frame.window.length(), frame.epoch}, events, model,
                  parameters.response, filter.temporal, image);
  }
}

/// Stabilises the latent image at the reference by that of mid-exposure, unless it is that.
/// \return the one of mid-exposure, valid until the next call
/// \pre unless the reference is mid-exposure: middle_ has taken this frame
ImageView Reconstruction::stabilise(const Frame& frame, const ExposureEvents& counts,
                                    const EventStream& events, const DeblurParameters& parameters,
                                    const MutableImageView& image) {
  if (parameters.reference == ExposureInstant::kMid) {
    return {image.data, image.size, image.step, image.format};
  }
  const LevelInstant mid{frame.window.at(ExposureInstant::kMid), frame.window.end_ns};
  const ImageView middle =
      middle_.show(frame.output.input.image, counts, *events.lists(), mid, parameters.response);
  compensation_.setReference(middle);
  compensation_.apply(image);
  return middle;
}

std::size_t Reconstruction::writeVideo(const EventStream& events,
                                       const DeblurParameters& parameters) {
  return wants_video_ ? video_.write(events, parameters) : 0;
}

void Reconstruction::copy(const InputFrame& input) {
  const MutableImageView image = sink_.begin(input);
  if (input.image.data != nullptr && image.data != nullptr) {
    copyPixels(input.image, image);  // else its pixels are the sink's own matter
  }
}

std::size_t Reconstruction::memoryBytes() const {
  return fusion_.memoryBytes() + latent_image_.memoryBytes() + video_.memoryBytes() +
         middle_.memoryBytes() + reblur_.memoryBytes() + compensation_.memoryBytes();
}

}  // namespace fast_edi
