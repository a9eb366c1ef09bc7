/// \file
#pragma once

#include <string>

namespace fast_edi {
namespace test {

/// A port that nobody listens on, for a master of the test's own.
std::string freePort();

}  // namespace test
}  // namespace fast_edi
