/// \file
/// Opens a recording of any format, told by its content.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// \param array_ns length of the event arrays of recordings that are no bag; 0: as they have them
/// \throws RecordingError naming the formats that are read, when it has none of them
std::unique_ptr<MessageSource> openMessages(const std::string& path, std::int64_t array_ns = 0);

}  // namespace fast_edi
