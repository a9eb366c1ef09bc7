#include "survey/timing_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <utility>

#include "survey/finding.hpp"
#include "survey/pair_consistency.hpp"

namespace fast_edi {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Steps of the coarse search: this part of the exposure, within limits.
constexpr double kCoarsePart = 0.25;
constexpr double kFinestCoarse_ns = 1.5 * kMs;
constexpr double kWidestCoarse_ns = 5.0 * kMs;
/// An unknown exposure is taken as this part of the frame period to begin with.
constexpr double kGuessedDuty = 0.3;
/// Lengths that vary less do not show what stamps mean.
constexpr double kLeastVariation = 0.04;
constexpr int kCurveSteps = 6;  ///< of the fine curve, to either side
constexpr int kBootstraps = 200;
/// Of all bootstraps, that a meaning of the stamps must win to be believed.
constexpr double kBelieved = 0.95;
/// A length is told when its relative uncertainty is below.
constexpr double kLargestLengthSigma = 0.3;
/// Grid around the length and the thresholds found [natural log].
constexpr double kLengthStep = 0.15;
constexpr int kLengthSteps = 7;
constexpr double kScaleStep = 0.15;
constexpr int kScaleSteps = 3;
/// What a sensor differs by from the model (response, mismatch, noise, filters), which no samples
/// of one recording show [relative, one sigma]: on simulated recordings, see the tests.
constexpr double kLengthModelError = 0.18;
constexpr double kThresholdModelError = 0.10;
/// Thresholds are looked for within these bounds.
constexpr double kLeastThreshold = 0.02;
constexpr double kLargestThreshold = 1.5;
/// The estimate itself is not better than this, on simulated recordings with known truth.
constexpr double kSystematic_ns = 0.15 * kMs;

/// What is searched for.
struct Guess {
  WindowModel model;
  ContrastThresholds thresholds;
};

bool isWithinBounds(const ContrastThresholds& thresholds) {
  return std::min(thresholds.on, thresholds.off) >= kLeastThreshold &&
         std::max(thresholds.on, thresholds.off) <= kLargestThreshold;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) {
    sum += value;
  }
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Position of the least value of points at -n .. n, by a parabola through the least and its
/// neighbours; at the edges, the edge.
double minimumPosition(const std::vector<double>& values) {
  const auto least =
      static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
  const std::size_t centre = values.size() / 2;
  const auto middle = static_cast<double>(centre);
  const double position = static_cast<double>(least) - middle;
  if (least == 0 || least + 1 == values.size()) {
    return position;
  }
  const double before = values[least - 1];
  const double after = values[least + 1];
  const double bend = before - 2.0 * values[least] + after;
  return bend > 0.0 ? position + 0.5 * (before - after) / bend : position;
}

/// The least value by the same parabola.
double leastValue(const std::vector<double>& values) {
  const auto least =
      static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
  if (least == 0 || least + 1 == values.size()) {
    return values[least];
  }
  const double slope = 0.5 * (values[least + 1] - values[least - 1]);
  const double bend = values[least - 1] - 2.0 * values[least] + values[least + 1];
  return bend > 0.0 ? values[least] - 0.5 * slope * slope / bend : values[least];
}

/// Costs of each sample (rows) along some search direction (columns).
using CostTable = std::vector<std::vector<double>>;

std::vector<double> columnSums(const CostTable& table, const std::vector<std::size_t>& rows) {
  std::vector<double> sums(table.front().size());
  for (const std::size_t row : rows) {
    for (std::size_t i = 0; i < sums.size(); ++i) {
      sums[i] += table[row][i];
    }
  }
  return sums;
}

struct LocatedMinimum {
  double position = 0.0;
  double sigma = 0.0;
};

std::vector<std::size_t> drawRows(std::mt19937& random, std::size_t count) {
  std::vector<std::size_t> rows(count);
  for (std::size_t& row : rows) {
    row = random() % count;
  }
  return rows;
}

/// Where the column sums of a table are least.
using Finder = std::function<double(const std::vector<double>& sums)>;

/// \param find by default the minimum itself
/// \return the minimum of a table's column sums and its bootstrap uncertainty
LocatedMinimum locate(const CostTable& table, const Finder& find = minimumPosition) {
  std::vector<std::size_t> all(table.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = i;
  }
  LocatedMinimum located;
  located.position = find(columnSums(table, all));
  std::mt19937 random(1);  // equal recordings give equal reports
  double squares = 0.0;
  for (int i = 0; i < kBootstraps; ++i) {
    const double drawn = find(columnSums(table, drawRows(random, table.size())));
    squares += (drawn - located.position) * (drawn - located.position);
  }
  // Drawn with replacement, n samples vary by (n - 1) / n of what n new ones would.
  const auto n = static_cast<double>(table.size());
  located.sigma = std::sqrt(squares / kBootstraps * (n > 1.0 ? n / (n - 1.0) : 1.0));
  return located;
}

/// What guesses cost on the samples.
class SampleCosts {
 public:
  /// Keeps references to both.
  SampleCosts(const std::vector<TimingSample>& samples, PairConsistency& consistency)
      : samples_(samples), consistency_(consistency) {}

