/// \file
/// A locale with a decimal comma and points between thousands, for as long as an object lives: of
/// C++ streams by a facet of its own, of C functions by a locale of the system, where one such is
/// installed.
#pragma once

#include <clocale>
#include <iostream>
#include <locale>
#include <string>

namespace fast_edi::testing {

class CommaLocale {
 public:
  CommaLocale() : c_before_(std::setlocale(LC_ALL, nullptr)) {
    cpp_before_ = std::locale::global(std::locale(std::locale::classic(), new Punctuation));
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) {
        c_is_set_ = true;
        return;
      }
    }
    std::cout
        << "note: no locale with a decimal comma is installed, so that printf and strtod were "
           "not tried under one\n";
  }
  ~CommaLocale() {
    std::locale::global(cpp_before_);
    std::setlocale(LC_ALL, c_before_.c_str());
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  /// Whether printf and strtod follow it, too.
  bool cIsSet() const { return c_is_set_; }

 private:
  struct Punctuation : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };

  std::string c_before_;
  std::locale cpp_before_;
  bool c_is_set_ = false;
};

}  // namespace fast_edi::testing
