/// \file
/// The contrast threshold found by how sharp the latent image is (Pan et al., CVPR 2019, section
/// 4): the slow alternative to reading it off the biases.
///
///     c = argmin  lambda TV(L(c)) - sum_xy S(L(c)) S(M)
///
/// L: latent image, 0..1. TV: total variation, the sum of |grad L| by forward differences.
/// S: binary Sobel edge map, 1 where the gradient exceeds twice its root mean square over the
/// image. M: event map, each pixel's events weighted by exp(-|t - f| / decay) around the reference
/// time f.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <opencv2/core.hpp>

#include "fast_edi/core/types.hpp"

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

/// M of the energy above. Polarities count +1 and -1, as in the paper.
/// \param decay_ns > 0; the paper gives no value: a tenth of the exposure resolves the motion
cv::Mat1f eventEdgeMap(const std::vector<Event>& events, SensorSize size, std::int64_t reference_ns,
                       std::int64_t decay_ns);

/// S of the energy above: CV_8UC1, 0 or 1. \param image one channel, any depth
cv::Mat1b binaryEdges(const cv::Mat& image);

/// The energy of a latent image. \param latent CV_8UC1, or CV_32FC1 in DN of 8 bits
/// \param event_edges binaryEdges(eventEdgeMap(...))
double sharpnessEnergy(const cv::Mat& latent, const cv::Mat1b& event_edges, double lambda);

struct ContrastSearchResult {
  double contrast = 0.0;  ///< [natural log]
  double energy = 0.0;
  int evaluations = 0;  ///< latent images computed
};

/// \param deblur latent image for a contrast threshold: CV_8UC1, or CV_32FC1 in DN of 8 bits
ContrastSearchResult searchContrast(const std::function<cv::Mat(double)>& deblur,
                                    const cv::Mat1b& event_edges,
                                    const ContrastSearchOptions& options = {});

}  // namespace fast_edi
