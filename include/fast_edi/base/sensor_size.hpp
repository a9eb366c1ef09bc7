/// \file
/// The largest sensor that the pipeline takes, and sizes as text for messages.
#pragma once

#include <string>

namespace fast_edi {

/// Width and height are at most that: pixel indices are computed with signed 16-bit arithmetic.
constexpr int kMaxSide_px = 32'767;

/// For people: "346x260".
inline std::string sizeText(long long width, long long height) {
  return std::to_string(width) + "x" + std::to_string(height);
}

}  // namespace fast_edi
