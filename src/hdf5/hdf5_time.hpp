/// \file
/// Times as HDF5 files have them: numbers whose unit is seldom told.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fast_edi {

/// \param said the attribute `unit` or `units`; empty if there is none
/// \param is_whole the numbers' type is one for whole numbers
/// \param first the first time
/// \param last the last time
/// \return that unit; else microseconds for whole numbers and seconds for others, unless they would
///         lie beyond 2106 or last longer than eleven days [ns]
std::int64_t timeUnit(const std::string& said, bool is_whole, double first, double last);

/// Rounded to whole microseconds, the resolution of the sensors; nothing outside of isStamp().
std::optional<std::int64_t> timeOf(double time, std::int64_t unit_ns);

/// Nothing outside of isStamp().
std::optional<std::int64_t> timeOf(std::int64_t time, std::int64_t unit_ns);

}  // namespace fast_edi
