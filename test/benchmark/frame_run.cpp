#include "frame_run.hpp"

#include <algorithm>

#include "timing.hpp"

namespace fast_edi::benchmarks {

namespace {

/// Frames before the measurement: vectors grow to their capacity, the period is learned.
constexpr int kWarmUpFrames = 4;
constexpr std::uint64_t kImageSeed = 7;

/// Offsets from the regular exposure, played in turn.
constexpr std::int64_t kJitters_ns[] = {0, 8'000, -6'000, 7'000, -8'000, 2'000};
constexpr std::int64_t kSurprises_ns[] = {3'100'000, 400'000, 5'900'000, 1'700'000, 4'500'000};

template <std::size_t n>
std::int64_t inTurn(const std::int64_t (&values)[n], std::uint64_t index) {
  return values[index % n];
}

}  // namespace

FrameRun::FrameRun(Method method, Exposures exposures, PeriodicStream& stream)
    : method_(method),
      exposures_(exposures),
      stream_(stream),
      contender_(makeContender(method, stream.settings().size)),
      blurry_(testing::makeGreyImage(stream.settings().size, kImageSeed)),
      latent_(blurry_.size()) {}

ExposureInterval FrameRun::nextExposure() {
  ExposureInterval exposure = stream_.exposure();
  const std::int64_t offset_ns = exposures_ == Exposures::kJittering ? inTurn(kJitters_ns, frame_)
                                 : exposures_ == Exposures::kNotPredicted
                                     ? inTurn(kSurprises_ns, frame_)
                                     : 0;
  exposure.start_ns += offset_ns;
  exposure.end_ns += offset_ns;
  ++frame_;
  return exposure;
}

FrameCost FrameRun::play() {
  stream_.next();
  const ExposureInterval exposure = nextExposure();
  // As live: the frame comes after its readout, when some later events are there already.
  const auto packets_before =
      static_cast<std::size_t>((exposure.end_ns - stream_.start()) / kPacket_ns) + 2;

  FrameCost cost;
  const Stopwatch before;
  contender_->begin(exposure);
  for (std::size_t i = 0; i < packets_before; ++i) contender_->add(stream_.packet(i));
  cost.take_in_s = before.seconds();
  most_buffered_ = std::max(most_buffered_, contender_->memory().buffered_events);

  const Stopwatch closing;
  contender_->close(exposure, blurry_.data(), latent_.data());
  cost.close_s = closing.seconds();

  const Stopwatch after;
  for (std::size_t i = packets_before; i < stream_.packetCount(); ++i) {
    contender_->add(stream_.packet(i));
  }
  cost.take_in_s += after.seconds();
  return cost;
}

std::size_t FrameRun::events() const {
  return method_ == Method::kVanilla ? stream_.settings().events_per_exposure : stream_.all().count;
}

void measureFrames(benchmark::State& state, Method method, Exposures exposures, Part part,
                   const StreamSettings& settings) {
  FrameRun run(method, exposures, sharedStream(settings));
  for (int i = 0; i < kWarmUpFrames; ++i) run.play();

  std::vector<double> measured, take_in, close;
  for (auto _ : state) {
    const FrameCost cost = run.play();
    take_in.push_back(cost.take_in_s);
    close.push_back(cost.close_s);
    measured.push_back(part == Part::kTakeIn  ? cost.take_in_s
                       : part == Part::kClose ? cost.close_s
                                              : cost.total());
    state.SetIterationTime(measured.back());
  }
  const std::string fault = run.fault();
  if (!fault.empty()) {
    state.SkipWithError(fault.c_str());
    return;
  }

  constexpr double kMedian = 0.5, kHigh = 0.9, kLow = 0.1;
  const auto events = static_cast<double>(run.events());
  const double median = percentile(measured, kMedian);
  state.counters["events"] = events;
  state.counters["Mev_per_s"] = events / median * 1e-6;
  state.counters["ns_per_event"] = median / events * 1e9;
  state.counters["ns_per_event_p10"] = percentile(measured, kLow) / events * 1e9;
  state.counters["ns_per_event_p90"] = percentile(measured, kHigh) / events * 1e9;
  state.counters["take_in_ms"] = percentile(take_in, kMedian) * 1e3;
  state.counters["close_ms"] = percentile(close, kMedian) * 1e3;
  state.counters["close_ms_p90"] = percentile(close, kHigh) * 1e3;
  state.counters["memory_bytes"] = static_cast<double>(run.memory().bytes);
  state.counters["buffered_events"] = static_cast<double>(run.memory().buffered_events);
  state.counters["pixels"] = static_cast<double>(settings.size.pixelCount());
}

std::int64_t frameCount(Method method, const StreamSettings& settings) {
  constexpr double kOursPerSecond = 300e6, kPaperPerSecond = 30e6;
  constexpr std::int64_t kFewest = 7, kMost = 200;
  if (method == Method::kVanilla) return 5;
  const double events_per_second = method == Method::kPaper ? kPaperPerSecond : kOursPerSecond;
  const auto frames = static_cast<std::int64_t>(events_per_second /
                                                static_cast<double>(settings.events_per_exposure));
  return std::min(std::max(frames, kFewest), kMost);
}

std::string runName(Method method, Exposures exposures, const StreamSettings& settings) {
  return std::string(toString(method)) + "/" + toString(exposures) + "/" +
         testing::toString(settings.scene) + "/" + toString(settings.size) + "/" +
         std::to_string(settings.events_per_exposure);
}

}  // namespace fast_edi::benchmarks
