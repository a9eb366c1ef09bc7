/// \file
/// Sizes of cameras by the names that recordings give them.
#pragma once

#include <optional>
#include <string>

#include "fast_edi/base/types.hpp"

namespace fast_edi {

/// "eu.seebetter.ini.chips.davis.DAVIS240C", "DAVIS346B", ...; nothing for other cameras.
std::optional<SensorSize> davisSize(const std::string& name);

}  // namespace fast_edi
