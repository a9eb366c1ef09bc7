#include "window/tuning_window.hpp"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#include <opencv2/highgui.hpp>

namespace fast_edi {
namespace {

/// As X11 numbers them; highgui gives the first a number of its own.
constexpr int kTab = '\t';
constexpr int kBackTab = 0xfe20;
constexpr int kKeyBits = 0xffff;
/// Home, arrows, Page Up and Down, End.
constexpr int kFirstCursorKey = 0xff50;
constexpr int kLastCursorKey = 0xff57;

/// Keys by which GTK, too, moves the slider in focus: those that the tool wants for itself.
bool isStep(int key) {
  return key == '+' || key == '-' || key == '=';
}

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
    trackbars_.push_back({slider.name(), trackbars_.size(), 0, 0, this});
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
  report();
}

int TuningWindow::waitKey() {
  constexpr int kMoment_ms = 50;
  const int key = cv::waitKeyEx(kMoment_ms);
  const int plain = key == kNoKey ? kNoKey : key & kKeyBits;
  if (isStep(plain)) {
    putBack();
    return key;
  }
  const bool has_moved = report();
  const bool is_cursor = plain >= kFirstCursorKey && plain <= kLastCursorKey;
  return (has_moved && is_cursor) || plain == kTab || plain == kBackTab ? kNoKey : key;
}

bool TuningWindow::report() {
  bool moved = false;
  for (Trackbar& trackbar : trackbars_) {
    if (trackbar.now != trackbar.position) {
      trackbar.position = trackbar.now;
      moved_(trackbar.slider, trackbar.now);
      moved = true;
    }
  }
  return moved;
}

void TuningWindow::putBack() {
  for (const Trackbar& trackbar : trackbars_) {
    if (trackbar.now != trackbar.position) {
      cv::setTrackbarPos(trackbar.name, name_, trackbar.position);
    }
  }
}

bool TuningWindow::isOpen() const {
  return cv::getWindowProperty(name_, cv::WND_PROP_AUTOSIZE) >= 0.0;
}

void TuningWindow::trackbarMoved(int position, void* trackbar) {
  static_cast<Trackbar*>(trackbar)->now = position;
}

}  // namespace fast_edi
