#include "fast_edi/video/latent_video.hpp"

#include <algorithm>
#include <utility>

#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/latent/latent_instants.hpp"

namespace fast_edi {

void LatentVideo::take(const OutputFrame& output, std::uint64_t epoch,
                       const std::vector<float>& gain, const EventCounts& counts,
                       const PixelEventLists& lists, const LevelInstant& reference,
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
  current_.middle.clear();
  current_.gains.start(gain.data(), lists, reference,
                       {parameters.thresholds, levelModel(parameters)});
  current_.counts.assign(counts.data(), counts.data() + 2 * counts.pixelCount());
  has_current_ = true;
  gain_.resize(gain.size());
}

void LatentVideo::interrupt() {
  has_current_ = false;
  has_last_ = false;
  current_.input = {};
  last_.input = {};
}

std::size_t LatentVideo::memoryBytes() const {
  return current_.gains.memoryBytes() + last_.gains.memoryBytes() +
         gain_.capacity() * sizeof(float) +
         (current_.counts.capacity() + last_.counts.capacity()) * sizeof(std::uint16_t) +
         current_.middle.memoryBytes() + last_.middle.memoryBytes();
}

std::size_t LatentVideo::write(const EventStream& events, const DeblurParameters& parameters) {
  current_.generation = events.generation();
  const std::size_t between = has_last_ ? bridgeGap(events, parameters) : 0;
  return between +
         show(current_, instantsWithin(current_.exposure, parameters.latent), events, parameters);
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
  // Whichever frame it is: those up to the end of the later exposure have come.
  const std::int64_t known_until_ns = current_.exposure.end_ns + current_.offset_ns;
  const bool stabilises = !instants.empty() && !source.middle.empty();
  if (stabilises) {
    compensation_.setReference(source.middle.view());
  }
  for (const std::int64_t t_ns : instants) {
    // Exposures that overlap: the frame before has shown this time already.
    const bool shown = last_stamp_ns_ && t_ns <= *last_stamp_ns_;
    if (shown || !isStamp(t_ns)) {
      continue;
    }
    source.gains.at(*events.lists(), {t_ns + source.offset_ns, known_until_ns}, gain_.data());
    const MutableImageView out = sink_.beginLatent(source.input);
    latent_image_.write(source.input.image, gain_.data(),
                        {source.counts.data(), parameters.thresholds}, parameters.response, out);
    if (stabilises) {
      compensation_.apply(out);
    }
    sink_.finishLatent(source.input, t_ns);
    last_stamp_ns_ = t_ns;
    ++images;
  }
  return images;
}

}  // namespace fast_edi