  /// Mean over the samples that cover the guess; infinite where fewer than half of them do.
  double mean(const Guess& guess);
  /// One row for each sample that covers all guesses.
  CostTable table(const std::vector<Guess>& guesses);

 private:
  std::optional<std::vector<double>> row(const std::vector<Guess>& guesses,
                                         const TimingSample& sample);

  const std::vector<TimingSample>& samples_;
  PairConsistency& consistency_;
};

double SampleCosts::mean(const Guess& guess) {
  double sum = 0.0;
  std::size_t covered = 0;
  for (const TimingSample& sample : samples_) {
    if (const auto measured = consistency_.measure(sample, guess.model, guess.thresholds)) {
      sum += measured->cost;
      ++covered;
    }
  }
  if (2 * covered < samples_.size() || covered == 0) {
    return kInfinity;
  }
  return sum / static_cast<double>(covered);
}

std::optional<std::vector<double>> SampleCosts::row(const std::vector<Guess>& guesses,
                                                    const TimingSample& sample) {
  std::vector<double> costs;
  for (const Guess& guess : guesses) {
    const auto measured = consistency_.measure(sample, guess.model, guess.thresholds);
    if (!measured) {
      return std::nullopt;
    }
    costs.push_back(measured->cost);
  }
  return costs;
}

CostTable SampleCosts::table(const std::vector<Guess>& guesses) {
  CostTable rows;
  for (const TimingSample& sample : samples_) {
    if (auto costs = row(guesses, sample)) {
      rows.push_back(std::move(*costs));
    }
  }
  return rows;
}

/// One of the quantities that a search varies.
struct Direction {
  std::function<void(Guess&, double step)> move;
  double step = 0.0;
  double least = 0.0;  ///< step
};

/// Pattern search along each direction in turn, with steps that shrink.
/// \return the cheapest guess found, at worst \p best itself
Guess searchByPattern(Guess best, std::vector<Direction> directions, SampleCosts& costs) {
  double best_cost = costs.mean(best);
  constexpr int kMostRounds = 12;
  for (int round = 0; round < kMostRounds; ++round) {
    bool shrinking = false;
    for (Direction& direction : directions) {
      bool moved = false;
      for (const double sign : {1.0, -1.0}) {
        Guess trial = best;
        direction.move(trial, sign * direction.step);
        const double cost = isWithinBounds(trial.thresholds) ? costs.mean(trial) : kInfinity;
        if (cost < best_cost) {
          best = trial;
          best_cost = cost;
          moved = true;
          break;
        }
      }
      if (!moved && direction.step > direction.least) {
        direction.step *= 0.5;
      }
      shrinking = shrinking || moved || direction.step > direction.least;
    }
    if (!shrinking) {
      break;
    }
  }
  return best;
}

class Estimator {
 public:
  Estimator(std::vector<TimingSample>& samples, const SampleGrid& grid, const TimingSearch& search)
      : samples_(samples),
        grid_(grid),
        search_(search),
        consistency_(grid.size()),
        costs_(samples, consistency_) {}

  TimingEstimate run();

 private:
  void readLengths();
  bool searchCoarsely();
  void selectPixels();
  void descend(bool with_length);
  void chooseReference();
  void refineShift();
  std::vector<Guess> lengthsByScales() const;
  void checkLength();
  void checkThresholds();
  void step(int done);

