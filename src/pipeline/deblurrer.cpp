#include "fast_edi/pipeline/deblurrer.hpp"

#include <algorithm>
#include <cstdlib>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/calibration/online_calibration.hpp"
#include "fast_edi/events/event_counts.hpp"
#include "fast_edi/events/event_stream.hpp"
#include "fast_edi/exposure/exposure_pairing.hpp"
#include "fast_edi/exposure/exposure_window.hpp"
#include "fast_edi/exposure/stamp_limits.hpp"
#include "fast_edi/exposure/window_predictor.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/latent/latent_image.hpp"
#include "fast_edi/latent/middle_image.hpp"
#include "fast_edi/latent/motion_compensation.hpp"
#include "fast_edi/latent/temporal_fusion.hpp"
#include "fast_edi/video/latent_video.hpp"

namespace fast_edi {
namespace {

/// As many as the image queue of the nodelet holds. More can only wait when something is wrong, and
/// memory must not grow with it.
constexpr std::size_t kMaxWaitingFrames = 100;

/// Running sums of a window this close to the true one are still of use to DoubleIntegral.
constexpr std::int64_t kUsefulPrediction_ns = 50 * kNanosecondsPerMicrosecond;

PixelEventLists::Limits limitsOf(const DeblurParameters& parameters) {
  return {parameters.max_buffered_events, parameters.max_backward_jump_ns,
          parameters.max_forward_jump_ns};
}

/// Whether what was learned from the recording under \p a is what would be learned under \p b.
bool learnAlike(const DeblurParameters& a, const DeblurParameters& b) {
  return a.thresholds == b.thresholds && a.weighting == b.weighting && a.response == b.response &&
         a.time_offset_ns == b.time_offset_ns && a.event_mapping == b.event_mapping &&
         a.stamp_reference == b.stamp_reference && a.exposure_source == b.exposure_source &&
         a.exposure_time_ns == b.exposure_time_ns && a.filter.enabled == b.filter.enabled &&
         a.level == b.level && a.refine_contrast == b.refine_contrast &&
         a.refine_delay == b.refine_delay;
}

struct WaitingFrame {
  InputFrame input;
  std::uint64_t number;  ///< in order of arrival
  std::uint64_t epoch;   ///< of the frames' clock
  bool after_time_jump;  ///< that epoch began with a jump back
  std::int64_t arrival_ns;
  ExposureWindow window;
};

/// What DoubleIntegral was told to expect, in event time.
struct Expectation {
  ExposureInterval window;
  std::int64_t reference_ns;

  bool isNear(const Expectation& other) const {
    const auto near = [](std::int64_t a_ns, std::int64_t b_ns) {
      return std::abs(a_ns - b_ns) <= kUsefulPrediction_ns;
    };
    return near(window.start_ns, other.window.start_ns) &&
           near(window.end_ns, other.window.end_ns) && near(reference_ns, other.reference_ns);
  }
};

}  // namespace

class Deblurrer::Impl {
 public:
  Impl(const DeblurParameters& parameters, FrameSink& sink)
      : requested_(parameters),
        parameters_(parameters),
        sink_(sink),
        pairing_(parameters.close_timeout_ns, counters_),
        events_(limitsOf(parameters), counters_,
                [this](StreamBreak kind, std::int64_t next_ns) { beforeBreak(kind, next_ns); }),
        latent_image_(parameters.filter),
        middle_(latent_image_),
        video_(sink, latent_image_, compensation_) {}

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

  const DeblurParameters& parameters() const { return requested_; }
  const DeblurCounters& counters() const { return counters_; }
  std::size_t bufferedEvents() const;
  DeblurStatus status() const;

 private:
  // Events in
  void takeEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence);
  void takeEvents(const Event* events, std::size_t count, SensorSize size);

  // Frames in
  void beginFrameEpoch(bool after_time_jump);
  void takeMatches();
  void settle(WaitingFrame& frame);

