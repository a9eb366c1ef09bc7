#include "survey/finding.hpp"

#include <cstdarg>
#include <cstdio>

#include "fast_edi/base/classic_locale.hpp"

namespace fast_edi {

std::string instantName(ExposureInstant instant) {
  switch (instant) {
    case ExposureInstant::kStart:
      return "start";
    case ExposureInstant::kEnd:
      return "end";
    case ExposureInstant::kMid:
      break;
  }
  return "mid";
}

std::string textOf(const char* format, ...) {
  const ClassicLocale classic;
  std::va_list arguments;
  va_start(arguments, format);
  std::va_list again;
  va_copy(again, arguments);
  const int length = std::vsnprintf(nullptr, 0, format, arguments);
  va_end(arguments);
  std::string text(length > 0 ? static_cast<std::size_t>(length) : 0, '\0');
  std::vsnprintf(text.data(), text.size() + 1, format, again);
  va_end(again);
  return text;
}

}  // namespace fast_edi
