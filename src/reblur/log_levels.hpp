/// \file
/// Grey levels as log intensities, as the motion and the map of trust compare them with events.
#pragma once

#include <cstddef>

namespace fast_edi {

/// log(max(level, 0) + offset + a little), which keeps the log of dark levels meaningful.
/// \param level \p count grey levels [8-bit DN]
/// \param offset_dn of the camera's response (see CameraResponse::offsetDn())
/// \param log natural log of each; must not overlap \p level
void logLevels(const float* level, std::size_t count, float offset_dn, float* log);

}  // namespace fast_edi
