#include "fast_edi/pipeline/deblurrer.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "pipeline/frame_queue.hpp"
#include "pipeline/parameter_refinement.hpp"
#include "pipeline/reconstruction.hpp"
#include "pipeline/window_integral.hpp"

namespace fast_edi {
namespace {

PixelEventLists::Limits limitsOf(const DeblurParameters& parameters) {
  return {parameters.max_buffered_events, parameters.max_backward_jump_ns,
          parameters.max_forward_jump_ns};
}

}  // namespace

class Deblurrer::Impl {
 public:
  Impl(const DeblurParameters& parameters, FrameSink& sink)
      : sink_(sink),
        refinement_(parameters),
        events_(limitsOf(parameters), counters_,
                [this](StreamReset kind, std::int64_t next_ns) { beforeReset(kind, next_ns); }),
        queue_(parameters_, events_, counters_),
        reconstruction_(sink, parameters.filter) {}

  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t now_ns);
  void addEvents(const Event* events, std::size_t count, SensorSize size, std::int64_t now_ns);
  void noteLostEvents(std::size_t events) { events_.noteLost(events); }
  void noteMissingArrays() { events_.noteMissing(); }
  void addFrame(InputFrame frame, std::int64_t now_ns);
  void addExposure(std::int32_t exposure_us, std::int64_t now_ns);
  void advance(std::int64_t now_ns);
  void finish();
  void pause();
  void setParameters(const DeblurParameters& parameters);

  const DeblurParameters& parameters() const { return refinement_.requested(); }
  const DeblurCounters& counters() const { return counters_; }
  std::size_t bufferedEvents() const;
  DeblurStatus status() const;

 private:
  void beforeEvents(std::size_t count, std::int64_t now_ns);
  void afterEvents();
  void takeEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence);
  void takeEvents(const Event* events, std::size_t count, SensorSize size);
  void beforeReset(StreamReset kind, std::int64_t next_event_ns);
  void closeReady();
  void process(ClosedFrame& frame);
  void deblur(ClosedFrame& frame);
  void passThrough(ClosedFrame& frame);
  void count(const IntegrationReport& report);
  void discardOldEvents(const ClosedFrame& frame);
  bool prepareIntegral(bool may_allocate);
  void predictWindow();
  void accumulate();

  FrameSink& sink_;
  DeblurCounters counters_;
  ParameterRefinement refinement_;
  const DeblurParameters& parameters_ = refinement_.inForce();
  EventStream events_;
  std::uint64_t events_generation_ = 0;      ///< of the lists that the refinement learned from
  std::vector<std::uint8_t> mapped_events_;  ///< the last array's records; keeps its memory
  FrameQueue queue_;
  WindowIntegral integral_;
  Reconstruction reconstruction_;
};

// --- Input ---------------------------------------------------------------------------------------

void Deblurrer::Impl::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                                std::int64_t now_ns) {
  beforeEvents(events.count, now_ns);
  takeEvents(events, size, sequence);
  afterEvents();
}

void Deblurrer::Impl::addEvents(const Event* events, std::size_t count, SensorSize size,
                                std::int64_t now_ns) {
  beforeEvents(count, now_ns);
  takeEvents(events, count, size);
  afterEvents();
}

void Deblurrer::Impl::beforeEvents(std::size_t count, std::int64_t now_ns) {
  advance(now_ns);
  if (count > 0) {
    queue_.noteEvents();
  }
}

void Deblurrer::Impl::afterEvents() {
  closeReady();
  accumulate();
}

/// Where another orientation or polarity becomes that of the frames.
void Deblurrer::Impl::takeEvents(const WireEvents& events, SensorSize size,
                                 std::uint32_t sequence) {
  const EventMapping& mapping = parameters_.event_mapping;
  if (mapping.isIdentity()) {
    events_.take(events, size, sequence);
    return;
  }
  mapped_events_.assign(events.data, events.data + events.count * kWireEventBytes);
  mapping.apply(mapped_events_.data(), events.count, size);
  events_.take({mapped_events_.data(), events.count}, mapping.apply(size), sequence);
}

/// Plain events, by way of wire records.
void Deblurrer::Impl::takeEvents(const Event* events, std::size_t count, SensorSize size) {
  const EventMapping& mapping = parameters_.event_mapping;
  const bool as_is = mapping.isIdentity();
  mapped_events_.resize(count * kWireEventBytes);
  std::size_t valid = 0;
  std::for_each(events, events + count, [&](const Event& event) {
    if (isStamp(event.t_ns)) {
      writeWireEvent(as_is ? event : mapping.apply(event, size),
                     &mapped_events_[valid * kWireEventBytes]);
      ++valid;
    }
  });
  counters_.events_in += count - valid;
  counters_.events_glitched += count - valid;
  events_.take({mapped_events_.data(), valid}, mapping.apply(size), std::nullopt);
}

