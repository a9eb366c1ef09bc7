#include "fast_edi/base/classic_locale.hpp"

namespace fast_edi {

// Without memory for it, printf goes on as before: uselocale() changes nothing for a null argument.

ClassicLocale::ClassicLocale()
    : classic_(newlocale(LC_ALL_MASK, "C", nullptr)), before_(uselocale(classic_)) {}

ClassicLocale::~ClassicLocale() {
  uselocale(before_);
  if (classic_ != nullptr) {
    freelocale(classic_);
  }
}

}  // namespace fast_edi
