/// \file
#pragma once

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {

using BagError = RecordingError;

}  // namespace fast_edi
