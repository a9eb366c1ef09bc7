/// \file
/// What this build of the evaluation library can compute. Some measures need a library that not
/// every distribution ships; the build takes what it finds, and says here what it did not find.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace fast_edi {

/// Libraries that the evaluation uses when the build finds them.
enum class OptionalLibrary {
  kOpencvQuality,  ///< SSIM, BRISQUE
  kDlib,           ///< SURF
  kLibsvm,         ///< SSEQ
};

/// Thrown by a measure whose library was not found at build time. what() names both.
class UnavailableError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

bool isAvailable(OptionalLibrary library);
/// Name for people, with Debian's package: "dlib (libdlib-dev)".
const char* toString(OptionalLibrary library);
/// \throws UnavailableError "<measure> needs <library>, which was not found when this was built"
void require(OptionalLibrary library, const std::string& measure);

}  // namespace fast_edi
