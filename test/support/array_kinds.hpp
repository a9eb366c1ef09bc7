/// \file
/// Large event arrays of every kind that should cost no more than a regular one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"

namespace fast_edi::testing {

enum class ArrayKind {
  kRegular,       ///< random pixels, times that increase by a few nanoseconds
  kFalling,       ///< each event 1 s before the last
  kFallingTeeth,  ///< increasing times that fall by 1 s every hundred events
  kLate,          ///< each event 1 us before the last
  kAlternating,   ///< every other event 1 s before its neighbours
  kRepeated,      ///< one time
  kFarAhead,      ///< each event 20 s after the last
  kStrays,        ///< every other event 20 s ahead of its neighbours
  kOnePixel,      ///< regular, but for the pixel
  kOutside,       ///< regular, but not on the sensor
};
constexpr std::size_t kArrayKindCount = 10;
const char* toString(ArrayKind kind);

/// \param start_ns time of the first event; those of most kinds stay within 2 s of it, kFalling
///        and kFarAhead go as far as \p count takes them
/// \return wire records
/// \pre no time is below 0 or above 2^32 s
std::vector<std::uint8_t> makeArray(ArrayKind kind, SensorSize size, std::size_t count,
                                    std::int64_t start_ns);

}  // namespace fast_edi::testing
