#include "evaluation/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextScale = 0.45;
constexpr int kLineHeightPx = 18;
constexpr int kPlotWidthPx = 900;
constexpr int kPlotHeightPx = 300;
constexpr int kLeftPx = 80;
constexpr int kRightPx = 20;
constexpr int kTicks = 5;

const cv::Scalar kWhite(255, 255, 255);
const cv::Scalar kBlack(0, 0, 0);
const cv::Scalar kGrid(225, 225, 225);

/// Distinguishable also by those who see red and green alike (Okabe and Ito), as BGR.
cv::Scalar seriesColour(std::size_t index) {
  constexpr std::array<std::array<int, 3>, 6> kColours = {
      {{150, 150, 150}, {178, 114, 0}, {233, 180, 86}, {115, 158, 0}, {0, 94, 213}, {0, 0, 0}}};
  const std::array<int, 3>& colour = kColours[index % kColours.size()];
  return cv::Scalar(colour[0], colour[1], colour[2]);
}

void write(cv::Mat& canvas, const std::string& text, cv::Point at,
           const cv::Scalar& colour = kBlack) {
  cv::putText(canvas, text, at, kFont, kTextScale, colour, 1, cv::LINE_AA);
}

std::string number(double value) {
  constexpr int kDigits = 4;
  return roundedText(value, kDigits);
}

/// The drawing area and the meaning of its vertical axis.
struct Frame {
  cv::Mat canvas;
  cv::Rect area;
  double low = 0.0;
  double high = 1.0;

  int y(double value) const {
    return area.y + area.height -
           static_cast<int>(std::lround((value - low) / (high - low) * area.height));
  }
};

void chooseRange(const std::vector<PlotSeries>& series, bool prefer_zero, Frame& frame) {
  constexpr double kFarFromZero = 0.6;  // range below this share of the maximum: zoom in
  constexpr double kHeadroom = 0.05;
  std::optional<double> low;
  std::optional<double> high;
  for (const PlotSeries& line : series) {
    for (const std::optional<double>& value : line.values) {
      if (value) {
        low = low ? std::min(*low, *value) : *value;
        high = high ? std::max(*high, *value) : *value;
      }
    }
  }
  frame.low = low.value_or(0.0);
  frame.high = high.value_or(1.0);
  const double range = frame.high - frame.low;
  if (prefer_zero && frame.low >= 0.0 && range > kFarFromZero * frame.high) {
    frame.low = 0.0;
  } else {
    frame.low -= kHeadroom * range;
  }
  frame.high += kHeadroom * range;
  if (!(frame.high > frame.low)) {
    frame.low -= 0.5;
    frame.high += 0.5;
  }
}

Frame makeFrame(const PlotLabels& labels, const std::vector<PlotSeries>& series, bool prefer_zero,
                int footer_lines) {
  const int header = 3 * kLineHeightPx;
  const int footer = (footer_lines + 1) * kLineHeightPx;
  Frame frame;
  frame.canvas =
      cv::Mat(header + kPlotHeightPx + footer, kLeftPx + kPlotWidthPx + kRightPx, CV_8UC3, kWhite);
  frame.area = {kLeftPx, header, kPlotWidthPx, kPlotHeightPx};
  chooseRange(series, prefer_zero, frame);
  write(frame.canvas, labels.title, {kLeftPx, kLineHeightPx});
  write(frame.canvas, labels.y, {4, 2 * kLineHeightPx});
  write(frame.canvas, labels.x, {kLeftPx, frame.canvas.rows - 6});
  int x = kLeftPx + 120;
  for (std::size_t i = 0; i < series.size(); ++i) {
    cv::rectangle(frame.canvas, cv::Rect(x, 2 * kLineHeightPx - 9, 10, 10), seriesColour(i),
                  cv::FILLED);
    write(frame.canvas, series[i].name, {x + 14, 2 * kLineHeightPx});
    x += 34 + cv::getTextSize(series[i].name, kFont, kTextScale, 1, nullptr).width;
  }
  for (int tick = 0; tick <= kTicks; ++tick) {
    const double value = frame.low + (frame.high - frame.low) * tick / kTicks;
    cv::line(frame.canvas, {kLeftPx, frame.y(value)}, {kLeftPx + kPlotWidthPx, frame.y(value)},
             kGrid);
    write(frame.canvas, number(value), {8, frame.y(value) + 4});
  }
  cv::rectangle(frame.canvas, frame.area, kBlack);
  return frame;
}

}  // namespace

