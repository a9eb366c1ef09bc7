#include "calibration/online_calibration.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <Eigen/Cholesky>

#include "base/fast_log.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {
namespace {

/// Grey levels outside are too dark or too near saturation to say anything [8-bit DN].
constexpr int kLowestEvidence_dn = 16;
constexpr int kHighestEvidence_dn = 239;
constexpr std::size_t kLevels = 256;

/// Changes below this many events drown in the quantisation of events.
constexpr float kLeastChange = 3.0F;
/// More events than this for each event of change: texture that came and went, or noise.
constexpr float kMostEventsPerChange = 1.3F;
constexpr float kSpareEvents = 2.0F;
/// Residuals above this count less and less (scale of the Cauchy weights) [natural log]: wide while
/// thresholds and delay may be far off, then about what noise and mismatch of a pixel make.
constexpr double kFirstResidualScale = 0.5;
constexpr double kResidualScale = 0.2;
constexpr int kFirstFits = 3;
/// Pixels count as the square of their intensity relative to this one [8-bit DN].
constexpr double kTypicalGrey_dn = 100.0;
/// Each event adds this much to the variance of a pixel's residual, relative to that of the frames.
constexpr double kVariancePerEvent = 0.1;
constexpr std::size_t kLeastPixels = 50;
/// Cosine between the changes that frames and events tell. Simulated and real recordings have 0.93
/// and more, with thresholds given a fifth wrong, too; wrong polarities about 0.
constexpr double kLeastAgreement = 0.8;

/// Weight of the given values, as if that many pixels had told them by one event each ...
constexpr double kContrastRidge = 100.0;
/// ... or, for the delay, by one natural-log unit per millisecond each.
constexpr double kDelayRidge = 0.1;
/// Fixes what is not to be learned at its given value.
constexpr double kFixedRidge = 1e12;
/// Weight of what was learned before, each time a pair is added.
constexpr double kForgetting = 0.9;
constexpr double kLargestCorrection = 0.3;  ///< of a threshold, relative to the given one
/// Either way.
constexpr double kLargestDelay_ns =
    limits::kEventDelay.range.highest * static_cast<double>(kNanosecondsPerMicrosecond);
/// Pairs of frames determine a threshold no better than to a few per cent. Of a correction, nothing
/// is used up to kDoubtfulCorrection, all of it from kSureCorrection on, relative to the given one.
constexpr double kDoubtfulCorrection = 0.06;
constexpr double kSureCorrection = 0.1;
/// The same for the root mean square of residuals that the given thresholds leave, relative to that
/// which the fit leaves. On the choosing set: 1.25 where the given thresholds are 15 % off, 1.28
/// where a refractory time makes larger ones fit; 1.06 and 1.08 where strong mismatch or noise told
/// wrong ones.
constexpr double kDoubtfulImprovement = 1.08;
constexpr double kSureImprovement = 1.16;
/// Events tell of a change after it has reached a step, which the ramps of LevelModel make good in
/// part. By so much the fit finds events late where pixels are not; chosen on the simulated
/// recordings of method.md and on the choosing set. Events ahead of the light come from clocks that
/// differ, and such a shift is taken whole.
constexpr double kStepLag_ms = 0.4;

/// What was learned is forgotten where a pair tells a delay that is so far from it ...
constexpr double kOutdatedDelay_ms = 2.0;
/// ... and leaves residuals (root mean square) that are so much smaller. Where delays do not
/// change, pairs of the choosing set and of the recordings of method.md had at most 1.07, but for
/// two of hardly any evidence (1.32 at 1.9 ms, 1.17 at 0.9 ms). Where a delay of 5 ms ended: 1.17
/// and 1.25, at 3 and 4 ms.
constexpr double kOutdatedResiduals = 1.12;

/// Smaller changes are ignored, so that most pairs of frames are integrated with equal values.
constexpr double kNoticeableCorrection = 0.01;  ///< of a threshold, relative
constexpr std::int64_t kNoticeableDelay_ns = 50 * kNanosecondsPerMicrosecond;

/// Events between two exposures, relative to the rate within them: less than this is a hole.
constexpr double kLeastRateBetween = 0.1;
/// A shorter time between exposures says nothing about holes.
constexpr std::int64_t kShortestPause_ns = kNanosecondsPerMillisecond;

std::uint64_t eventsIn(const PixelEventLists& lists, const ExposureInterval& interval) {
  return lists.lowerBound(interval.end_ns) - lists.lowerBound(interval.start_ns);
}

/// True when the time between two exposures holds (almost) no events although they do.
bool isHole(const PixelEventLists& lists, const ExposureInterval& first,
            const ExposureInterval& second) {
  const ExposureInterval between{first.end_ns, second.start_ns};
  if (between.length() < kShortestPause_ns) {
    return false;
  }
  const auto inside = static_cast<double>(eventsIn(lists, first) + eventsIn(lists, second));
  const double rate = inside / static_cast<double>(first.length() + second.length());
  return static_cast<double>(eventsIn(lists, between)) <
         kLeastRateBetween * rate * static_cast<double>(between.length());
}

double limited(double value, double lowest, double highest) {
  return std::min(std::max(value, lowest), highest);
}

/// What the fit finds where events are to be shifted by \p delay_ns [ms].
double meanDelay(std::int64_t delay_ns) {
  const double delay_ms =
      static_cast<double>(delay_ns) / static_cast<double>(kNanosecondsPerMillisecond);
  return delay_ms > 0.0 ? delay_ms + kStepLag_ms : delay_ms;
}

/// The other way round, within the limits.
std::int64_t pixelDelay(double mean_ms) {
  const double delay_ms = mean_ms > 0.0 ? std::max(0.0, mean_ms - kStepLag_ms) : mean_ms;
  return static_cast<std::int64_t>(
      limited(delay_ms * static_cast<double>(kNanosecondsPerMillisecond), -kLargestDelay_ns,
              kLargestDelay_ns));
}

/// How much to believe what lies between doubtful (0) and sure (1).
double belief(double value, double doubtful, double sure) {
  return limited((value - doubtful) / (sure - doubtful), 0.0, 1.0);
}

/// The threshold in force for one that was found, and believed as far.
double correctedThreshold(double found, double given, double believed) {
  const double correction = limited(found / given - 1.0, -kLargestCorrection, kLargestCorrection);
  return given *
         (1.0 + believed * belief(std::abs(correction), kDoubtfulCorrection, kSureCorrection) *
                    correction);
}

}  // namespace

