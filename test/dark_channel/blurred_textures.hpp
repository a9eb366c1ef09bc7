/// \file
/// Sharp textures, a kernel, and how near an estimate comes to them.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "measures/image_metrics.hpp"

namespace fast_edi {

/// "polygons", "rectangles" or "discs", each with dark and bright parts. CV_8UC1
inline cv::Mat sharpTexture(const std::string& kind, int side) {
  cv::RNG random(7);
  const auto level = [&random] { return cv::Scalar(random.uniform(0, 256)); };
  const auto place = [&] { return cv::Point(random.uniform(0, side), random.uniform(0, side)); };
  cv::Mat image(side, side, CV_8UC1, cv::Scalar(120));
  if (kind == "polygons") {
    for (int i = 0; i < 40; ++i) {
      const cv::Point corners[] = {place(), place(), place()};
      cv::fillConvexPoly(image, corners, 3, level());
    }
  } else if (kind == "rectangles") {
    for (int i = 0; i < 40; ++i) {
      cv::rectangle(image, place(), place(), level(), i % 2 == 0 ? cv::FILLED : 3);
    }
  } else {
    for (int i = 0; i < 90; ++i) {
      cv::circle(image, place(), random.uniform(2, 12), level(), cv::FILLED);
    }
  }
  return image;
}

/// The path of a shaken camera, 9 by 9 px, centroid near the centre.
inline cv::Mat1f shakeKernel() {
  cv::Mat1f kernel(9, 9, 0.0F);
  const cv::Point path[] = {{1, 6}, {3, 5}, {5, 5}, {7, 2}};
  for (int i = 0; i + 1 < 4; ++i) {
    cv::line(kernel, path[i], path[i + 1], cv::Scalar(1.0));
  }
  return kernel / cv::sum(kernel)[0];
}

/// \p sharp convolved with \p kernel, with noise of 1 DN, without \p margin px at its edges.
inline cv::Mat blurredTexture(const cv::Mat& sharp, const cv::Mat1f& kernel, int margin) {
  cv::Mat1f flipped;
  cv::flip(kernel, flipped, -1);  // filter2D() correlates
  cv::Mat1f blurred;
  cv::filter2D(sharp, blurred, CV_32F, flipped);
  cv::Mat1f noise(blurred.size());
  cv::RNG random(8);
  random.fill(noise, cv::RNG::NORMAL, 0.0, 1.0);
  cv::Mat result;
  cv::Mat(blurred + noise).convertTo(result, CV_8U);
  return result(cv::Rect(margin, margin, sharp.cols - 2 * margin, sharp.rows - 2 * margin)).clone();
}

/// Normalised correlation at the best shift of one kernel against the other.
inline double kernelCorrelation(const cv::Mat1f& estimate, const cv::Mat1f& kernel) {
  cv::Mat1f padded;
  const int border = std::max(estimate.rows, kernel.rows);
  cv::copyMakeBorder(estimate, padded, border, border, border, border, cv::BORDER_CONSTANT);
  cv::Mat1f correlation;
  cv::matchTemplate(padded, kernel, correlation, cv::TM_CCORR);
  double best = 0.0;
  cv::minMaxLoc(correlation, nullptr, &best);
  return best / (cv::norm(estimate) * cv::norm(kernel));
}

/// PSNR of the middle at the best shift [dB]: blind deblurring cannot know where the image lies.
inline double psnrAtBestShift(const cv::Mat& image, const cv::Mat& truth, int most_px) {
  constexpr int kEdge = 10;
  const cv::Rect middle(kEdge, kEdge, truth.cols - 2 * kEdge, truth.rows - 2 * kEdge);
  double best = 0.0;
  for (int y = -most_px; y <= most_px; ++y) {
    for (int x = -most_px; x <= most_px; ++x) {
      best = std::max(best, psnr(image(middle + cv::Point(x, y)), truth(middle)));
    }
  }
  return best;
}

}  // namespace fast_edi
