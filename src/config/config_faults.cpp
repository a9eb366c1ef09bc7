#include "config/config_faults.hpp"

#include <sstream>

namespace fast_edi {
namespace {

constexpr char kOverrides[] = "key:=value";

}  // namespace

void ConfigFaults::add(const YAML::Node& where, const std::string& text) {
  std::string place = file_;
  if (!file_.empty() && where.IsDefined()) {
    // Values that replace those of the file stand in no line of it.
    const YAML::Mark mark = where.Mark();
    place = mark.is_null() ? kOverrides : file_ + ":" + std::to_string(mark.line + 1);
  }
  if (!place.empty()) {
    place += ": ";
  }
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    lines_.push_back(place + line);
  }
}

void ConfigFaults::append(const ConfigFaults& others) {
  lines_.insert(lines_.end(), others.lines_.begin(), others.lines_.end());
}

std::string ConfigFaults::text() const {
  std::string text;
  for (const std::string& line : lines_) {
    text += (text.empty() ? "" : "\n") + line;
  }
  return text;
}

}  // namespace fast_edi
