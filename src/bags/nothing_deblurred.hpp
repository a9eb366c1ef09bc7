/// \file
/// Why a run deblurred nothing, and what to do.
#pragma once

#include <string>

#include "fast_edi/base/deblur_counters.hpp"

namespace fast_edi {

/// One line for people: that no frame was deblurred, what most of them were passed through for, and
/// what to do; empty when one was deblurred, or when passing through was asked for.
/// \param clocks see DeblurStatus::differing_clocks
std::string nothingDeblurred(const DeblurCounters& counters, const ClockPair& clocks);

}  // namespace fast_edi