  std::vector<TimingSample>& samples_;
  const SampleGrid grid_;
  const TimingSearch& search_;
  PairConsistency consistency_;
  SampleCosts costs_;
  Guess best_;
  bool lengths_known_ = true;
  double length_variation_ = 0.0;
  TimingEstimate result_;
};

constexpr int kStages = 5;

void Estimator::step(int done) {
  if (search_.progress) {
    search_.progress(done, kStages);
  }
}

void Estimator::readLengths() {
  std::vector<double> lengths;
  std::vector<double> gaps;
  for (const TimingSample& sample : samples_) {
    for (const SampledFrame* frame : {&sample.first, &sample.second}) {
      lengths_known_ = lengths_known_ && frame->length_ns > 0;
      lengths.push_back(static_cast<double>(frame->length_ns));
    }
    gaps.push_back(static_cast<double>(sample.second.stamp_ns - sample.first.stamp_ns));
  }
  result_.length_ns = mean(lengths);
  if (lengths_known_) {
    double squares = 0.0;
    for (const double length : lengths) {
      squares += (length - result_.length_ns) * (length - result_.length_ns);
    }
    length_variation_ =
        std::sqrt(squares / static_cast<double>(lengths.size())) / result_.length_ns;
  } else {
    result_.length_ns = kGuessedDuty * mean(gaps);
    best_.model.length_ns = result_.length_ns;
  }
}

/// Over the whole range by correlation; best_ is the shift with the largest one.
bool Estimator::searchCoarsely() {
  const ShiftRange shifts{
      static_cast<double>(search_.centre_ns), static_cast<double>(search_.range_ns),
      std::clamp(kCoarsePart * result_.length_ns, kFinestCoarse_ns, kWidestCoarse_ns)};
  const CoarseMatch match =
      matchOrientations(samples_, grid_, best_.model, best_.thresholds, shifts, consistency_);
  best_.model.shift_ns = match.shift_ns;
  result_.curve = match.curve;
  result_.mapping = match.mapping;
  result_.correlation = match.correlation;
  if (!match.fits()) {
    result_.reason = textOf(
        "frames and events do not fit together at any shift within %.0f ms, in no orientation "
        "(correlation %.2f at best, expected at least %.2f): too little motion, or events are "
        "missing",
        static_cast<double>(search_.range_ns) / kMs, match.correlation,
        CoarseMatch::kLeastCorrelation);
    return false;
  }
  return true;
}

void Estimator::selectPixels() {
  for (TimingSample& sample : samples_) {
    const auto first = modelledExposure(sample.first, best_.model);
    const auto second = modelledExposure(sample.second, best_.model);
    if (first && second) {
      markInformative(sample, {first->start_ns, second->end_ns});
    }
  }
}

/// To the least cost, in shift, thresholds and length.
void Estimator::descend(bool with_length) {
  std::vector<Direction> directions = {
      {[](Guess& g, double s) { g.model.shift_ns += s; },
       std::max(kFinestCoarse_ns / 2, kCoarsePart / 2 * result_.length_ns), 0.1 * kMs},
      {[](Guess& g, double s) { g.thresholds.on *= std::exp(s); }, 0.2, 0.03},
      {[](Guess& g, double s) { g.thresholds.off *= std::exp(s); }, 0.2, 0.03},
  };
  if (with_length) {
    directions.push_back({[](Guess& g, double s) { g.model.length_ns *= std::exp(s); }, 0.4, 0.03});
  }
  best_ = searchByPattern(best_, std::move(directions), costs_);
}

/// What stamps mean and to which frame lengths belong, where lengths vary.
void Estimator::chooseReference() {
  if (!lengths_known_ || length_variation_ < kLeastVariation) {
    return;
  }
  std::vector<Guess> hypotheses;
  const Guess start = best_;
  for (const bool late : {false, true}) {
    for (const double part : {0.0, 0.5, -0.5}) {
      best_ = start;
      best_.model.part = part;
      best_.model.shift_ns = start.model.shift_ns - part * result_.length_ns;
      best_.model.length_of_previous = late;
      constexpr int kSteps = 2;
      const double step_ns = 0.1 * result_.length_ns;
      std::vector<Guess> around;
      for (int i = -kSteps; i <= kSteps; ++i) {
        around.push_back(best_);
        around.back().model.shift_ns += i * step_ns;
      }
      const CostTable costs = costs_.table(around);
      if (costs.size() < 2) {
        continue;
      }
      best_.model.shift_ns += locate(costs).position * step_ns;
      hypotheses.push_back(best_);
    }
  }
  best_ = start;
  const CostTable costs = hypotheses.empty() ? CostTable{} : costs_.table(hypotheses);
  if (costs.size() < 3) {
    return;
  }
  std::vector<int> wins(hypotheses.size());
  std::mt19937 random(1);
  for (int i = 0; i < kBootstraps; ++i) {
    const std::vector<double> sums = columnSums(costs, drawRows(random, costs.size()));
    ++wins[static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin())];
  }
  const auto winner =
      static_cast<std::size_t>(std::max_element(wins.begin(), wins.end()) - wins.begin());
  if (wins[winner] < kBelieved * kBootstraps) {
    return;
  }
  best_ = hypotheses[winner];
  result_.lengths_one_late = best_.model.length_of_previous;
  result_.reference = best_.model.part > 0.0   ? ExposureInstant::kStart
                      : best_.model.part < 0.0 ? ExposureInstant::kEnd
                                               : ExposureInstant::kMid;
}

