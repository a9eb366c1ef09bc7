#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "scenes/texture_brushes.hpp"

namespace fast_edi {

void drawClouds(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  canvas.setTo(Colour::all(0.35));
  shade(fractalNoise(canvas.size(), 100.0 * scale, 1.5 * scale, random), 0.35, canvas);
}

void drawWeave(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  constexpr double kThreadPx = 5.0;
  constexpr int kFewestStripes = 6;
  constexpr int kMostStripes = 10;
  const double pitch = kThreadPx * scale;
  // Threads wander: their phase is drawn aside by smooth noise.
  const cv::Mat1f across = fractalNoise(canvas.size(), 90.0 * scale, 45.0 * scale, random);
  const cv::Mat1f along = fractalNoise(canvas.size(), 90.0 * scale, 45.0 * scale, random);
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const double u = x / pitch + 0.5 * across(y, x);
      const double v = y / pitch + 0.5 * along(y, x);
      const bool warp_on_top =
          (static_cast<int>(std::floor(u)) + static_cast<int>(std::floor(v))) % 2 == 0;
      // A round thread is brightest in its middle.
      const double height = std::abs(std::sin(CV_PI * (warp_on_top ? u : v)));
      const auto grey = static_cast<float>((warp_on_top ? 0.55 : 0.38) * (0.35 + 0.65 * height));
      canvas(y, x) = cv::Vec3f::all(grey);
    }
  }
  const int stripes = uniformInt(random, kFewestStripes, kMostStripes);
  for (int i = 0; i < stripes; ++i) {
    const cv::Point from(uniformInt(random, 0, canvas.cols), 0);
    const cv::Point to(uniformInt(random, 0, canvas.cols), canvas.rows);
    cv::Mat1b band(canvas.size(), std::uint8_t{0});
    cv::line(band, from, to, cv::Scalar(1), static_cast<int>(uniform(random, 6.0, 20.0) * scale));
    canvas.setTo(tinted(random, uniform(random, 0.08, 0.2), 0.2), band);
  }
  shade(fractalNoise(canvas.size(), 60.0 * scale, 2.0 * scale, random), 0.15, canvas);
}

}  // namespace fast_edi
