/// \file
/// For printf and its relatives, which write numbers as the locale of the process says.
#pragma once

#include <clocale>

namespace fast_edi {

/// While it lives, C functions of this thread write and read numbers as in the locale "C".
class ClassicLocale {
 public:
  ClassicLocale();
  ~ClassicLocale();
  ClassicLocale(const ClassicLocale&) = delete;
  ClassicLocale& operator=(const ClassicLocale&) = delete;

 private:
  locale_t classic_;
  locale_t before_;
};

}  // namespace fast_edi
