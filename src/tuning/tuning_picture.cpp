#include "tuning/tuning_picture.hpp"

#include <cstddef>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "evaluation/comparison_sheet.hpp"
#include "fast_edi/base/number_text.hpp"
#include "measures/image_metrics.hpp"

namespace fast_edi {
namespace {

// Lengths in pixels.
constexpr int kMargin = 24;
constexpr int kLineHeight = 24;
constexpr int kBaseline = 7;
constexpr int kNameWidth = 200;
constexpr int kBarWidth = 330;
constexpr int kGap = 20;
constexpr int kKnobRadius = 5;
constexpr int kKeysWidth = 90;

constexpr double kTextScale = 0.48;
/// A smaller one is not worth a word.
constexpr double kNoticeableGain = 1.25;

const cv::Scalar kPaper = cv::Scalar::all(250);
const cv::Scalar kInk = cv::Scalar::all(30);
const cv::Scalar kPaleInk = cv::Scalar::all(110);
const cv::Scalar kTrack = cv::Scalar::all(200);
const cv::Scalar kChosen = cv::Scalar(160, 80, 0);

void write(cv::Mat& picture, const std::string& text, int x, int line, const cv::Scalar& ink) {
  cv::putText(picture, text, {x, (line + 1) * kLineHeight - kBaseline}, cv::FONT_HERSHEY_SIMPLEX,
              kTextScale, ink, 1, cv::LINE_AA);
}

cv::Mat greyOf(const cv::Mat& panel) {
  cv::Mat grey = panel;
  if (panel.channels() > 1) {
    cv::cvtColor(panel, grey, cv::COLOR_BGR2GRAY);
  }
  return grey;
}

std::string sharpnessCaption(const cv::Mat& panel) {
  return panel.empty()
             ? std::string()
             : "sharpness " + fixedText(sharpness(greyOf(panel)).tenengrad_above_noise, 1);
}

cv::Mat brighter(const cv::Mat& panel, double gain) {
  cv::Mat result;
  panel.convertTo(result, CV_8U, gain);
  return result;
}

cv::Mat drawPanels(const TuningSession& session, const TunedFrame& frame) {
  Sheet sheet;
  // Counted from 0, as --frame and the files of deblur_bag --frames are.
  sheet.title =
      "frame " + std::to_string(session.frame()) + " of 0.." + std::to_string(session.frames() - 1);
  sheet.columns = {"blurry frame", "events (red ON, blue OFF)", "deblurred"};
  SheetRow row;
  row.label = frame.description;
  row.panels = {frame.blurry, frame.events, frame.deblurred};
  const double gain = displayGain(greyOf(frame.blurry));
  if (gain > kNoticeableGain) {
    sheet.title += "  (shown " + fixedText(gain, 1) + " times as bright)";
    row.panels = {brighter(frame.blurry, gain), frame.events, brighter(frame.deblurred, gain)};
  }
  row.captions = {sharpnessCaption(frame.blurry), "", sharpnessCaption(frame.deblurred)};
  sheet.rows = {row};
  return drawSheet(sheet);
}

std::string valueText(const TuningSession& session, std::size_t slider) {
  const std::string& unit = session.sliders()[slider].unit();
  const double value = session.value(slider);
  const double start = session.startValue(slider);
  return numberText(value) + (unit.empty() ? "" : " " + unit) +
         (value == start ? "" : "  (started at " + numberText(start) + ")");
}

void drawSlider(const TuningSession& session, std::size_t slider, int line, cv::Mat& picture) {
  const cv::Scalar& ink = slider == session.chosenSlider() ? kChosen : kInk;
  const int left = kMargin + kNameWidth;
  const int y = line * kLineHeight + kLineHeight / 2;
  const int last = session.sliders()[slider].lastPosition();
  const int knob = left + kBarWidth * session.position(slider) / last;
  write(picture, session.sliders()[slider].name(), kMargin, line, ink);
  cv::line(picture, {left, y}, {left + kBarWidth, y}, kTrack, 2);
  cv::circle(picture, {knob, y}, kKnobRadius, ink, cv::FILLED, cv::LINE_AA);
  write(picture, valueText(session, slider), left + kBarWidth + kGap, line, ink);
}

}  // namespace

cv::Mat drawTuning(const TuningSession& session, const TunedFrame& frame) {
  const cv::Mat panels = drawPanels(session, frame);
  const int sliders = static_cast<int>(session.sliders().size());
  const int help = session.showsHelp() ? static_cast<int>(kTuningKeys.size()) : 0;
  const int lines = sliders + help + 1;
  cv::Mat below(lines * kLineHeight + kMargin, panels.cols, CV_8UC3, kPaper);
  int line = 0;
  for (; line < sliders; ++line) {
    drawSlider(session, static_cast<std::size_t>(line), line, below);
  }
  for (int i = 0; i < help; ++i, ++line) {
    const TuningKey& key = kTuningKeys[static_cast<std::size_t>(i)];
    write(below, key.keys, kMargin, line, kChosen);
    write(below, key.what, kMargin + kKeysWidth, line, kInk);
  }
  const bool quiet = session.message().empty();
  write(below, quiet ? "h: keys" : session.message(), kMargin, line, quiet ? kPaleInk : kChosen);
  cv::Mat picture;
  cv::vconcat(panels, below, picture);
  return picture;
}

std::string tuningTitle(const TuningSession& session) {
  const std::size_t chosen = session.chosenSlider();
  return "frame " + std::to_string(session.frame()) + ", " + session.sliders()[chosen].name() +
         " " + numberText(session.value(chosen)) +
         (session.message().empty() ? "" : ", " + session.message());
}

}  // namespace fast_edi
