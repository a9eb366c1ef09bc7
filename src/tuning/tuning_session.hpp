/// \file
/// What keys and sliders do: which frame is shown, with which parameters. Without a window.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tuning/slider.hpp"
#include "tuning/tuned_parameters.hpp"

namespace fast_edi {

/// What has to be done after a key or a slider.
enum class TuningEffect {
  kNone,
  kRedraw,  ///< the picture, of the same frame
  kMarks,   ///< sliders were moved by a key: the window's own, too; and kDeblur
  kDeblur,  ///< the frame, and the picture of it
  kSave,    ///< the parameters
  kEnd,
};

/// A line of the help: keys, and what they do.
struct TuningKey {
  const char* keys;
  const char* what;
};

/// All keys, for the picture and the tool's help.
constexpr std::array<TuningKey, 8> kTuningKeys{{
    {"n, p", "next, previous frame (also the arrow keys)"},
    {"j, k", "choose the slider below, above"},
    {"+, -", "move it by one step"},
    {">, <", "move it by ten steps"},
    {"0", "put it back to where it started"},
    {"s", "save the parameters"},
    {"h", "show these keys, or not"},
    {"q, Esc", "end"},
}};

class TuningSession {
 public:
  /// \param frames in the recording, at least one
  /// \param frame to begin with, below \p frames
  TuningSession(TunedParameters parameters, std::vector<Slider> sliders, std::size_t frames,
                std::size_t frame);

  /// \param key as cv::waitKeyEx() returns it
  TuningEffect press(int key);
  /// \param slider below sliders().size()
  TuningEffect moveSlider(std::size_t slider, int position);

  std::size_t frame() const { return frame_; }
  std::size_t frames() const { return frames_; }
  const TunedParameters& parameters() const { return parameters_; }
  const std::vector<Slider>& sliders() const { return sliders_; }
  /// The one that keys move.
  std::size_t chosenSlider() const { return chosen_; }
  int position(std::size_t slider) const { return positions_[slider]; }
  /// Where the tuning started.
  double startValue(std::size_t slider) const { return start_values_[slider]; }
  double value(std::size_t slider) const;
  bool showsHelp() const { return help_; }

  /// For people, in the picture until the next key; what was refused, or done.
  const std::string& message() const { return message_; }
  void setMessage(const std::string& message) { message_ = message; }

 private:
  TuningEffect goTo(std::optional<std::size_t> frame, const char* otherwise);
  TuningEffect step(int steps);
  TuningEffect reset();

  TunedParameters parameters_;
  const std::vector<Slider> sliders_;
  const std::size_t frames_;
  std::size_t frame_;
  std::vector<int> positions_;
  std::vector<double> start_values_;
  std::size_t chosen_ = 0;
  bool help_ = false;
  std::string message_;
};

}  // namespace fast_edi
