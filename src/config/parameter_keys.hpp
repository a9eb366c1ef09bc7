/// \file
/// The one table of keys from which parsing, descriptions and README's table come.
#pragma once

#include <vector>

#include "config_key.hpp"

namespace fast_edi {

/// Keys at the top level, in README's order.
const std::vector<ConfigKey>& topLevelKeys();

/// Keys of the map `biases`.
std::vector<ConfigKey> biasKeys();

}  // namespace fast_edi
