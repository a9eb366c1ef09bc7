/// \file
/// Servers that speak something else than DV's streams without encryption.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace fast_edi {

/// Sent to a server that says nothing, before leaving it: one that waits for TLS answers with an
/// alert, which describeForeign() knows; DV's own servers do not read what clients send. A record
/// of TLS 1.0 (type 22: handshake) with 5 bytes that are no greeting: OpenSSL leaves other bytes
/// unanswered.
constexpr std::array<std::uint8_t, 10> kTlsProbe = {22, 3, 1, 0, 5, 'h', 'e', 'l', 'l', 'o'};

/// What the first bytes of a connection seem to be, for messages.
std::string describeForeign(std::string_view bytes);

}  // namespace fast_edi
