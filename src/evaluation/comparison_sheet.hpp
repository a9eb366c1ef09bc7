/// \file
/// One picture for people: rows of frames, columns of what was made of them, labelled.
#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace fast_edi {

struct SheetRow {
  std::string label;                  ///< above the row's panels, in small letters
  std::vector<cv::Mat> panels;        ///< one for each column, CV_8UC1 or CV_8UC3; may be empty
  std::vector<std::string> captions;  ///< below the panels; may be fewer
};

struct Sheet {
  std::string title;
  std::vector<std::string> columns;
  std::vector<SheetRow> rows;
};

/// Draws \p sheet as CV_8UC3 (BGR). Panels are magnified by a whole number so that small sensors
/// are at least kMinPanelWidth_px wide; all take the size of the largest.
/// \throws std::invalid_argument when a row has more panels than there are columns or no panel at
///         all has a picture
cv::Mat drawSheet(const Sheet& sheet);
constexpr int kMinPanelWidth_px = 320;

/// Factor that makes dim pictures visible on a screen: takes the brightest hundredth of
/// \p mono8 to kBright_dn, never darker and at most kMaxDisplayGain.
double displayGain(const cv::Mat& mono8);
constexpr double kBright_dn = 220.0;
constexpr double kMaxDisplayGain = 4.0;

}  // namespace fast_edi
