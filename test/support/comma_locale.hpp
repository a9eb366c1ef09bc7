/// \file
/// A locale with a decimal comma and points between thousands, for as long as an object lives: of
/// C++ streams by a facet of its own, of C functions by a locale that was made with the tests, or
/// one of the system.
#pragma once

#include <locale>
#include <string>

namespace fast_edi::testing {

class CommaLocale {
 public:
  CommaLocale();
  ~CommaLocale();
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  /// Whether printf and strtod follow it, too.
  bool cIsSet() const { return c_is_set_; }

 private:
  std::string c_before_;
  std::locale cpp_before_;
  bool c_is_set_ = false;
};

}  // namespace fast_edi::testing