cv::Mat linePlot(const PlotLabels& labels, const std::vector<PlotSeries>& series) {
  Frame frame = makeFrame(labels, series, false, 1);
  std::size_t count = 0;
  for (const PlotSeries& line : series) {
    count = std::max(count, line.values.size());
  }
  const auto x_of = [&](std::size_t index) {
    return count < 2 ? kLeftPx + kPlotWidthPx / 2
                     : kLeftPx + static_cast<int>(index * kPlotWidthPx / (count - 1));
  };
  for (std::size_t s = 0; s < series.size(); ++s) {
    const std::vector<std::optional<double>>& values = series[s].values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!values[i]) {
        continue;
      }
      const cv::Point at(x_of(i), frame.y(*values[i]));
      cv::circle(frame.canvas, at, 3, seriesColour(s), cv::FILLED, cv::LINE_AA);
      if (i > 0 && values[i - 1]) {
        cv::line(frame.canvas, {x_of(i - 1), frame.y(*values[i - 1])}, at, seriesColour(s), 2,
                 cv::LINE_AA);
      }
    }
  }
  if (count > 0) {
    write(frame.canvas, "0", {kLeftPx, frame.area.br().y + kLineHeightPx});
    const std::string last = std::to_string(count - 1);
    write(frame.canvas, last, {frame.area.br().x - 20, frame.area.br().y + kLineHeightPx});
  }
  return frame.canvas;
}

cv::Mat barPlot(const PlotLabels& labels, const std::vector<std::string>& groups,
                const std::vector<PlotSeries>& series) {
  // Long names of groups alternate between two lines.
  Frame frame = makeFrame(labels, series, true, 2);
  const double group_width = kPlotWidthPx / std::max(1.0, static_cast<double>(groups.size()));
  constexpr double kGapShare = 0.2;
  const double bar_width =
      group_width * (1.0 - kGapShare) / std::max(1.0, static_cast<double>(series.size()));
  for (std::size_t group = 0; group < groups.size(); ++group) {
    const double left = kLeftPx + group_width * (static_cast<double>(group) + kGapShare / 2.0);
    for (std::size_t s = 0; s < series.size(); ++s) {
      if (group >= series[s].values.size() || !series[s].values[group]) {
        continue;
      }
      const int x = static_cast<int>(left + bar_width * static_cast<double>(s));
      const int width = std::max(1, static_cast<int>(bar_width) - 1);
      const int top = frame.y(*series[s].values[group]);
      cv::rectangle(frame.canvas, cv::Rect(x, top, width, frame.area.br().y - top), seriesColour(s),
                    cv::FILLED);
    }
    const int line = 1 + static_cast<int>(group % 2);
    write(frame.canvas, groups[group],
          {static_cast<int>(left), frame.area.br().y + line * kLineHeightPx - 3});
  }
  return frame.canvas;
}

cv::Mat pictureGrid(const std::vector<CaptionedPicture>& pictures, int columns, int scale) {
  constexpr int kGapPx = 4;
  std::vector<CaptionedPicture> shown;
  cv::Size cell;
  for (const CaptionedPicture& picture : pictures) {
    if (!picture.image.empty()) {
      shown.push_back(picture);
      cell.width = std::max(cell.width, picture.image.cols * scale);
      cell.height = std::max(cell.height, picture.image.rows * scale);
    }
  }
  const int count = static_cast<int>(shown.size());
  const int used_columns = std::max(1, std::min(columns, count));
  const int rows = std::max(1, (count + used_columns - 1) / used_columns);
  cell.height += kLineHeightPx;
  cv::Mat canvas(rows * (cell.height + kGapPx), used_columns * (cell.width + kGapPx) + 1, CV_8UC3,
                 kWhite);
  for (int i = 0; i < count; ++i) {
    const CaptionedPicture& picture = shown[static_cast<std::size_t>(i)];
    const cv::Point at((i % used_columns) * (cell.width + kGapPx),
                       (i / used_columns) * (cell.height + kGapPx));
    write(canvas, picture.caption, at + cv::Point(2, kLineHeightPx - 5));
    cv::Mat large;
    cv::resize(picture.image, large, {}, scale, scale, cv::INTER_NEAREST);
    cv::Mat coloured;
    cv::cvtColor(large, coloured, cv::COLOR_GRAY2BGR);
    coloured.copyTo(canvas(cv::Rect(at + cv::Point(0, kLineHeightPx), coloured.size())));
  }
  return canvas;
}

}  // namespace fast_edi
