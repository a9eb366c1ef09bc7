/// \file
/// Plays a periodic stream through a contender and times taking in events apart from closing
/// frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "contender.hpp"
#include "periodic_stream.hpp"

namespace fast_edi::benchmarks {

/// Processor seconds of one frame.
struct FrameCost {
  double take_in_s = 0.0;  ///< all events of the period
  double close_s = 0.0;    ///< from the last needed event to the finished image

  double total() const { return take_in_s + close_s; }
};

class FrameRun {
 public:
  FrameRun(Method method, Exposures exposures, PeriodicStream& stream);

  /// Plays one period and closes its frame.
  FrameCost play();

  /// Events that one play() hands over and that the method works on: vanilla EDI skips those
  /// outside the exposure.
  std::size_t events() const;
  std::string fault() const { return contender_->fault(exposures_); }
  /// Memory at the end, and the most events that were buffered when a frame was closed.
  Memory memory() const { return {contender_->memory().bytes, most_buffered_}; }

 private:
  ExposureInterval nextExposure();

  Method method_;
  Exposures exposures_;
  PeriodicStream& stream_;
  std::unique_ptr<Contender> contender_;
  std::vector<std::uint8_t> blurry_;
  std::vector<std::uint8_t> latent_;
  std::uint64_t frame_ = 0;
  std::size_t most_buffered_ = 0;
};

/// Which part of a frame counts as the benchmark's time.
enum class Part { kTakeIn, kClose, kAll };

/// Body of a benchmark: plays frames and sets the counters that the scripts read:
/// Mev_per_s and ns_per_event (of the part), take_in_ms and close_ms (medians), close_ms_p90,
/// memory_bytes, buffered_events, pixels.
void measureFrames(benchmark::State& state, Method method, Exposures exposures, Part part,
                   const StreamSettings& settings);

/// Frames to play so that a benchmark takes about a second.
std::int64_t frameCount(Method method, const StreamSettings& settings);

/// "ours/periodic/uniform/346x260/400000"
std::string runName(Method method, Exposures exposures, const StreamSettings& settings);

}  // namespace fast_edi::benchmarks