OnlineCalibration::OnlineCalibration(SensorSize size, const Calibration& given, Settings settings)
    : size_(size),
      given_(given),
      settings_(settings),
      in_force_(given),
      log_latent_(size.pixelCount()),
      evidence_(size) {
  previous_.log_latent.resize(size.pixelCount());
}

std::size_t OnlineCalibration::memoryBytes() const {
  return (log_latent_.capacity() + previous_.log_latent.capacity()) * sizeof(float) +
         evidence_.memoryBytes();
}

std::int64_t OnlineCalibration::neededFrom() const {
  return previous_.usable ? previous_.window.start_ns : std::numeric_limits<std::int64_t>::max();
}

CalibrationOutcome OnlineCalibration::addFrame(const Frame& frame, const CameraResponse& response,
                                               const PixelEventLists& lists) {
  loadLogLatent(frame, response);
  resting_ = 0;
  const Calibration before = in_force_;
  CalibrationOutcome outcome = CalibrationOutcome::kNoPair;
  if (previous_.usable && frame.window.start_ns >= previous_.window.end_ns) {
    outcome = isHole(lists, previous_.window, frame.window) ? CalibrationOutcome::kNoEventsBetween
                                                            : learnFromPair(frame, lists);
  }
  previous_.log_latent.swap(log_latent_);
  previous_.window = frame.window;
  previous_.reference_ns = frame.reference_ns;
  if (outcome == CalibrationOutcome::kFitted) {
    useless_pairs_ = 0;
    resting_ = std::max(resting_, fits_ >= settings_.initial_fits ? kRestFrames : 0);
  } else if (outcome != CalibrationOutcome::kNoPair && ++useless_pairs_ >= kMaxUselessPairs) {
    resting_ = std::max(resting_, kRestFrames);
  }
  // No pair: the next frame is not needed, or will be closed otherwise than this one.
  previous_.usable = resting_ == 0 && in_force_.thresholds == before.thresholds &&
                     in_force_.event_delay_ns == before.event_delay_ns;
  return outcome;
}

