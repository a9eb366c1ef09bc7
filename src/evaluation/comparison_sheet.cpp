#include "evaluation/comparison_sheet.hpp"

#include <algorithm>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace fast_edi {
namespace {

// Lengths in pixels.
constexpr int kMargin = 24;
constexpr int kGap = 10;
constexpr int kTitleHeight = 48;
constexpr int kHeadingHeight = 34;
constexpr int kLabelHeight = 28;
constexpr int kCaptionHeight = 24;
constexpr int kBaseline = 8;

constexpr double kTitleScale = 0.85;
constexpr double kHeadingScale = 0.65;
constexpr double kSmallScale = 0.48;

const cv::Scalar kPaper = cv::Scalar::all(250);
const cv::Scalar kInk = cv::Scalar::all(30);
const cv::Scalar kPaleInk = cv::Scalar::all(110);
const cv::Scalar kNothing = cv::Scalar::all(225);

void write(cv::Mat& picture, const std::string& text, int x, int y, double scale,
           const cv::Scalar& ink) {
  cv::putText(picture, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, scale, ink, 1, cv::LINE_AA);
}

cv::Size largestPanel(const Sheet& sheet) {
  cv::Size largest;
  for (const SheetRow& row : sheet.rows) {
    if (row.panels.size() > sheet.columns.size()) {
      throw std::invalid_argument("sheet: a row has more panels than there are columns");
    }
    for (const cv::Mat& panel : row.panels) {
      largest.width = std::max(largest.width, panel.cols);
      largest.height = std::max(largest.height, panel.rows);
    }
  }
  if (largest.area() == 0) {
    throw std::invalid_argument("sheet: there is no picture to draw");
  }
  return largest;
}

/// Brings \p panel to three channels and magnifies it.
cv::Mat prepared(const cv::Mat& panel, int magnification) {
  cv::Mat colour;
  if (panel.channels() == 1) {
    cv::cvtColor(panel, colour, cv::COLOR_GRAY2BGR);
  } else {
    colour = panel;
  }
  cv::Mat larger;
  cv::resize(colour, larger, {}, magnification, magnification, cv::INTER_CUBIC);
  return larger;
}

}  // namespace

cv::Mat drawSheet(const Sheet& sheet) {
  const cv::Size largest = largestPanel(sheet);
  const int magnification = std::max(1, (kMinPanelWidth_px + largest.width - 1) / largest.width);
  const cv::Size panel_size = largest * magnification;
  const int columns = static_cast<int>(sheet.columns.size());
  const int rows = static_cast<int>(sheet.rows.size());
  const int row_height = kLabelHeight + panel_size.height + kCaptionHeight + kGap;
  cv::Mat picture(kMargin + kTitleHeight + kHeadingHeight + rows * row_height + kMargin,
                  2 * kMargin + columns * panel_size.width + (columns - 1) * kGap, CV_8UC3, kPaper);
  write(picture, sheet.title, kMargin, kMargin + kTitleHeight - kBaseline - kGap, kTitleScale,
        kInk);
  const auto left = [&](int column) { return kMargin + column * (panel_size.width + kGap); };
  const int heading_bottom = kMargin + kTitleHeight + kHeadingHeight;
  for (int column = 0; column < columns; ++column) {
    write(picture, sheet.columns[static_cast<std::size_t>(column)], left(column),
          heading_bottom - kBaseline, kHeadingScale, kInk);
  }
  for (int r = 0; r < rows; ++r) {
    const SheetRow& row = sheet.rows[static_cast<std::size_t>(r)];
    const int top = heading_bottom + r * row_height;
    write(picture, row.label, kMargin, top + kLabelHeight - kBaseline, kSmallScale, kPaleInk);
    for (int column = 0; column < columns; ++column) {
      const cv::Rect place(left(column), top + kLabelHeight, panel_size.width, panel_size.height);
      cv::Mat area = picture(place);
      area.setTo(kNothing);
      const auto index = static_cast<std::size_t>(column);
      if (index < row.panels.size() && !row.panels[index].empty()) {
        const cv::Mat panel = prepared(row.panels[index], magnification);
        panel.copyTo(area(cv::Rect({0, 0}, panel.size())));
      }
      if (index < row.captions.size()) {
        write(picture, row.captions[index], left(column), place.br().y + kCaptionHeight - kBaseline,
              kSmallScale, kInk);
      }
    }
  }
  return picture;
}

double displayGain(const cv::Mat& mono8) {
  constexpr double kBrightest = 0.01;
  constexpr int kLevels = 256;
  std::vector<int> histogram(kLevels, 0);
  for (int y = 0; y < mono8.rows; ++y) {
    const std::uint8_t* row = mono8.ptr<std::uint8_t>(y);
    for (int x = 0; x < mono8.cols; ++x) {
      ++histogram[row[x]];
    }
  }
  const double share = kBrightest * static_cast<double>(mono8.total());
  int level = kLevels - 1;
  for (double above = histogram[static_cast<std::size_t>(level)]; level > 1 && above < share;) {
    above += histogram[static_cast<std::size_t>(--level)];
  }
  return std::clamp(kBright_dn / level, 1.0, kMaxDisplayGain);
}

}  // namespace fast_edi
