#include "fast_edi/bags/open_messages.hpp"

#include <utility>

#include "bags/compressed_frames.hpp"
#include "bags/joined_recordings.hpp"
#include "fast_edi/bags/bag_reader.hpp"
#include "fast_edi/bags/recording_messages.hpp"
#include "fast_edi/pictures/open_pictures.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {

std::unique_ptr<MessageSource> openMessages(const std::string& path, std::int64_t array_ns) {
  if (formatOf(path) == RecordingFormat::kRosbag) {
    return std::make_unique<CompressedFrames>(std::make_unique<BagReader>(path));
  }
  std::unique_ptr<Recording> recording = openRecordingOrPictures(path);
  if (!recording) {
    throw RecordingError(
        path +
        " is no bag, nor another recording that can be read: it begins neither with \"#ROSBAG "
        "V2.0\" (rosbag) nor with \"#!AER-DAT4.0\" (AEDAT4), \"#!AER-DAT3.1\" or "
        "\"#!AER-DAT2\", nor is it a folder with images.txt, frames.csv or Exposure_start.txt, "
        "nor a rosbag2 (ROS 2): a folder with *.db3 or *.mcap, or one such file, nor HDF5, nor a "
        "zip archive");
  }
  return std::make_unique<RecordingMessages>(std::move(recording), array_ns);
}

std::unique_ptr<MessageSource> openMessages(const std::vector<std::string>& paths,
                                            std::int64_t array_ns) {
  if (paths.size() == 1) {
    return openMessages(paths.front(), array_ns);
  }
  std::vector<JoinedRecordings::Part> parts;
  parts.reserve(paths.size());
  for (const std::string& path : paths) {
    parts.push_back({path, openMessages(path, array_ns)});
  }
  return std::make_unique<JoinedRecordings>(std::move(parts));
}

std::string nameOf(const std::vector<std::string>& paths) {
  return paths.size() == 1 ? paths.front()
                           : paths.front() + " and " + std::to_string(paths.size() - 1) + " more";
}

}  // namespace fast_edi
