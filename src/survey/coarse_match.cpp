#include "survey/coarse_match.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi {
namespace {

/// Anticorrelation must be clearer than correlation to be taken for exchanged polarities.
constexpr double kClearlyInverted = 1.25;
/// Orientations are compared by so many samples.
constexpr std::size_t kFewSamples = 4;
/// Another orientation must fit so many times better than the one as recorded.
constexpr double kClearlyBetter = 1.5;

void orient(std::vector<TimingSample>& samples, const SampleGrid& grid,
            EventOrientation orientation) {
  for (TimingSample& sample : samples) {
    readExposure(sample.first, grid, orientation);
    readExposure(sample.second, grid, orientation);
  }
}

}  // namespace

CoarseMatch matchShifts(const std::vector<TimingSample>& samples, std::size_t stride,
                        const WindowModel& model, ContrastThresholds thresholds,
                        const ShiftRange& shifts, PairConsistency& consistency) {
  CoarseMatch match;
  double largest = 0.0;
  double most_negative = 0.0;
  double inverted_shift_ns = 0.0;
  const auto steps = static_cast<int>(shifts.range_ns / shifts.step_ns);
  WindowModel trial = model;
  for (int i = -steps; i <= steps; ++i) {
    trial.shift_ns = shifts.centre_ns + i * shifts.step_ns;
    ShiftPoint point{trial.shift_ns, 0.0, 0.0};
    std::size_t covered = 0;
    std::size_t used = 0;
    for (std::size_t k = 0; k < samples.size(); k += stride) {
      ++used;
      if (const auto measured = consistency.measure(samples[k], trial, thresholds)) {
        point.correlation += measured->correlation;
        point.cost += measured->cost;
        ++covered;
      }
    }
    // With few samples left a chance agreement would win.
    if (2 * covered < used || covered == 0) {
      continue;
    }
    point.correlation /= static_cast<double>(covered);
    point.cost /= static_cast<double>(covered);
    match.curve.push_back(point);
    if (point.correlation > largest) {
      largest = point.correlation;
      match.shift_ns = trial.shift_ns;
    }
    if (point.correlation < most_negative) {
      most_negative = point.correlation;
      inverted_shift_ns = trial.shift_ns;
    }
  }
  match.correlation = largest;
  if (-most_negative > kClearlyInverted * largest &&
      -most_negative > CoarseMatch::kLeastCorrelation) {
    match.correlation = most_negative;
    match.shift_ns = inverted_shift_ns;
    match.mapping.polarity = EventPolarity::kInverted;
  }
  return match;
}

CoarseMatch matchOrientations(std::vector<TimingSample>& samples, const SampleGrid& grid,
                              const WindowModel& model, ContrastThresholds thresholds,
                              const ShiftRange& shifts, PairConsistency& consistency) {
  CoarseMatch match = matchShifts(samples, 1, model, thresholds, shifts, consistency);
  if (!match.fits()) {
    const std::size_t stride = std::max<std::size_t>(1, samples.size() / kFewSamples);
    EventOrientation best = EventOrientation::kNormal;
    double fit =
        std::max(CoarseMatch::kLeastCorrelation, kClearlyBetter * std::abs(match.correlation));
    for (const auto& [word, orientation] : kEventOrientations) {
      static_cast<void>(word);
      orient(samples, grid, orientation);
      const CoarseMatch trial =
          matchShifts(samples, stride, model, thresholds, shifts, consistency);
      if (std::abs(trial.correlation) > fit) {
        fit = std::abs(trial.correlation);
        best = orientation;
      }
    }
    orient(samples, grid, best);
    if (best != EventOrientation::kNormal) {
      match = matchShifts(samples, 1, model, thresholds, shifts, consistency);
      match.mapping.orientation = best;
    }
  }
  if (match.mapping.polarity == EventPolarity::kInverted) {
    for (TimingSample& sample : samples) {
      invertPolarity(sample);
    }
    for (ShiftPoint& point : match.curve) {
      point.correlation = -point.correlation;
    }
  }
  return match;
}

}  // namespace fast_edi
