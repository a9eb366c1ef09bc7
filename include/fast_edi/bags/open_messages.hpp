/// \file
/// Opens a recording of any format, recognised by its content. Frames that a bag holds as
/// sensor_msgs/CompressedImage come decoded behind them.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// \param array_ns length of the event arrays of recordings that are no bag; 0: as they have them
/// \throws RecordingError naming the formats that are read, when it has none of them
std::unique_ptr<MessageSource> openMessages(const std::string& path, std::int64_t array_ns = 0);

/// Several recordings as one, in the order of their record times: what `rosbag record --split` made
/// of a long one.
/// \pre at least one path
/// \throws RecordingError
std::unique_ptr<MessageSource> openMessages(const std::vector<std::string>& paths,
                                            std::int64_t array_ns = 0);

/// For people: the only path, or the first one and how many follow.
std::string nameOf(const std::vector<std::string>& paths);

}  // namespace fast_edi
