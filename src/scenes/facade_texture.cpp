#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "scenes/texture_brushes.hpp"

namespace fast_edi {
namespace {

int elements(double px, double scale) {
  return std::max(1, static_cast<int>(std::lround(px * scale)));
}

/// Courses of stone blocks, each of its own grey, with a thin dark joint.
void layStones(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  constexpr double kCoursePx = 9.0;
  const int course = elements(kCoursePx, scale);
  const int joint = elements(0.7, scale);
  for (int y = 0; y < canvas.rows; y += course) {
    for (int x = -uniformInt(random, 0, 2 * course); x < canvas.cols;) {
      const int length = uniformInt(random, course, 3 * course);
      cv::rectangle(canvas, cv::Rect(x, y, length, course), Colour::all(0.22), cv::FILLED);
      cv::rectangle(canvas, cv::Rect(x, y, length - joint, course - joint),
                    tinted(random, uniform(random, 0.36, 0.6), 0.1), cv::FILLED);
      x += length;
    }
  }
}

/// A frame, dark panes with a bar across, a sky's reflection, a shadow under the sill.
void setWindow(cv::Mat3f& canvas, const cv::Rect& box, double scale, RandomEngine& random) {
  const int frame = elements(2.0, scale);
  const int bar = elements(1.2, scale);
  const cv::Rect shadow(box.x, box.br().y, box.width, elements(3.0, scale));
  cv::rectangle(canvas, shadow, Colour::all(0.15), cv::FILLED);
  cv::rectangle(canvas, box, Colour::all(uniform(random, 0.7, 0.9)), cv::FILLED);
  const cv::Rect pane(box.x + frame, box.y + frame, box.width - 2 * frame, box.height - 2 * frame);
  cv::rectangle(canvas, pane, Colour::all(uniform(random, 0.05, 0.12)), cv::FILLED);
  const int slope = uniformInt(random, 0, pane.width);
  const std::vector<std::vector<cv::Point>> reflection = {
      {{pane.x, pane.y}, {pane.x + slope, pane.y}, {pane.x, pane.y + pane.height / 2}}};
  cv::fillPoly(canvas, reflection, Colour::all(uniform(random, 0.2, 0.45)));
  const Colour bars = Colour::all(0.75);
  cv::rectangle(canvas, cv::Rect(pane.x + pane.width / 2, pane.y, bar, pane.height), bars,
                cv::FILLED);
  cv::rectangle(canvas, cv::Rect(pane.x, pane.y + pane.height / 3, pane.width, bar), bars,
                cv::FILLED);
}

}  // namespace

void drawFacade(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  layStones(canvas, scale, random);
  const int pitch_x = elements(uniform(random, 46.0, 62.0), scale);
  const int pitch_y = elements(uniform(random, 54.0, 72.0), scale);
  const cv::Size size(pitch_x * 11 / 20, pitch_y * 12 / 20);
  for (int y = pitch_y / 5; y + size.height < canvas.rows; y += pitch_y) {
    for (int x = pitch_x / 5; x + size.width < canvas.cols; x += pitch_x) {
      setWindow(canvas, cv::Rect(cv::Point(x, y), size), scale, random);
    }
  }
  shade(fractalNoise(canvas.size(), 140.0 * scale, 2.5 * scale, random), 0.08, canvas);
}

}  // namespace fast_edi
