#include "scenes/texture_brushes.hpp"

#include <cmath>

#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_int_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <opencv2/imgproc.hpp>

namespace fast_edi {

double uniform(RandomEngine& random, double low, double high) {
  return boost::random::uniform_real_distribution<double>(low, high)(random);
}

int uniformInt(RandomEngine& random, int low, int high) {
  return boost::random::uniform_int_distribution<int>(low, high)(random);
}

Colour tinted(RandomEngine& random, double luminance, double saturation) {
  const double hue = uniform(random, 0.0, 2.0 * CV_PI);
  Colour colour;
  for (int channel = 0; channel < 3; ++channel) {
    colour[channel] = luminance * (1.0 + saturation * std::cos(hue + 2.0 * CV_PI / 3.0 * channel));
  }
  return colour;
}

cv::Mat1f fractalNoise(cv::Size size, double coarsest, double finest, RandomEngine& random) {
  boost::random::normal_distribution<float> normal;
  cv::Mat1f sum = cv::Mat1f::zeros(size);
  double amplitude = 1.0;
  for (double cell = coarsest; cell >= finest; cell *= 0.5, amplitude *= 0.5) {
    cv::Mat1f grid(static_cast<int>(size.height / cell) + 3,
                   static_cast<int>(size.width / cell) + 3);
    for (float& value : grid) value = normal(random);
    cv::Mat1f octave;
    cv::resize(grid, octave, size, 0.0, 0.0, cv::INTER_CUBIC);
    sum += amplitude * octave;
  }
  return sum;
}

void shade(const cv::Mat1f& noise, double strength, cv::Mat3f& canvas) {
  cv::Mat1f factor;
  cv::exp(noise * strength, factor);
  cv::Mat channels[] = {factor, factor, factor};
  cv::Mat factors;
  cv::merge(channels, 3, factors);
  cv::multiply(canvas, factors, canvas);
}

}  // namespace fast_edi