  // Frames out
  bool isOutOfTime(const WaitingFrame& frame) const;
  FrameVerdict judge(const WaitingFrame& frame, bool out_of_time) const;
  void closeReady();
  void noteClocks(const FrameVerdict& verdict, const ExposureInterval& window);
  void closeFront(const FrameVerdict& verdict);
  void closeFrontWithWhatHasCome();
  void forgetBefore(std::int64_t t_ns);
  void beforeBreak(StreamBreak kind, std::int64_t next_event_ns);
  void deblur(OutputFrame& output, const ExposureInterval& window);
  ImageView steadied(const OutputFrame& output, const ExposureEvents& events,
                     const ExposureInterval& window, const MutableImageView& image);
  void passThrough(OutputFrame& output, PassReason reason);
  bool isLaterThanLastOutput(const WaitingFrame& frame, std::int64_t stamp_ns) const;

  // Integral
  bool prepareIntegral(bool may_allocate);
  void expectNext();
  void follow();

  // Calibration
  bool calibrates() const;
  void calibrate(const OutputFrame& output, const ExposureInterval& window,
                 std::int64_t reference_ns);
  void resetCalibration();
  void applyCalibration(const Calibration& calibration);

  DeblurParameters requested_;   ///< by the user
  DeblurParameters parameters_;  ///< the same with the calibration in force
  FrameSink& sink_;
  DeblurCounters counters_;
  ExposurePairing pairing_;
  EventStream events_;
  std::vector<std::uint8_t> mapped_events_;  ///< the last array's records; keeps its memory
  WindowPredictor predictor_;
  std::int64_t now_ns_ = INT64_MIN;
  std::optional<std::int64_t> last_events_ns_;  ///< arrival of the last array that holds any
  bool clocks_differ_ = false;                  ///< as the last frame showed
  ClockPair differing_clocks_;

  std::deque<WaitingFrame> waiting_;
  std::uint64_t next_number_ = 0;
  std::vector<ExposureMatch> matches_;  ///< empty between calls; keeps its memory

  SensorSize frame_size_;
  std::uint64_t epoch_ = 0;
  bool after_time_jump_ = false;
  std::optional<std::int64_t> latest_stamp_ns_;  ///< of the input frames of this epoch
  std::uint64_t output_epoch_ = 0;
  std::optional<std::int64_t> last_output_ns_;

  std::unique_ptr<DoubleIntegral> integral_;
  SensorSize integral_size_;
  std::uint64_t integral_generation_ = 0;
  std::vector<float> gain_;
  std::optional<EventCounts> event_counts_;       ///< of the integral's size; for the filters alone
  std::optional<OnlineCalibration> calibration_;  ///< of the integral's size
  std::uint64_t calibration_generation_ = 0;      ///< of the lists that it learned from
  std::vector<float> unfiltered_gain_;            ///< for it
  LatentImage latent_image_;
  MiddleImage middle_;
  MotionCompensation compensation_;
  LatentVideo video_;
  TemporalFusion fusion_;
  std::optional<Expectation> expectation_;
};

