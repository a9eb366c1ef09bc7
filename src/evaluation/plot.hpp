/// \file
/// Plain diagrams and rows of pictures, drawn with OpenCV: no other tool is needed for a report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

/// One line or one colour of bars. Values without a number leave a gap.
struct PlotSeries {
  std::string name;
  std::vector<std::optional<double>> values;
};

struct PlotLabels {
  std::string title;
  std::string x;
  std::string y;
};

/// Values over their index. \return CV_8UC3
cv::Mat linePlot(const PlotLabels& labels, const std::vector<PlotSeries>& series);

/// Groups of bars, the i-th group holding the i-th value of each series; the vertical axis starts
/// at zero unless all values lie far from it. \return CV_8UC3
cv::Mat barPlot(const PlotLabels& labels, const std::vector<std::string>& groups,
                const std::vector<PlotSeries>& series);

struct CaptionedPicture {
  std::string caption;
  cv::Mat image;  ///< CV_8UC1; empty ones are left out
};

/// Pictures side by side, \p columns in a row, each enlarged \p scale times. \return CV_8UC3
cv::Mat pictureGrid(const std::vector<CaptionedPicture>& pictures, int columns, int scale);

}  // namespace fast_edi
