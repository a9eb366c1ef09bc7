/// \file
/// What OnlineCalibration learns from monochrome frames of a linear response, as its header says
/// it, in double precision. What events tell of each pixel comes from PairEvidence; all rows are
/// used, and streams have no holes.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/LU>

#include "calibration/online_calibration.hpp"

namespace fast_edi::testing {

class SlowCalibration {
 public:
  SlowCalibration(SensorSize size, const Calibration& given,
                  const OnlineCalibration::Settings& settings)
      : size_(size), given_(given), settings_(settings), in_force_(given), evidence_(size) {}

  void addFrame(const OnlineCalibration::Frame& frame, const PixelEventLists& lists) {
    std::vector<double> log_latent = logLatent(frame);
    const Calibration before = in_force_;
    if (has_previous_) {
      evidence_.gather(lists,
                       {previous_.window, frame.window, previous_.reference_ns, frame.reference_ns},
                       in_force_.thresholds, settings_.level, {});
      addPair(log_latent);
    }
    previous_ = {frame.window, frame.reference_ns, log_latent};
    // Its gains are those of the parameters before.
    has_previous_ = in_force_.thresholds == before.thresholds &&
                    in_force_.event_delay_ns == before.event_delay_ns;
  }

  const Calibration& inForce() const { return in_force_; }
  int fits() const { return fits_; }

 private:
  struct Previous {
    ExposureInterval window;
    std::int64_t reference_ns = 0;
    std::vector<double> log_latent;
  };
  struct Sums {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    double squares = 0.0;

    double remaining(const Eigen::Vector3d& theta) const {
      return squares - 2.0 * theta.dot(vector) + theta.dot(matrix * theta);
    }
  };
  static constexpr double kMs = 1e6;

  std::vector<double> logLatent(const OnlineCalibration::Frame& frame) const {
    std::vector<double> levels;
    for (int y = 0; y < size_.height; ++y) {
      for (int x = 0; x < size_.width; ++x) {
        const double dn = frame.image.row(y)[x];
        const double gain = static_cast<double>(frame.gain[levels.size()]);
        levels.push_back(dn < 16.0 || dn > 239.0 ? std::numeric_limits<double>::quiet_NaN()
                                                 : std::log(dn * gain));
      }
    }
    return levels;
  }

  void addPair(const std::vector<double>& log_latent) {
    const double scale = fits_ < 3 ? 0.5 : 0.2;
    const Eigen::Vector3d theta(in_force_.thresholds.on, in_force_.thresholds.off,
                                static_cast<double>(in_force_.event_delay_ns) / kMs);
    Sums pair;
    int pixels = 0;
    double frames = 0.0;
    double events = 0.0;
    double both = 0.0;
    for (std::size_t i = 0; i < log_latent.size(); ++i) {
      const PairEvidence::Pixel& pixel = evidence_.row(0)[i];
      const auto on = static_cast<double>(pixel.weight[1]);
      const auto off = static_cast<double>(pixel.weight[0]);
      const auto count = static_cast<double>(pixel.count);
      const auto by_events = static_cast<double>(pixel.level);
      const double by_frames = log_latent[i] - previous_.log_latent[i];
      const double change = std::abs(on - off);
      if (change < 3.0 || count > 1.3 * change + 2.0 || std::isnan(by_frames)) continue;
      const double intensity = std::exp(log_latent[i] + previous_.log_latent[i]) / (100.0 * 100.0);
      frames += intensity * by_frames * by_frames;
      events += intensity * by_events * by_events;
      both += intensity * by_frames * by_events;
      const double r = by_frames - by_events;
      const double weight = intensity / ((1.0 + std::pow(r / scale, 2)) * (1.0 + 0.1 * count));
      const Eigen::Vector3d x(on, -off, static_cast<double>(pixel.slope));
      const double y = r + x.dot(theta);
      pair.matrix += weight * x * x.transpose();
      pair.vector += weight * y * x;
      pair.squares += weight * y * y;
      ++pixels;
    }
    if (pixels < 50 || !(both >= 0.8 * std::sqrt(frames * events))) return;
    const double share = learned_.matrix(2, 2) / pair.matrix(2, 2);
    const bool outdated =
        fits_ > 0 && settings_.delay && pair.matrix(2, 2) >= 0.1 && isOutdatedBy(pair, 0.1 * share);
    const double forgetting = outdated ? 0.0 : 0.9;
    learned_.matrix = forgetting * learned_.matrix + pair.matrix;
    learned_.vector = forgetting * learned_.vector + pair.vector;
    learned_.squares = forgetting * learned_.squares + pair.squares;
    ++fits_;
    update();
  }