/// The last step, with its uncertainty.
void Estimator::refineShift() {
  const double step_ns = std::clamp(result_.length_ns / 24.0, 0.25 * kMs, 1.0 * kMs);
  std::vector<Guess> guesses;
  for (int i = -kCurveSteps; i <= kCurveSteps; ++i) {
    guesses.push_back(best_);
    guesses.back().model.shift_ns += i * step_ns;
  }
  const CostTable costs = costs_.table(guesses);
  if (costs.size() < 2) {
    result_.reason = "fewer than two pairs of frames have all events around them";
    return;
  }
  result_.samples = costs.size();
  const LocatedMinimum located = locate(costs);
  best_.model.shift_ns += located.position * step_ns;
  result_.offset_ns = best_.model.shift_ns;
  result_.shift_ns = best_.model.shift_ns + best_.model.part * result_.length_ns;
  result_.shift_sigma_ns = std::hypot(located.sigma * step_ns, kSystematic_ns);
  result_.thresholds = best_.thresholds;
  result_.told = true;
}

/// Guesses on a grid: lengths in rows and, for each of them, thresholds scaled in columns. Longer
/// exposures with smaller thresholds blur edges much the same, so that both vary together.
std::vector<Guess> Estimator::lengthsByScales() const {
  std::vector<Guess> guesses;
  for (int i = -kLengthSteps; i <= kLengthSteps; ++i) {
    for (int k = -kScaleSteps; k <= kScaleSteps; ++k) {
      Guess guess = best_;
      guess.model.length_factor *= std::exp(i * kLengthStep);
      guess.model.length_ns *= std::exp(i * kLengthStep);
      guess.thresholds.on *= std::exp(k * kScaleStep);
      guess.thresholds.off *= std::exp(k * kScaleStep);
      guesses.push_back(guess);
    }
  }
  return guesses;
}

/// The length that fits best, against the one known; or the uncertainty of the one found.
void Estimator::checkLength() {
  const CostTable costs = costs_.table(lengthsByScales());
  if (costs.size() < 2) {
    return;
  }
  const LocatedMinimum located = locate(costs, [](const std::vector<double>& sums) {
    std::vector<double> lengths;
    constexpr std::ptrdiff_t kScales = std::ptrdiff_t{2} * kScaleSteps + 1;
    for (auto row = sums.begin(); row != sums.end(); row += kScales) {
      lengths.push_back(leastValue({row, row + kScales}));
    }
    return minimumPosition(lengths);
  });
  result_.length_factor = std::exp(located.position * kLengthStep);
  result_.length_sigma = std::hypot(located.sigma * kLengthStep, kLengthModelError);
  result_.length_told =
      result_.length_sigma < kLargestLengthSigma && std::abs(located.position) < kLengthSteps;
  if (!lengths_known_) {
    result_.length_ns = best_.model.length_ns * result_.length_factor;
    result_.length_factor = 1.0;
  }
}

/// How well each of the thresholds is known, the length being that of best_.
void Estimator::checkThresholds() {
  for (double ContrastThresholds::*const threshold :
       {&ContrastThresholds::on, &ContrastThresholds::off}) {
    std::vector<Guess> guesses;
    for (int i = -kLengthSteps; i <= kLengthSteps; ++i) {
      guesses.push_back(best_);
      guesses.back().thresholds.*threshold *= std::exp(i * kScaleStep);
    }
    const CostTable costs = costs_.table(guesses);
    const double sigma = costs.size() < 2 ? 1.0 : locate(costs).sigma * kScaleStep;
    result_.threshold_sigmas.*threshold = std::hypot(sigma, kThresholdModelError);
  }
}

TimingEstimate Estimator::run() {
  result_.samples = samples_.size();
  result_.frames_stretched = areStretched(samples_);
  if (samples_.size() < 2) {
    result_.reason = "fewer than two pairs of frames have all events around them";
    return result_;
  }
  best_.thresholds = search_.thresholds;
  readLengths();
  step(0);
  if (!searchCoarsely()) {
    return result_;
  }
  step(1);
  selectPixels();
  descend(!lengths_known_);
  step(2);
  chooseReference();
  step(3);
  refineShift();
  step(4);
  if (result_.told) {
    checkLength();
    checkThresholds();
  }
  step(kStages);
  return result_;
}

}  // namespace

TimingEstimate estimateTiming(std::vector<TimingSample>& samples, const SampleGrid& grid,
                              const TimingSearch& search) {
  return Estimator(samples, grid, search).run();
}

}  // namespace fast_edi
