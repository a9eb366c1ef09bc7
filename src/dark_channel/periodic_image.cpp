#include "dark_channel/periodic_image.hpp"

#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

/// Fills the columns of \p image from \p used on with a ramp from the last used one to the first.
void rampColumns(const cv::Mat1f& image, int used) {
  const int gap = image.cols - used + 1;
  for (int x = used; x < image.cols; ++x) {
    const double weight = static_cast<double>(x - used + 1) / gap;
    cv::addWeighted(image.col(used - 1), 1.0 - weight, image.col(0), weight, 0.0, image.col(x));
  }
}

/// Same as rampColumns() for rows.
void rampRows(const cv::Mat1f& image, int used) {
  const int gap = image.rows - used + 1;
  for (int y = used; y < image.rows; ++y) {
    const double weight = static_cast<double>(y - used + 1) / gap;
    cv::addWeighted(image.row(used - 1), 1.0 - weight, image.row(0), weight, 0.0, image.row(y));
  }
}

}  // namespace

cv::Mat1f periodicImage(const cv::Mat1f& image, int margin) {
  cv::Mat1f periodic(cv::getOptimalDFTSize(image.rows + margin),
                     cv::getOptimalDFTSize(image.cols + margin), 0.0F);
  image.copyTo(periodic(cv::Rect({0, 0}, image.size())));
  rampColumns(periodic.rowRange(0, image.rows), image.cols);
  rampRows(periodic, image.rows);
  return periodic;
}

}  // namespace fast_edi
