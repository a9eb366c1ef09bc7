#include "evaluation/method_options.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include "evaluation/method_comparison.hpp"

namespace fast_edi {

NamedFile namedFile(const std::string& option, const std::string& text,
                    std::vector<std::string>& taken) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size()) {
    throw std::invalid_argument(option + ": expected NAME=FILE, got \"" + text + "\"");
  }
  NamedFile named = {text.substr(0, equals), text.substr(equals + 1)};
  if (named.name.find_first_of("|,\"\r\n") != std::string::npos) {
    throw std::invalid_argument(
        option + ": expected a name without | , \" and line breaks, got \"" + named.name + "\"");
  }
  if (std::find(taken.begin(), taken.end(), named.name) != taken.end()) {
    throw std::invalid_argument(option + ": there is a column \"" + named.name +
                                "\" already, expected another name");
  }
  taken.push_back(named.name);
  return named;
}

std::vector<std::string> methodNames() {
  std::vector<std::string> names;
  for (const Method method : kAllMethods) {
    names.emplace_back(toString(method));
  }
  return names;
}

RecordedTopic recordedTopic(const std::string& text, const std::string& topic) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || std::filesystem::exists(text)) {
    return {text, topic};
  }
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace fast_edi