void Deblurrer::Impl::addFrame(InputFrame frame, std::int64_t now_ns) {
  advance(now_ns);
  queue_.addFrame(std::move(frame));
  while (std::optional<ClosedFrame> surplus = queue_.takeSurplus()) {
    process(*surplus);
  }
  closeReady();
  predictWindow();
}

void Deblurrer::Impl::addExposure(std::int32_t exposure_us, std::int64_t now_ns) {
  advance(now_ns);
  queue_.addExposure(exposure_us);
  if (parameters_.exposure_source == ExposureSource::kTopic) {
    closeReady();
    predictWindow();
  }
}

void Deblurrer::Impl::advance(std::int64_t now_ns) {
  queue_.advance(now_ns);
  closeReady();
}

void Deblurrer::Impl::finish() {
  events_.dropHeld();
  queue_.endExposures();
  closeReady();
  while (std::optional<ClosedFrame> frame = queue_.takeNext()) {
    process(*frame);
  }
}

void Deblurrer::Impl::pause() {
  queue_.restart();
  events_.restart();
  integral_.resetPrediction();
  reconstruction_.interrupt();
}

void Deblurrer::Impl::setParameters(const DeblurParameters& parameters) {
  validate(parameters);
  const bool source_changes = parameters.exposure_source != parameters_.exposure_source;
  const bool mapping_changes = parameters.event_mapping != parameters_.event_mapping;
  refinement_.setParameters(parameters);
  events_.setLimits(limitsOf(parameters_));
  if (mapping_changes) {
    events_.restart();
  }
  queue_.parametersChanged(source_changes);
  integral_.adopt(parameters_);
  reconstruction_.setFilter(parameters_.filter);
  predictWindow();
}

/// The event clock jumps: frames of the old epoch get nothing more. The sensor's size changes:
/// frames up to there have all they need, which the stream itself knows.
void Deblurrer::Impl::beforeReset(StreamReset kind, std::int64_t next_event_ns) {
  closeReady();
  if (kind != StreamReset::kTimeJump) {
    return;
  }
  const std::int64_t newest_ns = events_.lists()->newest();
  while (std::optional<ClosedFrame> frame = queue_.takeBefore(newest_ns, next_event_ns)) {
    process(*frame);
  }
}

// --- Frames --------------------------------------------------------------------------------------

void Deblurrer::Impl::closeReady() {
  // Before any window is computed: a learned delay of events is part of it.
  if (events_generation_ != events_.generation()) {
    events_generation_ = events_.generation();
    refinement_.reset();
    integral_.adopt(parameters_);
    queue_.resetClocks();
  }
  while (std::optional<ClosedFrame> frame = queue_.takeReady()) {
    process(*frame);
  }
}

void Deblurrer::Impl::process(ClosedFrame& frame) {
  if (frame.verdict.state == FrameState::kReady) {
    deblur(frame);
  } else {
    passThrough(frame);
  }
  discardOldEvents(frame);
  predictWindow();
}

void Deblurrer::Impl::deblur(ClosedFrame& frame) {
  OutputFrame& output = frame.output;
  const ExposureInterval& window = frame.window;
  const std::int64_t reference_ns =
      window.start_ns + (output.exposure.at(parameters_.reference) - output.exposure.start_ns);

  prepareIntegral(true);
  const IntegrationReport report = integral_.integrate(*events_.lists(), window, reference_ns,
                                                       WindowIntegral::countingFor(parameters_));
  const bool learns = refinement_.wantsFrame();
  if (learns) {
    refinement_.keepGains(integral_.gains());
  }
  reconstruction_.render({output, window, reference_ns, frame.epoch}, integral_, events_,
                         parameters_);
  count(report);
  output.deblurred = true;
  output.events = report.events;
  sink_.finish(output);
  // After the frame itself, which should be published first.
  counters_.latent_images += reconstruction_.writeVideo(events_, parameters_);
  if (learns) {
    refinement_.learn(output.input.image, window, reference_ns, events_, counters_);
    integral_.adopt(parameters_);
  } else {
    refinement_.skipFrame();
  }
}

void Deblurrer::Impl::passThrough(ClosedFrame& frame) {
  reconstruction_.interrupt();
  refinement_.interrupt();
  reconstruction_.copy(frame.output.input);
  ++counters_.frames_passed[static_cast<std::size_t>(frame.verdict.reason)];
  frame.output.pass_reason = frame.verdict.reason;
  sink_.finish(frame.output);
}

void Deblurrer::Impl::count(const IntegrationReport& report) {
  ++counters_.frames_deblurred;
  counters_.frames_still += report.events == 0 ? 1 : 0;
  counters_.windows_predicted += report.kind == IntegrationKind::kPredicted ? 1 : 0;
  counters_.windows_not_predicted += report.kind == IntegrationKind::kNotPredicted ? 1 : 0;
  counters_.pixels_out_of_range += report.out_of_range;
}