  /// \param tie how much the pair's own delay is held at that of before, in units of its weight
  bool isOutdatedBy(const Sums& pair, double tie) const {
    const ContrastThresholds& now = in_force_.thresholds;
    const double before = bestOf(learned_, now);
    const double own = (bestOf(pair, now) + tie * before) / (1.0 + tie);
    return std::abs(own - before) > 2.0 && std::sqrt(pair.remaining({now.on, now.off, before}) /
                                                     pair.remaining({now.on, now.off, own})) > 1.12;
  }
  static double bestOf(const Sums& sums, const ContrastThresholds& thresholds) {
    return (sums.vector[2] - sums.matrix(2, 0) * thresholds.on -
            sums.matrix(2, 1) * thresholds.off) /
           sums.matrix(2, 2);
  }

  void update() {
    const double fixed = 1e12;
    const Eigen::Vector3d ridge(settings_.contrast ? 100.0 : fixed,
                                settings_.contrast ? 100.0 : fixed, settings_.delay ? 0.1 : fixed);
    const Eigen::Vector3d given(given_.thresholds.on, given_.thresholds.off, givenDelay());
    Eigen::Matrix3d matrix = learned_.matrix;
    matrix.diagonal() += ridge;
    const Eigen::Vector3d theta =
        matrix.fullPivLu().solve(learned_.vector + ridge.cwiseProduct(given));
    Calibration wanted = given_;
    if (settings_.contrast) {
      const Eigen::Vector3d unchanged(given[0], given[1], bestDelay(given_.thresholds));
      const double improvement =
          std::sqrt(learned_.remaining(unchanged) / learned_.remaining(theta));
      const double believed = rise(improvement, 1.08, 1.16);
      wanted.thresholds = {corrected(theta[0], given[0], believed),
                           corrected(theta[1], given[1], believed)};
    }
    if (settings_.delay) {
      const double delay_ms = bestDelay(wanted.thresholds);
      const double shift_ms = delay_ms > 0.0 ? std::max(0.0, delay_ms - 0.4) : delay_ms;
      wanted.event_delay_ns = static_cast<std::int64_t>(std::clamp(shift_ms, -15.0, 15.0) * kMs);
    }
    const auto differs = [](double a, double b) { return std::abs(a / b - 1.0) > 0.01; };
    if (differs(wanted.thresholds.on, in_force_.thresholds.on) ||
        differs(wanted.thresholds.off, in_force_.thresholds.off) ||
        std::abs(wanted.event_delay_ns - in_force_.event_delay_ns) > 50'000) {
      in_force_ = wanted;
    }
  }

  static double rise(double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
  }
  static double corrected(double found, double given, double believed) {
    const double correction = std::clamp(found / given - 1.0, -0.3, 0.3);
    return given * (1.0 + believed * rise(std::abs(correction), 0.06, 0.1) * correction);
  }
  /// Mean delay [ms].
  double givenDelay() const {
    const double shift_ms = static_cast<double>(given_.event_delay_ns) / kMs;
    return shift_ms > 0.0 ? shift_ms + 0.4 : shift_ms;
  }
  /// With the thresholds held.
  double bestDelay(const ContrastThresholds& thresholds) const {
    if (!settings_.delay) return givenDelay();
    return (learned_.vector[2] - learned_.matrix(2, 0) * thresholds.on -
            learned_.matrix(2, 1) * thresholds.off + 0.1 * givenDelay()) /
           (learned_.matrix(2, 2) + 0.1);
  }

  SensorSize size_;
  Calibration given_;
  OnlineCalibration::Settings settings_;
  Calibration in_force_;
  PairEvidence evidence_;
  bool has_previous_ = false;
  Previous previous_;
  Sums learned_;
  int fits_ = 0;
};

}  // namespace fast_edi::testing
