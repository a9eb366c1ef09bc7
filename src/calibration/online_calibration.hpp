/// \file
/// Learns from the recording what bias settings and stamps do not determine: the contrast
/// thresholds (biases give them to some 10 %) and the delay of the events relative to the frames
/// (the photoreceptor's bandwidth: 0.5 ms in bright and 5 ms in dim light).
///
/// The change between two consecutive frames is measured twice: by the frames and by the events.
/// With B the blurry frames, E their double integrals and l the change of level by the events
/// between the two reference times,
///
///     r = log(B2 / E2) - log(B1 / E1) - l
///
/// is zero if the model is right. If not, to first order,
///
///     r = dc_on x_on - dc_off x_off + dt x_t,
///     x_p = sum over events of polarity p of w(t),   x_t = n_2 / T_2 - n_1 / T_1,
///
/// w rising from 0 to 1 during the first exposure, 1 between them, and falling back to 0 during the
/// second: what the mean levels of the exposures differ by, counted in events; n_i the change of
/// level by the events during exposure i of length T_i. An event with a ramp (see level_model.hpp)
/// counts there at the mean time of its step, h r / 2 before it. Both B and x are means over
/// exposures, so neither blur nor the quantisation at one instant biases the fit, as it would for a
/// fit of log L2 - log L1 to counts of events.
///
/// Fit: least squares over informative pixels (|x_on - x_off| >= 3, hardly any events back
/// and forth, no grey level near black or saturation), weighted by the square of the intensity
/// (events of dark pixels come later than those of bright ones, in which errors are seen), robust
/// (Cauchy weights), with a ridge towards the given values, exponential forgetting, and limits:
/// thresholds within 30 % of the given ones, the delay within 15 ms (pixels of 30 Hz lag by 5 ms,
/// in the dark by more).
///
/// Thresholds are changed only if they differ from the given ones by more than the error of such a
/// fit (6 to 10 %), and if that makes the residuals smaller by a tenth or so than the given ones
/// with their best delay leave them: where pixels differ much in their thresholds, or events are
/// noise, the fit prefers other values than the true ones by less. Of the delay 0.4 ms are taken
/// away: by so much events lag for telling steps, on pixels that do not lag. An offset between the
/// clocks is no delay of pixels: it belongs into `time_offset`.
///
/// Each pair is used until Settings::initial_fits were informative, then one in kRestFrames frames;
/// also after kMaxUselessPairs consecutive pairs that were not. Of a pair of more than
/// Settings::most_events, every n-th row is used, one row further for the next pair, which comes
/// later by a frame for each most_events. After the first fits every n-th row does from
/// Settings::settled_events on: many pairs are in the sums by then. Before, a part of the rows
/// gives thresholds and delays that cost up to 1 dB in single frames.
///
/// A delay may begin or end: a driver is started anew, events no longer wait in a queue. A pair
/// that tells a delay 2 ms from that of the pairs before it, which leaves clearly larger residuals,
/// makes these forgotten at once.
///
/// A pair whose frames do not change as its events say (cosine below 0.8 over the informative
/// pixels) teaches nothing: its events are wrong, not the parameters.
///
/// Recordings without events between exposures exist (a driver dropped them); there the fit would
/// be wrong and is not made.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "calibration/pair_evidence.hpp"
#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/image.hpp"
#include "fast_edi/base/level_model.hpp"
#include "fast_edi/base/types.hpp"
#include "fast_edi/events/pixel_event_lists.hpp"
#include "fast_edi/latent/camera_response.hpp"

namespace fast_edi {

/// What is learned.
struct Calibration {
  ContrastThresholds thresholds;
  /// By this much the events of an edge come after its light, in the mean. [ns]
  std::int64_t event_delay_ns = 0;
};

/// What became of a frame.
enum class CalibrationOutcome {
  kNoPair,           ///< nothing to compare with
  kNoEventsBetween,  ///< the stream holds no events between the exposures
  kTooFewPixels,     ///< nothing moved enough
  kContradiction,    ///< frames and events do not tell of the same change
  kFitted,
};

class OnlineCalibration {
 public:
  static constexpr int kRestFrames = 10;
  static constexpr int kMaxUselessPairs = 5;

  struct Settings {
    bool contrast = true;                    ///< learn the thresholds
    bool delay = true;                       ///< learn the delay
    std::uint64_t most_events = 2'000'000;   ///< of a pair
    std::uint64_t settled_events = 250'000;  ///< same, after the first fits
    int initial_fits = 20;                   ///< from consecutive pairs
    LevelModel level = {};                   ///< that the gains are made with
  };