/// Drops events that neither a later frame nor the refinement needs.
void Deblurrer::Impl::discardOldEvents(const ClosedFrame& frame) {
  // Where no exposure is known, the next frame's may reach back as far as any can.
  const bool exposure_known = frame.output.exposure.length() > 0;
  const std::int64_t t_ns = frame.window.start_ns - (exposure_known ? 0 : kMaxExposure_ns);
  // A stamp far ahead of all events is no reason to throw them away.
  if (events_.isPast(t_ns)) {
    // Ramps of an exposure's first events begin before it, should they be asked for from now on.
    events_.discardBefore(refinement_.neededFrom(t_ns) - kLongestRamp_ns);
  }
}

// --- While events come ---------------------------------------------------------------------------

bool Deblurrer::Impl::prepareIntegral(bool may_allocate) {
  return integral_.prepare(events_, parameters_, may_allocate);
}

void Deblurrer::Impl::predictWindow() {
  if (parameters_.passthrough || events_.lists() == nullptr ||
      !prepareIntegral(queue_.frameSize() == events_.lists()->size())) {
    return;
  }
  const std::optional<ExposureInterval> next = queue_.nextExposure();
  if (next && next->length() > 0) {
    const std::int64_t offset_ns = parameters_.time_offset_ns;
    integral_.predictWindow({next->start_ns + offset_ns, next->end_ns + offset_ns},
                            next->at(parameters_.reference) + offset_ns);
  }
}

void Deblurrer::Impl::accumulate() {
  if (!parameters_.passthrough && events_.lists() != nullptr && prepareIntegral(false)) {
    integral_.accumulate(*events_.lists(), WindowIntegral::countingFor(parameters_));
  }
}

// --- State ---------------------------------------------------------------------------------------

std::size_t Deblurrer::Impl::bufferedEvents() const {
  return events_.lists() != nullptr ? events_.lists()->eventCount() : 0;
}

DeblurStatus Deblurrer::Impl::status() const {
  DeblurStatus status;
  status.buffered_events = bufferedEvents();
  status.buffer_bytes = events_.memoryBytes() + mapped_events_.capacity() +
                        integral_.memoryBytes() + reconstruction_.memoryBytes() +
                        refinement_.memoryBytes();
  status.waiting_frames = queue_.size();
  status.events_seen = events_.seen();
  status.sensor_size = events_.lists() != nullptr ? events_.lists()->size() : queue_.frameSize();
  status.last_exposure_ns = queue_.lastExposure();
  status.exposure_known = status.last_exposure_ns > 0;
  status.thresholds = parameters_.thresholds;
  status.event_delay_ns = refinement_.eventDelay();
  status.learned_pairs = refinement_.learnedPairs();
  status.differing_clocks = queue_.differingClocks();
  return status;
}

// --- Deblurrer -----------------------------------------------------------------------------------

namespace {

const DeblurParameters& validated(const DeblurParameters& parameters) {
  validate(parameters);
  return parameters;
}

}  // namespace

Deblurrer::Deblurrer(const DeblurParameters& parameters, FrameSink& sink)
    : impl_(std::make_unique<Impl>(validated(parameters), sink)) {}

Deblurrer::~Deblurrer() = default;

void Deblurrer::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                          std::int64_t now_ns) {
  impl_->addEvents(events, size, sequence, now_ns);
}

void Deblurrer::addEvents(const Event* events, std::size_t count, SensorSize size,
                          std::int64_t now_ns) {
  impl_->addEvents(events, count, size, now_ns);
}

void Deblurrer::noteLostEvents(std::size_t events) {
  impl_->noteLostEvents(events);
}

void Deblurrer::noteMissingArrays() {
  impl_->noteMissingArrays();
}

void Deblurrer::addFrame(InputFrame frame, std::int64_t now_ns) {
  impl_->addFrame(std::move(frame), now_ns);
}

void Deblurrer::addExposure(std::int32_t exposure_us, std::int64_t now_ns) {
  impl_->addExposure(exposure_us, now_ns);
}

void Deblurrer::advance(std::int64_t now_ns) {
  impl_->advance(now_ns);
}

void Deblurrer::finish() {
  impl_->finish();
}

void Deblurrer::pause() {
  impl_->pause();
}

void Deblurrer::setParameters(const DeblurParameters& parameters) {
  impl_->setParameters(parameters);
}

const DeblurParameters& Deblurrer::parameters() const {
  return impl_->parameters();
}

const DeblurCounters& Deblurrer::counters() const {
  return impl_->counters();
}

std::size_t Deblurrer::bufferedEvents() const {
  return impl_->bufferedEvents();
}

DeblurStatus Deblurrer::status() const {
  return impl_->status();
}

}  // namespace fast_edi
