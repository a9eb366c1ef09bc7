#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "scenes/texture_brushes.hpp"

namespace fast_edi {

void drawMosaic(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  constexpr double kStonePx = 18.0;  ///< mean distance of stones
  constexpr double kJointPx = 1.5;
  const int columns = static_cast<int>(canvas.cols / (kStonePx * scale)) + 1;
  const int rows = static_cast<int>(canvas.rows / (kStonePx * scale)) + 1;
  cv::Mat1b ground(canvas.size(), std::uint8_t{1});
  for (int i = 0; i < columns * rows; ++i) {
    // One by one: compilers choose the order in which arguments are evaluated.
    const int column = uniformInt(random, 0, canvas.cols - 1);
    const int row = uniformInt(random, 0, canvas.rows - 1);
    ground(row, column) = 0;
  }
  // Each element belongs to the nearest centre: a Voronoi diagram.
  cv::Mat1f distance;
  cv::Mat1i stone;
  cv::distanceTransform(ground, distance, stone, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_PIXEL);
  double stones = 0.0;
  cv::minMaxLoc(stone, nullptr, &stones);
  std::vector<Colour> colours;
  for (int i = 0; i <= static_cast<int>(stones); ++i) {
    const double luminance = std::exp(uniform(random, std::log(0.12), std::log(0.8)));
    colours.push_back(tinted(random, luminance, 0.2));
  }
  cv::Mat1b joint(canvas.size(), std::uint8_t{0});
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const Colour& colour = colours[static_cast<std::size_t>(stone(y, x))];
      canvas(y, x) = cv::Vec3f(static_cast<float>(colour[0]), static_cast<float>(colour[1]),
                               static_cast<float>(colour[2]));
      const bool differs = stone(y, x) != stone(y, std::max(0, x - 1)) ||
                           stone(y, x) != stone(std::max(0, y - 1), x);
      joint(y, x) = differs ? 1 : 0;
    }
  }
  const int joint_width = std::max(1, static_cast<int>(std::lround(kJointPx * scale)));
  cv::dilate(joint, joint,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {joint_width, joint_width}));
  canvas.setTo(Colour::all(0.07), joint);
  shade(fractalNoise(canvas.size(), 60.0 * scale, 3.0 * scale, random), 0.06, canvas);
}

}  // namespace fast_edi
