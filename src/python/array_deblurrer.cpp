#include "python/array_deblurrer.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/base/sensor_size.hpp"
#include "python/time_unit.hpp"

namespace fast_edi::python {
namespace {

/// Longer than any ramp of the level model, so that what beginAt() adds reaches into no exposure.
constexpr std::int64_t kBeforeStart_ns = 20 * kNanosecondsPerMillisecond;
/// Refused, so that its frame has none and those behind it keep their own.
constexpr std::int64_t kNoExposure_us = 0;

SensorSize valid(SensorSize size) {
  if (size.width < 1 || size.width > kMaxSide_px || size.height < 1 || size.height > kMaxSide_px) {
    throw std::invalid_argument(
        "sensor_size is (" + std::to_string(size.width) + ", " + std::to_string(size.height) +
        "), expected width and height of 1.." + std::to_string(kMaxSide_px));
  }
  return size;
}

}  // namespace

/// What a frame's owner points to.
struct OwnedFrame {
  StoredImage image;
  int dimensions = 2;
};

MutableImageView ArraySink::begin(const InputFrame& input) {
  buffer_ = makeBuffer(input.image.size, input.image.format);
  return viewOf(buffer_);
}

void ArraySink::finish(const OutputFrame& output) {
  FrameOutput finished;
  finished.dimensions = static_cast<const OwnedFrame*>(output.input.owner.get())->dimensions;
  finished.frame = output;
  finished.frame.input.owner.reset();
  finished.frame.input.image = {};
  finished.image = std::move(buffer_);
  outputs_.push_back(std::move(finished));
}

MutableImageView ArraySink::beginLatent(const InputFrame& input) {
  return begin(input);
}

void ArraySink::finishLatent(const InputFrame& input, std::int64_t stamp_ns) {
  static_cast<void>(input);
  // Its frame came in the same call.
  outputs_.back().latent.push_back({stamp_ns, std::move(buffer_)});
}

ArrayDeblurrer::ArrayDeblurrer(SensorSize size, std::int64_t unit_ns,
                               const DeblurParameters& parameters)
    : size_(valid(size)),
      unit_ns_(unit_ns),
      sink_(parameters.latent.isOn()),
      deblurrer_(parameters, sink_) {}

std::int64_t ArrayDeblurrer::advanceTo(std::int64_t t_ns) {
  now_ns_ = std::max(now_ns_, t_ns);
  return now_ns_;
}

void ArrayDeblurrer::addEvents(const EventColumns& columns, std::uint32_t lost_arrays) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const WireEvents events = readEvents(columns, size_, unit_ns_, records_);
  if (!events.empty()) {
    const std::int64_t last_ns = decodeWireEvent(events.record(events.count - 1)).t_ns;
    sequence_ += lost_arrays + 1;
    deblurrer_.addEvents(events, size_, sequence_, advanceTo(last_ns));
  }
}

void ArrayDeblurrer::useRecordedExposures() {
  const std::lock_guard<std::mutex> lock(mutex_);
  DeblurParameters parameters = deblurrer_.parameters();
  parameters.stamp_reference = ExposureInstant::kMid;
  parameters.exposure_source = ExposureSource::kTopic;
  deblurrer_.setParameters(parameters);
}

void ArrayDeblurrer::addFrame(const ImageView& image, int dimensions, std::int64_t stamp,
                              std::optional<std::int64_t> exposure) {
  if (stamp < 0 || stamp > lastTime(unit_ns_)) {
    throw std::invalid_argument("stamp is " + std::to_string(stamp) + ", expected " +
                                expectedTime(unit_ns_));
  }
  const std::int64_t shortest = std::max<std::int64_t>(kNanosecondsPerMicrosecond / unit_ns_, 1);
  const std::int64_t longest = kMaxExposure_ns / unit_ns_;
  if (exposure && (*exposure < shortest || *exposure > longest)) {
    throw std::invalid_argument("exposure is " + std::to_string(*exposure) + ", expected " +
                                std::to_string(shortest) + ".." + std::to_string(longest) +
                                " (1 us to 1 s in the given time_unit)");
  }

  const std::lock_guard<std::mutex> lock(mutex_);
  const std::shared_ptr<OwnedFrame> owned = unusedFrame();
  owned->image.assign(image);
  owned->dimensions = dimensions;
  InputFrame frame;
  frame.stamp_ns = stamp * unit_ns_;
  frame.image = owned->image.view();
  frame.owner = owned;
  const std::int64_t now_ns = advanceTo(frame.stamp_ns);
  deblurrer_.addFrame(std::move(frame), now_ns);
  const std::int64_t exposure_us =
      exposure ? *exposure * unit_ns_ / kNanosecondsPerMicrosecond : kNoExposure_us;
  deblurrer_.addExposure(static_cast<std::int32_t>(exposure_us), now_ns);
}

std::shared_ptr<OwnedFrame> ArrayDeblurrer::unusedFrame() {
  const auto unused = std::find_if(frames_.begin(), frames_.end(),
                                   [](const auto& frame) { return frame.use_count() == 1; });
  if (unused != frames_.end()) {
    return *unused;
  }
  frames_.push_back(std::make_shared<OwnedFrame>());
  return frames_.back();
}

// A stream counts as complete between its events. These lie in no exposure.

void ArrayDeblurrer::beginAt(std::int64_t t) {
  addMark(t * unit_ns_ - kBeforeStart_ns);
}

void ArrayDeblurrer::endAt(std::int64_t t) {
  addMark(t * unit_ns_);
}

void ArrayDeblurrer::addMark(std::int64_t t_ns) {
  const Event mark{0, 0, std::clamp(t_ns, std::int64_t{0}, kLastStamp_ns), false};
  const std::lock_guard<std::mutex> lock(mutex_);
  deblurrer_.addEvents(&mark, 1, size_, advanceTo(mark.t_ns));
}

void ArrayDeblurrer::finish() {
  const std::lock_guard<std::mutex> lock(mutex_);
  deblurrer_.finish();
}

std::vector<FrameOutput> ArrayDeblurrer::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return sink_.take();
}

DeblurCounters ArrayDeblurrer::counters() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return deblurrer_.counters();
}

DeblurStatus ArrayDeblurrer::status() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return deblurrer_.status();
}

}  // namespace fast_edi::python
