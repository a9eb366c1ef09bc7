#include "trajectory/trajectory_plot.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextScale = 0.45;
constexpr int kLineHeightPx = 18;
constexpr int kSidePx = 640;
constexpr int kMarginPx = 40;
constexpr int kHeaderPx = 3 * kLineHeightPx;
constexpr int kMarkPx = 5;

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);
const cv::Scalar kGrid(225, 225, 225);
const cv::Scalar kTruthColour(115, 158, 0);
const cv::Scalar kEstimateColour(0, 94, 213);

/// From metres to pixels, the same for both axes; y goes up.
struct TopView {
  Eigen::AlignedBox2d range;
  double px_per_m = 1.0;

  explicit TopView(const TrajectoryError& error) {
    for (const auto* points : {&error.truth, &error.estimate}) {
      for (const Eigen::Vector3d& point : *points) {
        range.extend(Eigen::Vector2d(point.head<2>()));
      }
    }
    constexpr double kSmallest_m = 0.1;
    px_per_m = (kSidePx - 2 * kMarginPx) / std::max(kSmallest_m, range.sizes().maxCoeff());
  }
  cv::Point at(double x_m, double y_m) const {
    return {kMarginPx + static_cast<int>(std::lround((x_m - range.min().x()) * px_per_m)),
            kHeaderPx + kSidePx - kMarginPx -
                static_cast<int>(std::lround((y_m - range.min().y()) * px_per_m))};
  }
};

/// 1, 2 or 5 times a power of ten, with at most eight lines across \p range_m.
double gridStep(double range_m) {
  constexpr double kLines = 8.0;
  const double decade = std::pow(10.0, std::floor(std::log10(range_m / kLines)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range_m / (factor * decade) <= kLines) {
      return factor * decade;
    }
  }
  return 10.0 * decade;
}

void drawGrid(const TopView& view, cv::Mat& canvas) {
  const double range_m = (kSidePx - 2 * kMarginPx) / view.px_per_m;
  const double step_m = gridStep(range_m);
  const auto label = [](double value) {
    constexpr int kDigits = 4;
    return roundedText(value, kDigits);
  };
  const Eigen::Vector2d first = (view.range.min() / step_m).array().ceil() * step_m;
  for (double x = first.x(); x <= view.range.min().x() + range_m; x += step_m) {
    const int column = view.at(x, 0.0).x;
    cv::line(canvas, {column, kHeaderPx}, {column, kHeaderPx + kSidePx - kMarginPx}, kGrid);
    cv::putText(canvas, label(x), {column - 8, kHeaderPx + kSidePx - kMarginPx / 2}, kFont,
                kTextScale, kBlack, 1, cv::LINE_AA);
  }
  for (double y = first.y(); y <= view.range.min().y() + range_m; y += step_m) {
    const int row = view.at(0.0, y).y;
    cv::line(canvas, {kMarginPx, row}, {kSidePx, row}, kGrid);
    cv::putText(canvas, label(y), {4, row + 4}, kFont, kTextScale, kBlack, 1, cv::LINE_AA);
  }
}

void drawTrajectory(const TopView& view, const std::vector<Eigen::Vector3d>& points,
                    const cv::Scalar& colour, cv::Mat& canvas) {
  std::vector<cv::Point> line;
  for (const Eigen::Vector3d& point : points) {
    line.push_back(view.at(point.x(), point.y()));
  }
  cv::polylines(canvas, line, false, colour, 1, cv::LINE_AA);
  cv::circle(canvas, line.front(), kMarkPx, colour, cv::FILLED, cv::LINE_AA);
  cv::drawMarker(canvas, line.back(), colour, cv::MARKER_TILTED_CROSS, 3 * kMarkPx, 2, cv::LINE_AA);
}

}  // namespace

cv::Mat topViewPlot(const std::string& title, const TrajectoryError& error) {
  cv::Mat canvas(kHeaderPx + kSidePx, kSidePx + kMarginPx, CV_8UC3, kWhite);
  const auto write = [&canvas](const std::string& text, cv::Point at, const cv::Scalar& colour) {
    cv::putText(canvas, text, at, kFont, kTextScale, colour, 1, cv::LINE_AA);
  };
  write(title, {kMarginPx, kLineHeightPx}, kBlack);
  write("truth", {kMarginPx, 2 * kLineHeightPx}, kTruthColour);
  write("estimate", {kMarginPx + 60, 2 * kLineHeightPx}, kEstimateColour);
  write("from above [m]; dot: start, cross: end", {kMarginPx + 150, 2 * kLineHeightPx}, kBlack);
  if (error.truth.empty()) {
    return canvas;
  }
  const TopView view(error);
  drawGrid(view, canvas);
  drawTrajectory(view, error.truth, kTruthColour, canvas);
  drawTrajectory(view, error.estimate, kEstimateColour, canvas);
  return canvas;
}

}  // namespace fast_edi
