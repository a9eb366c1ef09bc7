#include "tags/searched_pixels.hpp"

#include <algorithm>
#include <cmath>

namespace fast_edi {
namespace {

/// libapriltag leaves out what does not fill a pixel of the decimated frame, or three of them.
constexpr double kLostByDecimation_px = 2.0;

/// A side of the decimated frame, at least.
double decimatedSide(int side_px, double decimate) {
  return side_px / decimate - (decimate > 1.0 ? kLostByDecimation_px : 0.0);
}

}  // namespace

cv::Mat withEnoughRows(const cv::Mat& image, double decimate) {
  const double columns = decimatedSide(image.cols, decimate);
  // One more, so that no rounding makes it too few.
  const double rows = std::floor(kPixelsPerThread / columns) + 1.0;
  if (decimatedSide(image.rows, decimate) >= rows) {
    return image;
  }
  const double lost = decimate > 1.0 ? kLostByDecimation_px : 0.0;
  const int needed = static_cast<int>(std::ceil((rows + lost) * decimate));
  cv::Mat enlarged;
  cv::copyMakeBorder(image, enlarged, 0, needed - image.rows, 0, 0,
                     cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  return enlarged;
}

int threadsWithEnoughPixels(cv::Size size, double decimate, int wanted) {
  const double pixels = decimatedSide(size.width, decimate) * decimatedSide(size.height, decimate);
  // Fewer than would just do, so that no rounding makes it too few.
  const int enough = static_cast<int>(std::ceil(pixels / kPixelsPerThread)) - 1;
  return std::clamp(enough, 1, wanted);
}

}  // namespace fast_edi