CalibrationOutcome OnlineCalibration::learnFromPair(const Frame& frame,
                                                    const PixelEventLists& lists) {
  const ExposurePair exposures{previous_.window, frame.window, previous_.reference_ns,
                               frame.reference_ns};
  const RowSample rows = nextRows(lists.lowerBound(exposures.second.end_ns) -
                                  lists.lowerBound(exposures.first.start_ns));
  evidence_.gather(lists, exposures, in_force_.thresholds, settings_.level, rows);
  NormalEquations pair;
  Agreement agreement;
  if (fit(rows, pair, agreement) < kLeastPixels) {
    return CalibrationOutcome::kTooFewPixels;
  }
  if (!(agreement.cosine() >= kLeastAgreement)) {
    return CalibrationOutcome::kContradiction;
  }
  learned_ = isOutdatedBy(pair) ? pair : learned_.times(kForgetting).plus(pair);
  updateInForce();
  ++fits_;
  return CalibrationOutcome::kFitted;
}

void OnlineCalibration::skipFrame() {
  previous_.usable = false;
  resting_ = std::max(0, resting_ - 1);
}

void OnlineCalibration::loadLogLatent(const Frame& frame, const CameraResponse& response) {
  std::array<float, kLevels> log_exposure{};
  log_exposure.fill(std::numeric_limits<float>::quiet_NaN());
  for (int dn = kLowestEvidence_dn; dn <= kHighestEvidence_dn; ++dn) {
    log_exposure[static_cast<std::size_t>(dn)] =
        static_cast<float>(std::log(response.exposure(static_cast<double>(dn))));
  }
  log_typical_ = std::log(response.exposure(kTypicalGrey_dn));
  const int bytes = bytesPerPixel(frame.image.format);
  std::size_t i = 0;
  for (int y = 0; y < size_.height; ++y) {
    const std::uint8_t* pixel = frame.image.row(y);
    for (int x = 0; x < size_.width; ++x, ++i, pixel += bytes) {
      log_latent_[i] = log_exposure[level8(pixel, frame.image.format)] + fastLog(frame.gain[i]);
    }
  }
}

/// All rows, or every n-th of them, so that about as many events are used as the settings say. All
/// are passed by all the same: what that costs is spread over the frames that follow.
RowSample OnlineCalibration::nextRows(std::uint64_t events) {
  if (events > settings_.most_events) {
    resting_ = static_cast<int>(events / settings_.most_events);
  }
  const std::uint64_t most = fits_ < settings_.initial_fits
                                 ? settings_.most_events
                                 : std::min(settings_.most_events, settings_.settled_events);
  const std::uint64_t every = std::max<std::uint64_t>(1, (events + most / 2) / most);
  const int step = static_cast<int>(std::min(every, static_cast<std::uint64_t>(size_.height)));
  return {next_row_++ % step, step};
}

double OnlineCalibration::Agreement::cosine() const {
  return both_ / std::sqrt(frames_ * events_);
}

/// Adds up the equations of a pair; returns how many pixels told something.
std::size_t OnlineCalibration::fit(const RowSample& rows, NormalEquations& equations,
                                   Agreement& agreement) const {
  std::size_t pixels = 0;
  for (int y = rows.first; y < size_.height; y += rows.step) {
    pixels += fitRow(y, equations, agreement);
  }
  return pixels;
}

std::size_t OnlineCalibration::fitRow(int y, NormalEquations& equations,
                                      Agreement& agreement) const {
  const Eigen::Vector3d theta(in_force_.thresholds.on, in_force_.thresholds.off,
                              static_cast<double>(in_force_.event_delay_ns) /
                                  static_cast<double>(kNanosecondsPerMillisecond));
  const double scale = fits_ < kFirstFits ? kFirstResidualScale : kResidualScale;
  const auto width = static_cast<std::size_t>(size_.width);
  const float* after = log_latent_.data() + static_cast<std::size_t>(y) * width;
  const float* before = previous_.log_latent.data() + static_cast<std::size_t>(y) * width;
  const PairEvidence::Pixel* row = evidence_.row(y);
  std::size_t pixels = 0;
  for (std::size_t x = 0; x < width; ++x) {
    const PairEvidence::Pixel& pixel = row[x];
    const float change = std::fabs(pixel.weight[1] - pixel.weight[0]);
    if (change < kLeastChange || pixel.count > kMostEventsPerChange * change + kSpareEvents) {
      continue;
    }
    const auto residual = static_cast<double>(after[x] - before[x] - pixel.level);
    if (std::isnan(residual)) {
      continue;  // one of both grey levels is no evidence
    }
    const auto by_events = static_cast<double>(pixel.level);
    const double scaled = residual / scale;
    // An error of log intensity is seen in proportion to the intensity.
    const double intensity =
        std::exp(static_cast<double>(after[x] + before[x]) - 2.0 * log_typical_);
    const double weight =
        intensity /
        ((1.0 + scaled * scaled) * (1.0 + kVariancePerEvent * static_cast<double>(pixel.count)));
    const Eigen::Vector3d terms(static_cast<double>(pixel.weight[1]),
                                -static_cast<double>(pixel.weight[0]),
                                static_cast<double>(pixel.slope));
    agreement.add(by_events + residual, by_events, intensity);
    equations.matrix += weight * terms * terms.transpose();
    const double whole = residual + terms.dot(theta);
    equations.vector += weight * whole * terms;
    equations.squares += weight * whole * whole;
    ++pixels;
  }
  return pixels;
}

