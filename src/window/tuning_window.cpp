#include "window/tuning_window.hpp"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <opencv2/highgui.hpp>

namespace fast_edi {
namespace {

bool isSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

}  // namespace

void requireDisplay() {
  if (!isSet("DISPLAY") && !isSet("WAYLAND_DISPLAY")) {
    throw std::runtime_error(
        "no display to open a window on: DISPLAY is not set, expected e.g. :0 (start this on a "
        "desktop, "
        "or log in by ssh -X), or --screenshot FILE.png, which needs none");
  }
}

TuningWindow::TuningWindow(std::string name, const std::vector<Slider>& sliders, Moved moved)
    : name_(std::move(name)), moved_(std::move(moved)) {
  cv::namedWindow(name_, cv::WINDOW_AUTOSIZE | cv::WINDOW_GUI_NORMAL);
  trackbars_.reserve(sliders.size());
  for (const Slider& slider : sliders) {
    trackbars_.push_back({slider.name(), trackbars_.size(), this});
    cv::createTrackbar(slider.name(), name_, nullptr, slider.lastPosition(), trackbarMoved,
                       &trackbars_.back());
  }
}

TuningWindow::~TuningWindow() {
  if (isOpen()) {
    cv::destroyWindow(name_);
  }
}

void TuningWindow::show(const cv::Mat& picture, const std::string& title) {
  cv::imshow(name_, picture);
  cv::setWindowTitle(name_, title);
}

void TuningWindow::moveSlider(std::size_t slider, int position) {
  cv::setTrackbarPos(trackbars_[slider].name, name_, position);
}

int TuningWindow::waitKey() {
  constexpr int kMoment_ms = 50;
  return cv::waitKeyEx(kMoment_ms);
}

bool TuningWindow::isOpen() const {
  return cv::getWindowProperty(name_, cv::WND_PROP_AUTOSIZE) >= 0.0;
}

void TuningWindow::trackbarMoved(int position, void* trackbar) {
  const auto* moved = static_cast<const Trackbar*>(trackbar);
  moved->window->moved_(moved->slider, position);
}

}  // namespace fast_edi
