/// \file
/// The window of a tuning, by OpenCV's highgui: a picture, sliders, keys.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "tuning/slider.hpp"

namespace fast_edi {

/// \throws std::runtime_error that says what to do, when no display is named in the environment
void requireDisplay();

class TuningWindow {
 public:
  /// Called from within waitKey(), and from moveSlider() with another position.
  using Moved = std::function<void(std::size_t slider, int position)>;

  /// \throws cv::Exception when no window can be made
  TuningWindow(std::string name, const std::vector<Slider>& sliders, Moved moved);
  ~TuningWindow();
  TuningWindow(const TuningWindow&) = delete;
  TuningWindow& operator=(const TuningWindow&) = delete;

  void show(const cv::Mat& picture, const std::string& title);
  void moveSlider(std::size_t slider, int position);
  /// Gives the window its time, until a key comes or for a moment. What the keyboard does to the
  /// slider in focus (Tab, arrows) is no key, while + and - are keys and nothing else, as with
  /// highgui's Qt; with GTK, both get each key.
  /// \return the key as cv::waitKeyEx() has it, or kNoKey
  int waitKey();
  static constexpr int kNoKey = -1;
  /// False once the user has closed it.
  bool isOpen() const;

 private:
  struct Trackbar {
    std::string name;
    std::size_t slider = 0;
    int position = 0;  ///< as far as Moved knows
    int now = 0;
    TuningWindow* window = nullptr;
  };
  static void trackbarMoved(int position, void* trackbar);
  /// Tells of the sliders that have moved.
  bool report();
  void putBack();

  const std::string name_;
  const Moved moved_;
  std::vector<Trackbar> trackbars_;  ///< highgui points to them
};

}  // namespace fast_edi
