/// \file
/// The contrast threshold found by how sharp the latent image is (Pan et al., CVPR 2019, section
/// 4): the slow alternative to reading it off the biases.
///
///     c = argmin  lambda TV(L(c)) / TV(B) - rho(|grad L(c)|, |M|)
///
/// L: latent image, B: blurry frame, TV: total variation (sum of |grad| by forward differences),
/// |grad L|: Sobel gradient, M: event map, each pixel's events weighted by exp(-|t - f| / decay)
/// around the reference time f, rho: correlation coefficient over all pixels.
///
/// The paper correlates binary Sobel maps of L and M and states neither how they are made binary
/// nor the scale of the terms. Read literally, the minimum on noisy simulated frames lay at the
/// lower end of the range (edge pixels are lost to noise as c grows). Events lie on the moving
/// edges themselves, so |M| is an edge map already; with it and dimensionless terms the search ends
/// near the contrast of best PSNR. lambda = 0.2 is the paper's.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// Minimum of a unimodal function over [low, high] by Fibonacci search.
struct Minimum {
  double position = 0.0;
  double value = 0.0;
  int evaluations = 0;
};

/// \param intervals the position is found to (high - low) / intervals
/// \throws std::invalid_argument unless low < high and intervals >= 2
Minimum fibonacciSearch(const std::function<double(double)>& function, double low, double high,
                        int intervals);

struct ContrastSearchOptions {
  double low = 0.05;    ///< range of thresholds [natural log]
  double high = 0.7;    ///< [natural log]
  int intervals = 200;  ///< resolution: (high - low) / intervals
  double lambda = 0.2;  ///< weight of the total variation
};

/// |M| of the energy above. Polarities count +1 and -1, as in the paper.
/// \param events all on the sensor
/// \param decay_ns > 0; the paper gives no value: a tenth of the exposure resolves the motion
/// \throws std::invalid_argument for a decay of 0 or less
cv::Mat1f eventEdgeMap(const std::vector<Event>& events, SensorSize size, std::int64_t reference_ns,
                       std::int64_t decay_ns);

/// TV of the energy above [DN px]. \param image CV_8UC1 or CV_32FC1
double totalVariation(const cv::Mat& image);

/// The energy of latent images of one frame. A constant blurry frame or event map makes its term 0.
class SharpnessEnergy {
 public:
  /// \param blurry CV_8UC1 or CV_32FC1
  /// \param event_edges see eventEdgeMap()
  /// \throws std::invalid_argument when they differ in size
  SharpnessEnergy(const cv::Mat& blurry, const cv::Mat1f& event_edges, double lambda);

  /// \param latent of the same size and scale as the blurry frame
  double operator()(const cv::Mat& latent) const;

 private:
  double blurry_variation_;
  cv::Mat1f event_edges_;
  double lambda_;
};

struct ContrastSearchResult {
  double contrast = 0.0;  ///< [natural log]
  double energy = 0.0;
  int evaluations = 0;  ///< latent images computed
};

/// \param deblur latent image for a contrast threshold, of the size and scale that \p energy
/// expects
ContrastSearchResult searchContrast(const std::function<cv::Mat(double)>& deblur,
                                    const SharpnessEnergy& energy,
                                    const ContrastSearchOptions& options = {});

}  // namespace fast_edi
