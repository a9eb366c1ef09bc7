/// \file
/// The unit in which Python states times (`time_unit`).
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi::python {

/// Of all times, in units of \p unit_ns.
constexpr std::int64_t lastTime(std::int64_t unit_ns) {
  return kLastStamp_ns / unit_ns;
}

/// What is expected of a time, for messages. \param unit_ns 1 or 1000
inline std::string expectedTime(std::int64_t unit_ns) {
  return "0.." + std::to_string(lastTime(unit_ns)) + " (time_unit is '" +
         (unit_ns == 1 ? "ns" : "us") + "')";
}

}  // namespace fast_edi::python
