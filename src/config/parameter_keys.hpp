/// \file
/// The one table of keys from which parsing, descriptions and the table of cfg/README.md come.
#pragma once

#include <vector>

#include "config/config_key.hpp"

namespace fast_edi {

/// Keys at the top level, in the order of cfg/README.md.
const std::vector<ConfigKey>& topLevelKeys();

/// Keys of the map `biases`.
std::vector<ConfigKey> biasKeys();

}  // namespace fast_edi