  /// A deblurred frame. Times are event times: shifted by time offset and delay already.
  struct Frame {
    ExposureInterval window;
    std::int64_t reference_ns = 0;
    ImageView image;              ///< the blurry one
    const float* gain = nullptr;  ///< of DoubleIntegral::integrate(), not filtered
  };

  /// \param given in force until something else was learned; thresholds stay near these
  OnlineCalibration(SensorSize size, const Calibration& given, Settings settings);

  /// True when the next frame is needed. Each pair is used at first; once enough has been learned,
  /// one of several, which follows slow changes at a fraction of the cost.
  bool wantsNextFrame() const { return resting_ == 0; }
  /// Instead of addFrame() for a frame that is not needed.
  void skipFrame();
  /// Compares a frame with the previous one, and updates what is in force if the result differs
  /// noticeably from it.
  /// \pre \p lists hold all events from neededFrom() to the end of the frame's window
  CalibrationOutcome addFrame(const Frame& frame, const CameraResponse& response,
                              const PixelEventLists& lists);
  /// Discards the previous frame (after a gap), but not what was learned.
  void interrupt() { previous_.usable = false; }

  /// Start of the earliest event that the next addFrame() needs; INT64_MAX while it needs none.
  std::int64_t neededFrom() const;
  /// To be used for the next frame.
  const Calibration& inForce() const { return in_force_; }
  /// Pairs of frames that it was learned from.
  int fits() const { return fits_; }
  std::size_t memoryBytes() const;

 private:
  /// Weighted X'X, X'y and y'y with y = r + X theta, theta = (c_on, c_off, delay in ms).
  struct NormalEquations {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d vector = Eigen::Vector3d::Zero();
    double squares = 0.0;

    struct Tie {
      double delay_ms = 0.0;
      double weight = 0.0;
    };
    /// The mean delay [ms] that these thresholds leave least residuals with; NaN if nothing tells.
    double delay(const ContrastThresholds& thresholds, const Tie& tie) const {
      return (vector[2] - matrix(2, 0) * thresholds.on - matrix(2, 1) * thresholds.off +
              tie.weight * tie.delay_ms) /
             (matrix(2, 2) + tie.weight);
    }
    NormalEquations times(double weight) const {
      return {weight * matrix, weight * vector, weight * squares};
    }
    NormalEquations plus(const NormalEquations& other) const {
      return {matrix + other.matrix, vector + other.vector, squares + other.squares};
    }
    /// Weighted sum of squares of the residuals that \p theta leaves.
    double remaining(const Eigen::Vector3d& theta) const {
      return squares - 2.0 * theta.dot(vector) + theta.dot(matrix * theta);
    }
  };
  /// Of a pair's changes, as the frames and as the events tell them.
  class Agreement {
   public:
    void add(double by_frames, double by_events, double weight) {
      frames_ += weight * by_frames * by_frames;
      events_ += weight * by_events * by_events;
      both_ += weight * by_frames * by_events;
    }
    /// Cosine between both, -1 to 1; NaN where nothing has changed.
    double cosine() const;

   private:
    double frames_ = 0.0;
    double events_ = 0.0;
    double both_ = 0.0;
  };

  /// The frame before, as the next one is compared with it.
  struct Previous {
    bool usable = false;
    ExposureInterval window;
    std::int64_t reference_ns = 0;
    std::vector<float> log_latent;  ///< as log_latent_
  };
  void loadLogLatent(const Frame& frame, const CameraResponse& response);
  CalibrationOutcome learnFromPair(const Frame& frame, const PixelEventLists& lists);
  RowSample nextRows(std::uint64_t events);
  std::size_t fit(const RowSample& rows, NormalEquations& equations, Agreement& agreement) const;
  std::size_t fitRow(int y, NormalEquations& equations, Agreement& agreement) const;
  double learnedDelay(const ContrastThresholds& thresholds) const;
  bool isOutdatedBy(const NormalEquations& pair) const;
  void updateInForce();

  SensorSize size_;
  Calibration given_;
  Settings settings_;
  Calibration in_force_;
  NormalEquations learned_;
  int fits_ = 0;
  int useless_pairs_ = 0;  ///< since the last fit
  int resting_ = 0;        ///< frames until the next one is needed
  int next_row_ = 0;       ///< first one of the next pair

  Previous previous_;
  double log_typical_ = 0.0;       ///< log exposure of a typical grey
  std::vector<float> log_latent_;  ///< log B + log gain; NaN where B is no evidence
  PairEvidence evidence_;
};

}  // namespace fast_edi
