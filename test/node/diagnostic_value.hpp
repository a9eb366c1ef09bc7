/// \file
/// Reads one entry of a diagnostics status.
#pragma once

#include <string>

#include <diagnostic_msgs/DiagnosticStatus.h>

namespace fast_edi {
namespace testing {

/// \return the value of \p key, or a text that says there is none
inline std::string value(const diagnostic_msgs::DiagnosticStatus& status, const std::string& key) {
  for (const diagnostic_msgs::KeyValue& entry : status.values) {
    if (entry.key == key) {
      return entry.value;
    }
  }
  return "no value " + key;
}

}  // namespace testing
}  // namespace fast_edi
