/// \file
/// Values of a diagnostic status, written the same under every locale (diagnostic_updater's own
/// methods follow it).
#pragma once

#include <cstdint>
#include <string>

#include <diagnostic_updater/DiagnosticStatusWrapper.h>

#include "fast_edi/base/classic_locale.hpp"

namespace fast_edi {

class StatusValues {
 public:
  explicit StatusValues(diagnostic_updater::DiagnosticStatusWrapper& status) : status_(status) {}

  void add(const std::string& name, const std::string& value) { status_.add(name, value); }
  void add(const std::string& name, std::uint64_t value) {
    status_.add(name, std::to_string(value));
  }
  void addf(const std::string& name, const char* format, double value) {
    const ClassicLocale classic;
    status_.addf(name, format, value);
  }

 private:
  diagnostic_updater::DiagnosticStatusWrapper& status_;
};

}  // namespace fast_edi
