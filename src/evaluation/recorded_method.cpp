#include "evaluation/recorded_method.hpp"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fast_edi/base/sensor_size.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kListedStamps = 10;

std::string secondsText(std::int64_t stamp_ns) {
  constexpr int kNanosecondDigits = 9;
  std::ostringstream text;
  text << stamp_ns / kNanosecondsPerSecond << "." << std::setw(kNanosecondDigits)
       << std::setfill('0') << stamp_ns % kNanosecondsPerSecond;
  return text.str();
}

}  // namespace

RecordedMethod::RecordedMethod(std::string name, std::string source, FramesByStamp frames)
    : name_(std::move(name)), source_(std::move(source)), frames_(std::move(frames)) {}

OtherMethod::Result RecordedMethod::deblur(const Frame& frame) {
  auto found = frameAt(frames_, frame.stamp_ns);
  if (found == frames_.end()) {
    found = frameAt(frames_, frame.input_stamp_ns);
  }
  if (found == frames_.end()) {
    missing_.push_back(frame.stamp_ns);
    return {};
  }
  const cv::Mat& image = found->second;
  if (image.size() != frame.blurry.size()) {
    throw std::runtime_error(
        name_ + ": " + source_ + ": the frame at " + secondsText(found->first) + " s is " +
        (image.empty() ? "of an encoding that is not known" : sizeText(image.cols, image.rows)) +
        ", expected " + sizeText(frame.blurry.cols, frame.blurry.rows) + " as the input");
  }
  used_.insert(found->first);
  return {image, 0.0};
}

std::vector<std::string> RecordedMethod::notes() const {
  std::vector<std::string> notes;
  if (!missing_.empty()) {
    std::string text = name_ + ": no frame in " + source_ + " at";
    const std::size_t listed = std::min(kListedStamps, missing_.size());
    for (std::size_t i = 0; i < listed; ++i) {
      text += (i == 0 ? " " : ", ") + secondsText(missing_[i]) + " s";
    }
    if (listed < missing_.size()) {
      text += " and " + std::to_string(missing_.size() - listed) + " more";
    }
    notes.push_back(text + ": its means leave them out");
  }
  if (used_.size() < frames_.size()) {
    notes.push_back(name_ + ": " + std::to_string(frames_.size() - used_.size()) + " of " +
                    std::to_string(frames_.size()) + " frames in " + source_ +
                    " belong to no frame that was scored");
  }
  return notes;
}

}  // namespace fast_edi
