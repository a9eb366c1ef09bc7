/// \file
/// Small images for the tests of the evaluation.
#pragma once

#include <cstdint>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace fast_edi {

constexpr std::uint64_t kTestSeed = 11;

/// Rectangles and discs of random brightness: edges, corners, and flat regions between them.
inline cv::Mat texturedImage(cv::Size size = {192, 160}, std::uint64_t seed = kTestSeed) {
  constexpr int kShapes = 90;
  cv::RNG random(seed);
  cv::Mat image(size, CV_8UC1, cv::Scalar(110));
  for (int i = 0; i < kShapes; ++i) {
    const cv::Point at(random.uniform(0, size.width), random.uniform(0, size.height));
    const cv::Scalar dn(random.uniform(30, 220));
    if (i % 2 == 0) {
      cv::rectangle(image, {at, cv::Size(random.uniform(6, 30), random.uniform(6, 30))}, dn,
                    cv::FILLED);
    } else {
      cv::circle(image, at, random.uniform(3, 14), dn, cv::FILLED);
    }
  }
  return image;
}

inline cv::Mat withNoise(const cv::Mat& image, double sigma_dn, std::uint64_t seed = kTestSeed) {
  cv::RNG random(seed);
  cv::Mat noise(image.size(), CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0.0, sigma_dn);
  cv::Mat sum;
  cv::add(image, noise, sum, cv::noArray(), CV_8U);
  return sum;
}

inline cv::Mat blurred(const cv::Mat& image, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(image, result, {}, sigma_px);
  return result;
}

}  // namespace fast_edi
