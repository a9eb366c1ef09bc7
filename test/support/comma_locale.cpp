#include "support/comma_locale.hpp"

#include <clocale>
#include <cstdlib>
#include <iostream>

namespace fast_edi::testing {
namespace {

struct Punctuation : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

/// One that was made with the tests.
bool setMadeLocale(const char* name) {
#ifdef FAST_EDI_COMMA_LOCALES
  ::setenv("LOCPATH", FAST_EDI_COMMA_LOCALES, 1);
  const bool is_set = std::setlocale(LC_ALL, name) != nullptr;
  ::unsetenv("LOCPATH");  // it would hide those of the system
  return is_set;
#else
  static_cast<void>(name);
  return false;
#endif
}

}  // namespace

CommaLocale::CommaLocale() : c_before_(std::setlocale(LC_ALL, nullptr)) {
  cpp_before_ = std::locale::global(std::locale(std::locale::classic(), new Punctuation));
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "fr_FR.utf8"}) {
    if (setMadeLocale(name) || std::setlocale(LC_ALL, name) != nullptr) {
      c_is_set_ = true;
      return;
    }
  }
  std::cout << "note: there is no locale with a decimal comma (Debian's package locales has what "
               "one is made of), so that printf and strtod were not tried under one\n";
}

CommaLocale::~CommaLocale() {
  std::locale::global(cpp_before_);
  std::setlocale(LC_ALL, c_before_.c_str());
}

}  // namespace fast_edi::testing
