#include "measures/frame_choice.hpp"

#include <algorithm>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace fast_edi {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  throw std::invalid_argument(
      "frames: expected numbers from 1 on and ranges such as 3-5,9, got \"" + text + "\"");
}

}  // namespace

FrameChoice::FrameChoice(const std::string& text) {
  const std::regex range("([0-9]{1,9})(-([0-9]{1,9}))?");
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    std::smatch match;
    if (!std::regex_match(part, match, range)) {
      refuse(text);
    }
    const int first = std::stoi(match[1]);
    const int last = match[3].matched ? std::stoi(match[3]) : first;
    if (first < 1 || last < first) {
      refuse(text);
    }
    ranges_.emplace_back(first, last);
  }
  if (ranges_.empty() || text.back() == ',') {
    refuse(text);
  }
}

bool FrameChoice::contains(int number) const {
  return ranges_.empty() ||
         std::any_of(ranges_.begin(), ranges_.end(), [number](const auto& range) {
           return range.first <= number && number <= range.second;
         });
}

}  // namespace fast_edi
