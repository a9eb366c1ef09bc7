/// \file
/// `tune`: parameters by eye. A frame of a recording, deblurred again with each change of a slider.

#include <cstddef>
#include <iostream>
#include <stdexcept>
#include <string>

#include <opencv2/imgcodecs.hpp>

#include "command_line.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "tools/tune/tune_arguments.hpp"
#include "tools/tune/tune_result.hpp"
#include "tools/tune/tune_start.hpp"
#include "tools/tune/tune_view.hpp"
#include "tuning/tuning_picture.hpp"
#include "tuning/tuning_session.hpp"
#include "tuning/tuning_sliders.hpp"
#include "window/tuning_window.hpp"

namespace fast_edi::tune {
namespace {

constexpr char kTitle[] = "fast_edi tune";

/// \return the configuration that was saved last, empty if none was
std::string runWindow(const Arguments& arguments, TuningSession& session, View& view) {
  std::string saved;
  TuningEffect pending = TuningEffect::kDeblur;
  TuningWindow window(kTitle, session.sliders(), [&](std::size_t slider, int position) {
    const TuningEffect effect = session.moveSlider(slider, position);
    pending = effect == TuningEffect::kNone ? pending : effect;
  });
  const auto place_sliders = [&] {
    for (std::size_t i = 0; i < session.sliders().size(); ++i) {
      window.moveSlider(i, session.position(i));
    }
  };
  place_sliders();
  while (window.isOpen()) {
    if (pending == TuningEffect::kDeblur) {
      view.update(session);
    }
    if (pending != TuningEffect::kNone) {
      window.show(view.draw(session), kTitle + (": " + tuningTitle(session)));
      pending = TuningEffect::kNone;
    }
    const int key = window.waitKey();
    if (key == TuningWindow::kNoKey) {
      continue;
    }
    const TuningEffect effect = session.press(key);
    switch (effect) {
      case TuningEffect::kEnd:
        return saved;
      case TuningEffect::kSave:
        if (save(arguments, session)) {
          saved = configurationText(session);
        }
        pending = TuningEffect::kRedraw;
        break;
      case TuningEffect::kMarks:
        place_sliders();
        pending = TuningEffect::kDeblur;
        break;
      case TuningEffect::kNone:
      case TuningEffect::kRedraw:
      case TuningEffect::kDeblur:
        pending = effect;
        break;
    }
  }
  return saved;
}

int run(const Arguments& arguments) {
  if (arguments.screenshot.empty()) {
    tools::requireFree(arguments.save, arguments.overwrite);
    requireDisplay();
  } else {
    tools::requireFree(arguments.screenshot, arguments.overwrite);
  }
  const Start start = startOf(arguments);
  const std::size_t frames = start.exposures_us.size();
  const std::size_t frame = arguments.frame.value_or(start.busiest_frame);
  if (frame >= frames) {
    throw std::runtime_error(nameOf(arguments.recordings) +
                             (frames == 0 ? " has no frames on " + start.topics.image
                                          : ": --frame " + std::to_string(frame) +
                                                ", expected 0.." + std::to_string(frames - 1)));
  }
  TuningSession session(TunedParameters(arguments.config, start.overrides, start.loaded),
                        tuningSliders(start.ranges), frames, frame);
  View view(arguments, start);
  std::string saved;
  if (arguments.screenshot.empty()) {
    saved = runWindow(arguments, session, view);
  } else {
    view.update(session);
    if (!cv::imwrite(arguments.screenshot, view.draw(session))) {
      throw std::runtime_error("cannot write " + arguments.screenshot);
    }
    std::cout << "written: " << arguments.screenshot << "\n";
  }
  printCommand(arguments, start, session, saved);
  return tools::kDone;
}

}  // namespace
}  // namespace fast_edi::tune

int main(int argc, char** argv) {
  return fast_edi::tools::runTool("tune", [argc, argv] {
    fast_edi::tune::Arguments arguments;
    return fast_edi::tune::parseArguments(argc, argv, arguments) ? fast_edi::tune::run(arguments)
                                                                 : fast_edi::tools::kDone;
  });
}