/// The mean delay [ms] that goes with these thresholds, whether or not they are those of the fit.
double OnlineCalibration::learnedDelay(const ContrastThresholds& thresholds) const {
  const double given_ms = meanDelay(given_.event_delay_ns);
  return settings_.delay ? learned_.delay(thresholds, {given_ms, kDelayRidge}) : given_ms;
}

/// Whether a pair tells another delay than those before it, which do not explain it: a driver was
/// started anew, or events no longer wait in a queue.
bool OnlineCalibration::isOutdatedBy(const NormalEquations& pair) const {
  // A pair that tells no more than the given delay does, refutes nothing.
  if (!settings_.delay || pair.matrix(2, 2) < kDelayRidge) {
    return false;
  }
  const ContrastThresholds& thresholds = in_force_.thresholds;
  const double before_ms = learned_.delay(thresholds, {});  // NaN before the first pair
  // A pair that tells less than others do stays near to them.
  const double own_ms =
      pair.delay(thresholds, {before_ms, (1.0 - kForgetting) * learned_.matrix(2, 2)});
  const double left = pair.remaining({thresholds.on, thresholds.off, before_ms});
  const double left_by_own = pair.remaining({thresholds.on, thresholds.off, own_ms});
  return std::abs(own_ms - before_ms) > kOutdatedDelay_ms &&
         left > kOutdatedResiduals * kOutdatedResiduals * left_by_own;
}

/// Solves what was learned so far for the calibration.
void OnlineCalibration::updateInForce() {
  const double contrast_ridge = settings_.contrast ? kContrastRidge : kFixedRidge;
  const double delay_ridge = settings_.delay ? kDelayRidge : kFixedRidge;
  const Eigen::Vector3d ridge(contrast_ridge, contrast_ridge, delay_ridge);
  const double given_delay_ms = meanDelay(given_.event_delay_ns);
  const Eigen::Vector3d given(given_.thresholds.on, given_.thresholds.off, given_delay_ms);
  const Eigen::Matrix3d matrix = learned_.matrix + Eigen::Matrix3d(ridge.asDiagonal());
  const Eigen::Vector3d theta =
      matrix.ldlt().solve(learned_.vector + Eigen::Vector3d(ridge.cwiseProduct(given)));
  if (!theta.allFinite()) {
    return;
  }

  Calibration wanted = given_;
  if (settings_.contrast) {
    const Eigen::Vector3d unchanged(given[0], given[1], learnedDelay(given_.thresholds));
    const double improvement =
        std::sqrt(learned_.remaining(unchanged) /
                  std::max(learned_.remaining(theta), std::numeric_limits<double>::min()));
    const double believed = belief(improvement, kDoubtfulImprovement, kSureImprovement);
    wanted.thresholds = {correctedThreshold(theta[0], given[0], believed),
                         correctedThreshold(theta[1], given[1], believed)};
  }
  if (settings_.delay) {
    wanted.event_delay_ns = pixelDelay(learnedDelay(wanted.thresholds));
  }
  const auto differs = [](double a, double b) {
    return std::abs(a - b) > kNoticeableCorrection * b;
  };
  if (differs(wanted.thresholds.on, in_force_.thresholds.on) ||
      differs(wanted.thresholds.off, in_force_.thresholds.off) ||
      std::abs(wanted.event_delay_ns - in_force_.event_delay_ns) > kNoticeableDelay_ns) {
    in_force_ = wanted;
  }
}

}  // namespace fast_edi
