#include "fast_edi/bags/open_messages.hpp"

#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/recording_messages.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {

std::unique_ptr<MessageSource> openMessages(const std::string& path, std::int64_t array_ns) {
  if (formatOf(path) == RecordingFormat::kRosbag) {
    return std::make_unique<BagReader>(path);
  }
  std::unique_ptr<Recording> recording = openRecording(path);
  if (!recording) {
    throw RecordingError(
        path +
        " is no bag, nor another recording that can be read: expected \"#ROSBAG V2.0\" (rosbag) or "
        "\"#!AER-DAT4.0\" (AEDAT4) at its begin, or a rosbag2 (ROS 2): a folder with *.db3 or "
        "*.mcap, or one such file");
  }
  return std::make_unique<RecordingMessages>(std::move(recording), array_ns);
}

}  // namespace fast_edi
