/// \file
#pragma once

#include <cstdint>

namespace fast_edi {

/// Queue of a topic of which the newest message says it all [messages].
constexpr std::uint32_t kLatestWins = 1;

}  // namespace fast_edi