void Deblurrer::Impl::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                                std::int64_t now_ns) {
  advance(now_ns);
  if (!events.empty()) {
    last_events_ns_ = now_ns_;
  }
  takeEvents(events, size, sequence);
  closeReady();
  follow();
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

void Deblurrer::Impl::addEvents(const Event* events, std::size_t count, SensorSize size,
                                std::int64_t now_ns) {
  advance(now_ns);
  if (count > 0) {
    last_events_ns_ = now_ns_;
  }
  takeEvents(events, count, size);
  closeReady();
  follow();
}

/// Plain events, by way of wire records.
void Deblurrer::Impl::takeEvents(const Event* events, std::size_t count, SensorSize size) {
  const EventMapping& mapping = parameters_.event_mapping;
  mapped_events_.clear();
  mapped_events_.reserve(count * kWireEventBytes);
  std::for_each(events, events + count, [&](const Event& event) {
    if (isStamp(event.t_ns)) {
      encodeWireEvent(mapping.apply(event, size), mapped_events_);
    }
  });
  const std::size_t valid = mapped_events_.size() / kWireEventBytes;
  counters_.events_in += count - valid;
  counters_.events_glitched += count - valid;
  events_.take({mapped_events_.data(), valid}, mapping.apply(size), std::nullopt);
}

void Deblurrer::Impl::addFrame(InputFrame frame, std::int64_t now_ns) {
  advance(now_ns);
  ++counters_.frames_in;
  if (latest_stamp_ns_ && frame.stamp_ns < *latest_stamp_ns_ - parameters_.max_backward_jump_ns) {
    ++counters_.frame_time_jumps;
    beginFrameEpoch(true);
  }
  latest_stamp_ns_ = std::max(latest_stamp_ns_.value_or(frame.stamp_ns), frame.stamp_ns);
  if (frame.supported) {
    frame_size_ = frame.image.size;
  }

  const bool by_topic = parameters_.exposure_source == ExposureSource::kTopic;
  const std::uint64_t number = next_number_++;
  const ExposureWindow window(frame.stamp_ns, by_topic);
  waiting_.push_back({std::move(frame), number, epoch_, after_time_jump_, now_ns_, window});
  if (by_topic) {
    pairing_.addImage(number, now_ns_, matches_);
    takeMatches();
  }
  if (waiting_.size() > kMaxWaitingFrames) {
    settle(waiting_.front());
    const FrameVerdict verdict = judge(waiting_.front(), false);
    closeFront(verdict.isFinal()
                   ? verdict
                   : FrameVerdict{FrameState::kPassThrough, PassReason::kTooManyWaiting});
  }
  closeReady();
  expectNext();
}

void Deblurrer::Impl::addExposure(std::int32_t exposure_us, std::int64_t now_ns) {
  advance(now_ns);
  if (parameters_.exposure_source == ExposureSource::kParameter) {
    pairing_.note(exposure_us);
    return;
  }
  pairing_.addMessage(exposure_us, now_ns_, matches_);
  takeMatches();
  closeReady();
  expectNext();
}

void Deblurrer::Impl::advance(std::int64_t now_ns) {
  now_ns_ = std::max(now_ns_, now_ns);
  if (parameters_.exposure_source == ExposureSource::kTopic) {
    pairing_.advance(now_ns_, matches_);
    takeMatches();
  }
  closeReady();
}

void Deblurrer::Impl::finish() {
  events_.dropHeld();
  pairing_.finish(matches_);
  takeMatches();
  closeReady();
  while (!waiting_.empty()) {
    closeFrontWithWhatHasCome();
  }
}

void Deblurrer::Impl::pause() {
  counters_.frames_abandoned += waiting_.size();
  waiting_.clear();
  events_.restart();
  pairing_.restart();
  expectation_.reset();
  video_.breakOff();
  fusion_.forget();
  beginFrameEpoch(false);
}

void Deblurrer::Impl::setParameters(const DeblurParameters& parameters) {
  validate(parameters);
  const bool source_changes = parameters.exposure_source != parameters_.exposure_source;
  if (!learnAlike(parameters, requested_)) {
    calibration_.reset();
  }
  const bool mapping_changes = parameters.event_mapping != parameters_.event_mapping;
  requested_ = parameters;
  parameters_ = parameters;
  if (calibration_) {
    const Calibration& learned = calibration_->inForce();
    parameters_.thresholds = learned.thresholds;
    parameters_.time_offset_ns += learned.event_delay_ns;
  }
  events_.setLimits(limitsOf(parameters_));
  if (mapping_changes) {
    events_.restart();
  }
  pairing_.setTimeout(parameters_.close_timeout_ns);
  if (source_changes) {
    pairing_.restart();
    for (WaitingFrame& frame : waiting_) {
      settle(frame);
    }
  }
  if (integral_ && (integral_->weighting() != parameters_.weighting ||
                    integral_->level() != levelModel(parameters_))) {
    integral_.reset();
    expectation_.reset();
  }
  if (integral_ && integral_->thresholds() != parameters_.thresholds) {
    integral_->setThresholds(parameters_.thresholds);
    expectation_.reset();
  }
  latent_image_.setParameters(parameters_.filter);
  video_.breakOff();
  fusion_.forget();
  expectNext();
}

std::size_t Deblurrer::Impl::bufferedEvents() const {
  return events_.lists() != nullptr ? events_.lists()->eventCount() : 0;
}

DeblurStatus Deblurrer::Impl::status() const {
  DeblurStatus status;
  status.buffered_events = bufferedEvents();
  status.waiting_frames = waiting_.size();
  status.events_seen = events_.seen();
  status.sensor_size = frame_size_;
  status.buffer_bytes = events_.memoryBytes() + mapped_events_.capacity() +
                        (gain_.capacity() + unfiltered_gain_.capacity()) * sizeof(float) +
                        fusion_.memoryBytes() + latent_image_.memoryBytes() + video_.memoryBytes() +
                        middle_.memoryBytes() + compensation_.memoryBytes() +
                        (integral_ ? integral_->memoryBytes() : 0) +
                        (event_counts_ ? event_counts_->memoryBytes() : 0) +
                        (calibration_ ? calibration_->memoryBytes() : 0);
  if (events_.lists() != nullptr) {
    status.sensor_size = events_.lists()->size();
  }
  const bool by_topic = parameters_.exposure_source == ExposureSource::kTopic;
  status.last_exposure_ns = by_topic && pairing_.last() ? *pairing_.last()  //
                                                        : parameters_.exposure_time_ns;
  status.exposure_known = status.last_exposure_ns > 0;
  status.thresholds = parameters_.thresholds;
  status.differing_clocks = differing_clocks_;
  status.event_delay_ns = parameters_.time_offset_ns - requested_.time_offset_ns;
  return status;
}

// --- Frames in -----------------------------------------------------------------------------------

void Deblurrer::Impl::beginFrameEpoch(bool after_time_jump) {
  ++epoch_;
  after_time_jump_ = after_time_jump;
  latest_stamp_ns_.reset();
  clocks_differ_ = false;
  predictor_.reset();
}

/// Hands lengths over to the frames that waited for them. Frames that left early are not there any
/// more; their messages still had to be counted off.
void Deblurrer::Impl::takeMatches() {
  for (const ExposureMatch& match : matches_) {
    if (waiting_.empty() || match.image < waiting_.front().number) {
      continue;
    }
    WaitingFrame& frame = waiting_[static_cast<std::size_t>(match.image - waiting_.front().number)];
    if (match.own_ns) {
      frame.window.settle(match.own_ns);
    } else {
      settle(frame);
    }
  }
  matches_.clear();
}

/// Without its own message a frame takes the last value received, else the parameter.
void Deblurrer::Impl::settle(WaitingFrame& frame) {
  if (frame.window.awaitsMessage()) {
    const bool by_topic = parameters_.exposure_source == ExposureSource::kTopic;
    frame.window.settle(by_topic ? pairing_.last() : std::nullopt);
  }
}

// --- Frames out ----------------------------------------------------------------------------------

bool Deblurrer::Impl::isOutOfTime(const WaitingFrame& frame) const {
  return now_ns_ - frame.arrival_ns >= parameters_.close_timeout_ns;
}

FrameVerdict Deblurrer::Impl::judge(const WaitingFrame& frame, bool out_of_time) const {
  const std::int64_t until_ns = std::min(now_ns_, frame.arrival_ns + parameters_.close_timeout_ns);
  FrameTraits traits;
  traits.supported = frame.input.supported;
  traits.size = frame.input.image.size;
  traits.after_time_jump = frame.after_time_jump;
  traits.stream_silent =
      !last_events_ns_ || until_ns - *last_events_ns_ >= parameters_.close_timeout_ns;
  traits.clocks_differed = clocks_differ_;
  return frame.window.judge(traits, events_, parameters_, out_of_time);
}

void Deblurrer::Impl::closeReady() {
  // Before any window is computed: a learned delay of events is part of it.
  if (calibration_generation_ != events_.generation()) {
    calibration_generation_ = events_.generation();
    resetCalibration();
    clocks_differ_ = false;
  }
  while (!waiting_.empty()) {
    FrameVerdict verdict = judge(waiting_.front(), false);
    if (!verdict.isFinal()) {
      if (!isOutOfTime(waiting_.front())) {
        return;
      }
      ++counters_.frames_timed_out;
      closeFrontWithWhatHasCome();
      continue;
    }
    closeFront(verdict);
  }
}

void Deblurrer::Impl::closeFrontWithWhatHasCome() {
  settle(waiting_.front());
  closeFront(judge(waiting_.front(), true));
}

/// The event clock jumps: frames of the old epoch get nothing more. The sensor's size changes:
/// frames up to there have all they need, which the stream itself knows.
void Deblurrer::Impl::beforeBreak(StreamBreak kind, std::int64_t next_event_ns) {
  closeReady();
  if (kind != StreamBreak::kTimeJump) {
    return;
  }
  const std::int64_t newest_ns = events_.lists()->newest();
  while (!waiting_.empty()) {
    // A frame may be there before the first event of its epoch: it belongs where it is nearer.
    const std::int64_t end_ns = waiting_.front().window.inEventTime(parameters_).end_ns;
    if (std::abs(end_ns - next_event_ns) < std::abs(end_ns - newest_ns)) {
      return;
    }
    closeFrontWithWhatHasCome();
  }
}

bool Deblurrer::Impl::isLaterThanLastOutput(const WaitingFrame& frame,
                                            std::int64_t stamp_ns) const {
  return frame.epoch != output_epoch_ || !last_output_ns_ || stamp_ns > *last_output_ns_;
}

/// Remembers that frames lie ahead of the events until the events have reached one.
void Deblurrer::Impl::noteClocks(const FrameVerdict& verdict, const ExposureInterval& window) {
  if (verdict.state == FrameState::kReady) {
    clocks_differ_ = false;
  } else if (verdict.reason == PassReason::kClocksDiffer) {
    clocks_differ_ = !events_.isPast(window.start_ns);
    differing_clocks_ = {window.at(parameters_.stamp_reference), events_.lists()->newest()};
  }
}

/// \pre verdict.isFinal()
void Deblurrer::Impl::closeFront(const FrameVerdict& verdict) {
  WaitingFrame frame = std::move(waiting_.front());
  waiting_.pop_front();

  const bool unchanged = parameters_.passthrough;
  const bool exposure_known = !unchanged && frame.window.length(parameters_) > 0;
  OutputFrame output;
  output.input = std::move(frame.input);
  output.stamp_ns = frame.window.stamp();
  output.exposure = {frame.window.stamp(), frame.window.stamp()};
  if (exposure_known) {
    output.exposure = frame.window.inFrameTime(parameters_);
    output.stamp_ns = output.exposure.at(parameters_.reference);
  }
  // A frame stamped near the beginning of time may begin before it.
  output.stamp_ns = std::clamp(output.stamp_ns, std::int64_t{0}, kLastStamp_ns);
  if (!isLaterThanLastOutput(frame, output.stamp_ns)) {
    ++counters_.frames_suppressed;
    return;
  }
  output_epoch_ = frame.epoch;
  last_output_ns_ = output.stamp_ns;

  const ExposureInterval window = frame.window.inEventTime(parameters_);
  noteClocks(verdict, window);
  if (verdict.state == FrameState::kReady) {
    deblur(output, window);
  } else {
    passThrough(output, verdict.reason);
  }

  if (exposure_known && frame.epoch == epoch_) {
    predictor_.observe(output.exposure);
  }
  // Where no exposure is known, the next frame's may reach back as far as any can.
  forgetBefore(exposure_known ? window.start_ns : window.start_ns - kMaxExposure_ns);
  expectNext();
}

/// Drops events that neither a later frame nor the calibration needs.
void Deblurrer::Impl::forgetBefore(std::int64_t t_ns) {
  // A stamp far ahead of all events is no reason to throw them away.
  if (events_.isPast(t_ns)) {
    const std::int64_t needed_ns = calibration_ ? std::min(t_ns, calibration_->neededFrom()) : t_ns;
    // Ramps of an exposure's first events begin before it, should they be asked for from now on.
    events_.discardBefore(needed_ns - kLongestRamp_ns);
  }
}

void Deblurrer::Impl::deblur(OutputFrame& output, const ExposureInterval& window) {
  prepareIntegral(true);
  const ExposureInterval& exposure = output.exposure;
  const std::int64_t reference_ns =
      window.start_ns + (exposure.at(parameters_.reference) - exposure.start_ns);
  const CloseReport report = integral_->close(*events_.lists(), window, reference_ns, gain_.data());
  expectation_.reset();
  if (parameters_.filter.enabled) {
    event_counts_->close(*events_.lists(), window);
  }
  const ExposureEvents exposure_events{event_counts_->data(), parameters_.thresholds};
  const LevelInstant reference{reference_ns, window.end_ns};
  const LatentGains::Model model{parameters_.thresholds, levelModel(parameters_)};
  const bool wants_video = parameters_.latent.isOn() && sink_.wantsLatentImages();
  if (wants_video) {
    video_.take(output, output_epoch_, gain_, *event_counts_, *events_.lists(), reference,
                parameters_);
  } else {
    video_.breakOff();
  }
  const bool calibrates = this->calibrates();
  if (calibrates) {
    unfiltered_gain_ = gain_;
  }
  const bool steadies = parameters_.filter.enabled && parameters_.filter.motion;
  if (steadies && parameters_.reference != ExposureInstant::kMid) {
    middle_.take(gain_, *events_.lists(), reference, model);
  }
  const MutableImageView out = sink_.begin(output.input);
  if (out.data != nullptr) {
    latent_image_.write(output.input.image, gain_.data(), exposure_events, parameters_.response,
                        out);
  }
  if (steadies) {
    const ImageView middle = steadied(output, exposure_events, window, out);
    if (wants_video) {
      video_.setMiddle(middle);
    }
  }
  if (parameters_.filter.enabled && parameters_.filter.temporal > 0.0) {
    fusion_.apply({reference, window.length(), output_epoch_}, events_, model, parameters_.response,
                  parameters_.filter.temporal, out);
  }

  ++counters_.frames_deblurred;
  counters_.frames_still += report.events == 0 ? 1 : 0;
  counters_.closes_followed += report.kind == CloseKind::kFollowed ? 1 : 0;
  counters_.closes_surprise += report.kind == CloseKind::kSurprise ? 1 : 0;
  counters_.pixels_out_of_range += report.out_of_range;
  output.deblurred = true;
  output.events = report.events;
  sink_.finish(output);
  if (wants_video) {  // behind the frame itself, which somebody waits for
    counters_.latent_images += video_.write(events_, parameters_);
  }
  if (calibrates) {
    calibrate(output, window, reference_ns);
  } else if (calibration_) {
    calibration_->skipFrame();
  }
}

/// Steadies the latent image at the reference by that of mid-exposure, unless it is that.
/// \return the one of mid-exposure, valid until the next call
/// \pre unless the reference is mid-exposure: middle_ has taken this frame
ImageView Deblurrer::Impl::steadied(const OutputFrame& output, const ExposureEvents& events,
                                    const ExposureInterval& window, const MutableImageView& image) {
  if (parameters_.reference == ExposureInstant::kMid) {
    return {image.data, image.size, image.step, image.format};
  }
  const ImageView middle =
      middle_.show(output.input.image, events, *events_.lists(),
                   {window.at(ExposureInstant::kMid), window.end_ns}, parameters_.response);
  compensation_.setReference(middle);
  compensation_.apply(image);
  return middle;
}

void Deblurrer::Impl::passThrough(OutputFrame& output, PassReason reason) {
  video_.breakOff();
  fusion_.forget();
  if (calibration_) {
    calibration_->interrupt();
  }
  const ImageView& blurry = output.input.image;
  const MutableImageView out = sink_.begin(output.input);
  if (blurry.data != nullptr && out.data != nullptr) {  // else its pixels are the sink's own matter
    copyPixels(blurry, out);
  }
  ++counters_.frames_passed[static_cast<std::size_t>(reason)];
  output.pass_reason = reason;
  sink_.finish(output);
}

// --- Integral ------------------------------------------------------------------------------------

/// Makes the integral fit the lists. Per-pixel memory is taken only once a frame of the sensor's
/// size has come, so that a nonsensical size in an event array costs nothing.
/// \return false while it cannot be used
bool Deblurrer::Impl::prepareIntegral(bool may_allocate) {
  if (!integral_ || integral_size_ != events_.lists()->size()) {
    if (!may_allocate) {
      return false;
    }
    integral_.reset();  // before the new one, so that both are never held at once
    integral_size_ = events_.lists()->size();
    integral_ = std::make_unique<DoubleIntegral>(integral_size_, parameters_.thresholds,
                                                 parameters_.weighting, levelModel(parameters_));
    gain_.resize(integral_size_.pixelCount());
    event_counts_.emplace(integral_size_);
    expectation_.reset();
    resetCalibration();
  }
  events_.keepIntervals(!integral_->level().isStaircase());
  if (integral_generation_ != events_.generation()) {
    integral_->forget();
    event_counts_->forget();
    integral_generation_ = events_.generation();
    expectation_.reset();
  }
  return true;
}

/// Names the next window: that of the frame in front as far as it is known, else the predicted one.
void Deblurrer::Impl::expectNext() {
  if (parameters_.passthrough || events_.lists() == nullptr ||
      !prepareIntegral(frame_size_ == events_.lists()->size())) {
    return;
  }
  std::optional<ExposureInterval> next = predictor_.predict();
  if (!waiting_.empty()) {
    const ExposureWindow& front = waiting_.front().window;
    const std::int64_t known_ns = front.length(parameters_);
    const std::int64_t length_ns = known_ns > 0 ? known_ns : predictor_.lastLength();
    next = exposureInterval(front.stamp(), length_ns, parameters_.stamp_reference);
  }
  if (!next || next->length() == 0) {
    return;
  }
  const Expectation expectation{
      {next->start_ns + parameters_.time_offset_ns, next->end_ns + parameters_.time_offset_ns},
      next->at(parameters_.reference) + parameters_.time_offset_ns};
  if (!expectation_ || !expectation_->isNear(expectation)) {
    integral_->expect(expectation.window, expectation.reference_ns);
    expectation_ = expectation;
  }
}

void Deblurrer::Impl::follow() {
  if (!parameters_.passthrough && events_.lists() != nullptr && prepareIntegral(false)) {
    integral_->follow(*events_.lists());
    if (parameters_.filter.enabled && expectation_) {
      event_counts_->follow(*events_.lists(), expectation_->window);
    }
  }
}

// --- Calibration ---------------------------------------------------------------------------------

/// True when the frame that is about to be closed is needed for it.
bool Deblurrer::Impl::calibrates() const {
  return parameters_.filter.enabled && (parameters_.refine_contrast || parameters_.refine_delay) &&
         (!calibration_ || calibration_->wantsNextFrame());
}

/// Learns from the frame that was just published and the one before it.
void Deblurrer::Impl::calibrate(const OutputFrame& output, const ExposureInterval& window,
                                std::int64_t reference_ns) {
  if (!calibration_) {
    OnlineCalibration::Settings settings;
    settings.contrast = parameters_.refine_contrast;
    settings.delay = parameters_.refine_delay;
    settings.level = levelModel(parameters_);
    calibration_.emplace(integral_size_, requested_.thresholds, settings);
  }
  if (!events_.covers({std::min(window.start_ns, calibration_->neededFrom()), window.end_ns})) {
    calibration_->interrupt();
  }
  const CalibrationOutcome outcome =
      calibration_->addFrame({window, reference_ns, output.input.image, unfiltered_gain_.data()},
                             parameters_.response, *events_.lists());
  counters_.calibration_fits += outcome == CalibrationOutcome::kFitted ? 1 : 0;
  counters_.calibration_holes += outcome == CalibrationOutcome::kNoEventsBetween ? 1 : 0;
  applyCalibration(calibration_->inForce());
}

/// After the events were lost, what follows must be that of a fresh start.
void Deblurrer::Impl::resetCalibration() {
  calibration_.reset();
  applyCalibration({requested_.thresholds, 0});
}

void Deblurrer::Impl::applyCalibration(const Calibration& calibration) {
  parameters_.time_offset_ns = requested_.time_offset_ns + calibration.event_delay_ns;
  if (parameters_.thresholds != calibration.thresholds) {
    parameters_.thresholds = calibration.thresholds;
    if (integral_) {
      integral_->setThresholds(parameters_.thresholds);
    }
    expectation_.reset();
  }
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
