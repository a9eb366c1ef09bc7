#include "pipeline/reconstruction.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/filters/exposure_events.hpp"

namespace fast_edi {
namespace {

/// What rendering a frame needs, while the pipeline goes on.
struct FrameCopy {
  FrameCopy(const Reconstruction::Frame& frame, WindowIntegral& integral,
            const LaterQuarters* quarters_of_window, const PixelEventLists& from)
      : input(frame.output.input),
        window(frame.window),
        gains(integral.gains()),
        counts(integral.counts().data(),
               integral.counts().data() + 2 * integral.counts().pixelCount()),
        lists(from, frame.window) {
    if (quarters_of_window != nullptr) {
      quarters = *quarters_of_window;
    }
  }

  InputFrame input;
  ExposureInterval window;
  std::vector<float> gains;
  std::vector<std::uint16_t> counts;
  std::optional<LaterQuarters> quarters;
  PixelEventLists lists;
};

FrameWork workOn(std::shared_ptr<FrameCopy> frame, const LatentGains::Model& model,
                 const CameraResponse& response, const MutableImageView& image) {
  return [frame = std::move(frame), model, response, image](FrameRenderer& renderer) {
    return renderer.render(
        {frame->input.image, frame->window, frame->gains.data(), frame->counts.data(),
         frame->quarters ? &*frame->quarters : nullptr, frame->lists},
        model, response, image);
  };
}

}  // namespace

void Reconstruction::setFilter(const FilterParameters& filter) {
  renderer_.setFilter(filter);
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
  const LaterQuarters* quarters =
      WindowIntegral::countingFor(parameters) == WindowIntegral::Counting::kQuarters
          ? &integral.quarters()
          : nullptr;
  if (image.data != nullptr && mayDefer(parameters)) {
    sink_.defer(workOn(std::make_shared<FrameCopy>(frame, integral, quarters, lists), model,
                       parameters.response, image));
  } else if (image.data != nullptr &&
             renderer_.render({input.image, frame.window, integral.gains().data(),
                               integral.counts().data(), quarters, lists},
                              model, parameters.response, image)) {
    sink_.noteTrust(renderer_.trust());
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

/// Whether nothing but the sink waits for the latent image.
/// \pre wants_video_ is that of this frame
bool Reconstruction::mayDefer(const DeblurParameters& parameters) const {
  const FilterParameters& filter = parameters.filter;
  const bool is_fused = filter.enabled && filter.temporal > 0.0;
  const bool is_moved =
      filter.enabled && filter.motion && parameters.reference != ExposureInstant::kMid;
  return sink_.takesWork() && !wants_video_ && !is_fused && !is_moved;
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
  return fusion_.memoryBytes() + renderer_.memoryBytes() + video_.memoryBytes() +
         middle_.memoryBytes() + compensation_.memoryBytes();
}

}  // namespace fast_edi
