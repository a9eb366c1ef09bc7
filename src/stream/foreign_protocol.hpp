/// \file
/// Servers that speak something else than DV's streams without encryption.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace fast_edi {

/// Sent to a server that says nothing, before leaving it: one that waits for TLS answers with an
/// alert, which describeForeign() knows; DV's own servers do not read what clients send.
constexpr std::array<std::uint8_t, 6> kTlsProbe = {'\n', '\n', '\n', '\n', '\n', '\n'};

/// What the first bytes of a connection seem to be, for messages.
std::string describeForeign(std::string_view bytes);

}  // namespace fast_edi
