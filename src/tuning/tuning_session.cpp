#include "tuning/tuning_session.hpp"

#include <algorithm>
#include <utility>

namespace fast_edi {
namespace {

constexpr int kEscape = 27;
/// As X11 numbers them, which GTK and Qt pass on.
constexpr int kLeft = 0xff51;
constexpr int kRight = 0xff53;
/// waitKeyEx() adds the keys that are held, such as Num Lock, above these bits.
constexpr int kKeyBits = 0xffff;
constexpr int kLargeStep = 10;

}  // namespace

TuningSession::TuningSession(TunedParameters parameters, std::vector<Slider> sliders,
                             std::size_t frames, std::size_t frame)
    : parameters_(std::move(parameters)),
      sliders_(std::move(sliders)),
      frames_(frames),
      frame_(frame) {
  for (const Slider& slider : sliders_) {
    start_values_.push_back(parameters_.value(slider.name()));
    positions_.push_back(slider.position(start_values_.back()));
  }
}

double TuningSession::value(std::size_t slider) const {
  return parameters_.value(sliders_[slider].name());
}

TuningEffect TuningSession::press(int key) {
  message_.clear();
  switch (key & kKeyBits) {
    case 'n':
    case kRight:
      return goTo(frame_ + 1 < frames_ ? std::optional(frame_ + 1) : std::nullopt,
                  "this is the last frame");
    case 'p':
    case kLeft:
      return goTo(frame_ > 0 ? std::optional(frame_ - 1) : std::nullopt, "this is the first frame");
    case 'j':
      chosen_ = std::min(chosen_ + 1, sliders_.size() - 1);
      return TuningEffect::kRedraw;
    case 'k':
      chosen_ -= chosen_ > 0 ? 1 : 0;
      return TuningEffect::kRedraw;
    case '+':
    case '=':  // the same key without Shift
      return step(1);
    case '-':
      return step(-1);
    case '>':
    case '.':
      return step(kLargeStep);
    case '<':
    case ',':
      return step(-kLargeStep);
    case '0':
      return reset();
    case 's':
      return TuningEffect::kSave;
    case 'h':
    case '?':
      help_ = !help_;
      return TuningEffect::kRedraw;
    case 'q':
    case kEscape:
      return TuningEffect::kEnd;
    default:
      message_ = "h shows the keys";
      return TuningEffect::kRedraw;
  }
}

TuningEffect TuningSession::moveSlider(std::size_t slider, int position) {
  const int within = std::clamp(position, 0, sliders_[slider].lastPosition());
  if (within == positions_[slider]) {
    return TuningEffect::kNone;
  }
  chosen_ = slider;
  message_ = parameters_.set(sliders_[slider].name(), sliders_[slider].value(within));
  if (!message_.empty()) {
    return TuningEffect::kRedraw;
  }
  positions_[slider] = within;
  return TuningEffect::kDeblur;
}

TuningEffect TuningSession::goTo(std::optional<std::size_t> frame, const char* otherwise) {
  if (!frame) {
    message_ = otherwise;
    return TuningEffect::kRedraw;
  }
  frame_ = *frame;
  return TuningEffect::kDeblur;
}

TuningEffect TuningSession::step(int steps) {
  const TuningEffect effect = moveSlider(chosen_, positions_[chosen_] + steps);
  return effect == TuningEffect::kDeblur ? TuningEffect::kMarks : effect;
}

TuningEffect TuningSession::reset() {
  message_ = parameters_.set(sliders_[chosen_].name(), start_values_[chosen_]);
  positions_[chosen_] = sliders_[chosen_].position(start_values_[chosen_]);
  return TuningEffect::kMarks;
}

}  // namespace fast_edi
