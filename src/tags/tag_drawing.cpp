#include "fast_edi/tags/tag_drawing.hpp"

#include <cmath>
#include <string>

#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

const cv::Scalar kOutline(0, 220, 0);
const cv::Scalar kLowerEdge(0, 0, 255);
const cv::Scalar kId(0, 255, 255);
constexpr double kIdScale = 0.4;
/// OpenCV draws to fractions of a pixel given as fixed-point numbers.
constexpr int kFractionBits = 4;

cv::Point toFixed(const cv::Point2d& point) {
  constexpr double kUnit = 1 << kFractionBits;
  return {static_cast<int>(std::lround(point.x * kUnit)),
          static_cast<int>(std::lround(point.y * kUnit))};
}

}  // namespace

void drawTags(const std::vector<TagDetection>& tags, cv::Mat& picture) {
  for (const TagDetection& tag : tags) {
    const auto edge = [&](TagCorner from, TagCorner to, const cv::Scalar& colour) {
      cv::line(picture, toFixed(tag.corners[from]), toFixed(tag.corners[to]), colour, 1,
               cv::LINE_AA, kFractionBits);
    };
    edge(kBottomRight, kTopRight, kOutline);
    edge(kTopRight, kTopLeft, kOutline);
    edge(kTopLeft, kBottomLeft, kOutline);
    edge(kBottomLeft, kBottomRight, kLowerEdge);
    const std::string text = std::to_string(tag.id);
    const cv::Size size = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, kIdScale, 1, nullptr);
    const cv::Point2d corner = tag.centre + cv::Point2d(-0.5 * size.width, 0.5 * size.height);
    cv::putText(picture, text, corner, cv::FONT_HERSHEY_SIMPLEX, kIdScale, kId, 1, cv::LINE_AA);
  }
}

}  // namespace fast_edi
