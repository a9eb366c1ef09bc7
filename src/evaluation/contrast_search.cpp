#include "evaluation/contrast_search.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

cv::Mat1f sobelMagnitude(const cv::Mat& image) {
  cv::Mat1f gx;
  cv::Mat1f gy;
  cv::Sobel(image, gx, CV_32F, 1, 0);
  cv::Sobel(image, gy, CV_32F, 0, 1);
  cv::Mat1f magnitude;
  cv::magnitude(gx, gy, magnitude);
  return magnitude;
}

double correlation(const cv::Mat1f& a, const cv::Mat1f& b) {
  cv::Scalar mean_a;
  cv::Scalar mean_b;
  cv::Scalar deviation_a;
  cv::Scalar deviation_b;
  cv::meanStdDev(a, mean_a, deviation_a);
  cv::meanStdDev(b, mean_b, deviation_b);
  const double deviations = deviation_a[0] * deviation_b[0];
  const double mean_product = a.dot(b) / static_cast<double>(a.total());
  return deviations > 0.0 ? (mean_product - mean_a[0] * mean_b[0]) / deviations : 0.0;
}

}  // namespace

Minimum fibonacciSearch(const std::function<double(double)>& function, double low, double high,
                        int intervals) {
  if (!(low < high) || intervals < 2) {
    throw std::invalid_argument("Fibonacci search: expected low < high and at least 2 intervals, " +
                                std::string("got [") + std::to_string(low) + ", " +
                                std::to_string(high) + "], " + std::to_string(intervals));
  }
  std::vector<double> fibonacci = {1.0, 2.0, 3.0};
  while (fibonacci.back() < intervals) {
    fibonacci.push_back(fibonacci.back() + fibonacci[fibonacci.size() - 2]);
  }
  Minimum minimum;
  const auto evaluate = [&](double position) {
    ++minimum.evaluations;
    return function(position);
  };
  // Positions in units of the resolution, so that inner points are met exactly again.
  const double unit = (high - low) / fibonacci.back();
  std::size_t n = fibonacci.size() - 1;
  double left = 0.0;
  double inner_left = fibonacci[n - 2];
  double inner_right = fibonacci[n - 1];
  double value_left = evaluate(low + unit * inner_left);
  double value_right = evaluate(low + unit * inner_right);
  while (n > 2) {
    --n;
    if (value_left <= value_right) {
      inner_right = inner_left;
      value_right = value_left;
      inner_left = left + fibonacci[n - 2];
      value_left = evaluate(low + unit * inner_left);
    } else {
      left = inner_left;
      inner_left = inner_right;
      value_left = value_right;
      inner_right = left + fibonacci[n - 1];
      value_right = evaluate(low + unit * inner_right);
    }
  }
  const bool take_left = value_left <= value_right;
  minimum.position = low + unit * (take_left ? inner_left : inner_right);
  minimum.value = take_left ? value_left : value_right;
  return minimum;
}

cv::Mat1f eventEdgeMap(const std::vector<Event>& events, SensorSize size, std::int64_t reference_ns,
                       std::int64_t decay_ns) {
  if (decay_ns <= 0) {
    throw std::invalid_argument("event edge map: expected a decay above 0 ns, got " +
                                std::to_string(decay_ns));
  }
  cv::Mat1f map(size.height, size.width, 0.0F);
  for (const Event& event : events) {
    const double distance =
        std::abs(static_cast<double>(event.t_ns - reference_ns)) / static_cast<double>(decay_ns);
    map(event.y, event.x) += static_cast<float>((event.on ? 1.0 : -1.0) * std::exp(-distance));
  }
  return cv::abs(map);
}

double totalVariation(const cv::Mat& image) {
  cv::Mat1f extended;
  image.convertTo(extended, CV_32F);
  cv::copyMakeBorder(extended, extended, 0, 1, 0, 1, cv::BORDER_REPLICATE);
  const cv::Rect all(0, 0, image.cols, image.rows);
  const cv::Mat1f values = extended(all);
  const cv::Mat1f dx = extended(all + cv::Point(1, 0)) - values;
  const cv::Mat1f dy = extended(all + cv::Point(0, 1)) - values;
  cv::Mat1f magnitude;
  cv::magnitude(dx, dy, magnitude);
  return cv::sum(magnitude)[0];
}

SharpnessEnergy::SharpnessEnergy(const cv::Mat& blurry, const cv::Mat1f& event_edges, double lambda)
    : blurry_variation_(totalVariation(blurry)),
      event_edges_(event_edges.clone()),
      lambda_(lambda) {
  if (blurry.size() != event_edges.size()) {
    throw std::invalid_argument("sharpness energy: blurry frame and event edges differ in size");
  }
}

double SharpnessEnergy::operator()(const cv::Mat& latent) const {
  const double variation =
      blurry_variation_ > 0.0 ? totalVariation(latent) / blurry_variation_ : 0.0;
  return lambda_ * variation - correlation(sobelMagnitude(latent), event_edges_);
}

ContrastSearchResult searchContrast(const std::function<cv::Mat(double)>& deblur,
                                    const SharpnessEnergy& energy,
                                    const ContrastSearchOptions& options) {
  const Minimum minimum = fibonacciSearch([&](double contrast) { return energy(deblur(contrast)); },
                                          options.low, options.high, options.intervals);
  return {minimum.position, minimum.value, minimum.evaluations};
}

}  // namespace fast_edi
