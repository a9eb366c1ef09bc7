#include "fast_edi/core/latent_video.hpp"

#include <algorithm>
#include <utility>

#include "fast_edi/core/latent_instants.hpp"
#include "fast_edi/core/stamp_limits.hpp"

namespace fast_edi {
namespace {

/// How rows lie in Source::middle.
std::size_t middleStep(const ImageView& image) {
  return static_cast<std::size_t>(image.size.width) *
         static_cast<std::size_t>(bytesPerPixel(image.format));
}

}  // namespace

void LatentVideo::take(const OutputFrame& output, std::uint64_t epoch,
                       const std::vector<float>& gain, std::int64_t reference_ns,
                       const DeblurParameters& parameters) {
  std::swap(last_, current_);  // rather than move: both keep their memory
  has_last_ = has_current_ && last_.epoch == epoch;
  if (!has_last_) {
    last_.input = {};
  }
  if (epoch != stamp_epoch_) {
    stamp_epoch_ = epoch;
    last_stamp_ns_.reset();
  }
  current_.input = output.input;
  current_.exposure = output.exposure;
  current_.offset_ns = parameters.time_offset_ns;
  current_.epoch = epoch;
  current_.gains.start(gain.data(), gain.size(), reference_ns, parameters.thresholds);
  has_current_ = true;
  gain_.resize(gain.size());
}

void LatentVideo::breakOff() {
  has_current_ = false;
  has_last_ = false;
  current_.input = {};
  last_.input = {};
}

std::size_t LatentVideo::memoryBytes() const {
  return current_.gains.memoryBytes() + last_.gains.memoryBytes() +
         gain_.capacity() * sizeof(float) + current_.middle.capacity() + last_.middle.capacity() +
         (compensation_ ? compensation_->memoryBytes() : 0);
}

std::size_t LatentVideo::write(const EventStream& events, const DeblurParameters& parameters) {
  current_.generation = events.generation();
  showMiddle(events, parameters);
  const std::size_t between = has_last_ ? bridgeGap(events, parameters) : 0;
  return between +
         show(current_, instantsWithin(current_.exposure, parameters.latent), events, parameters);
}

/// What the other images of this exposure are steadied by.
void LatentVideo::showMiddle(const EventStream& events, const DeblurParameters& parameters) {
  current_.middle.clear();
  if (!parameters.filter.enabled || !parameters.filter.motion) {
    return;
  }
  const ImageView& blurry = current_.input.image;
  const std::size_t step = middleStep(blurry);
  current_.middle.resize(step * static_cast<std::size_t>(blurry.size.height));
  current_.gains.at(*events.lists(),
                    current_.exposure.at(ExposureInstant::kMid) + current_.offset_ns, gain_.data());
  latent_image_.write(blurry, gain_.data(), parameters.response,
                      {current_.middle.data(), blurry.size, step, blurry.format});
}

/// \return ready to steady images of this frame; nullptr when there is nothing to do it by
MotionCompensation* LatentVideo::compensationFor(const Source& source) {
  if (source.middle.empty()) {
    return nullptr;
  }
  const ImageView& blurry = source.input.image;
  if (!compensation_ || compensation_->size() != blurry.size ||
      compensation_->format() != blurry.format) {
    compensation_ = std::make_unique<MotionCompensation>(blurry.size, blurry.format);
  }
  compensation_->setReference(
      {source.middle.data(), blurry.size, middleStep(blurry), blurry.format});
  return compensation_.get();
}

std::size_t LatentVideo::bridgeGap(const EventStream& events, const DeblurParameters& parameters) {
  const ExposureInterval gap{last_.exposure.end_ns, current_.exposure.start_ns};
  if (gap.length() <= 0 || gap.length() > kMaxGap_ns) {
    return 0;
  }
  const std::int64_t middle_ns = gap.start_ns + gap.length() / 2;
  std::vector<std::int64_t> nearer_last =
      instantsBetween(gap, current_.exposure.length(), parameters.latent);
  const auto split = std::lower_bound(nearer_last.begin(), nearer_last.end(), middle_ns);
  const std::vector<std::int64_t> nearer_current(split, nearer_last.end());
  nearer_last.erase(split, nearer_last.end());

  std::size_t images = 0;
  if (last_.generation == current_.generation &&
      events.covers({last_.gains.instant(), middle_ns + last_.offset_ns})) {
    images += show(last_, nearer_last, events, parameters);
  }
  if (events.covers({middle_ns + current_.offset_ns, gap.end_ns + current_.offset_ns})) {
    images += show(current_, nearer_current, events, parameters);
  }
  return images;
}

std::size_t LatentVideo::show(Source& source, const std::vector<std::int64_t>& instants,
                              const EventStream& events, const DeblurParameters& parameters) {
  std::size_t images = 0;
  MotionCompensation* compensation = instants.empty() ? nullptr : compensationFor(source);
  for (const std::int64_t t_ns : instants) {
    // Exposures that overlap: the frame before has shown this time already.
    const bool shown = last_stamp_ns_ && t_ns <= *last_stamp_ns_;
    if (shown || !isStamp(t_ns)) {
      continue;
    }
    source.gains.at(*events.lists(), t_ns + source.offset_ns, gain_.data());
    const MutableImageView out = sink_.beginLatent(source.input);
    latent_image_.write(source.input.image, gain_.data(), parameters.response, out);
    if (compensation != nullptr) {
      compensation->apply(out);
    }
    sink_.finishLatent(source.input, t_ns);
    last_stamp_ns_ = t_ns;
    ++images;
  }
  return images;
}

}  // namespace fast_edi
