/// \file
#pragma once

#include <exception>
#include <string>

namespace fast_edi {

/// what() of the Error that \p call throws; empty when it throws none.
template <typename Error, typename Call>
std::string messageOf(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace fast_edi
