#include "fast_edi/pictures/open_pictures.hpp"

#include <filesystem>

#include "fast_edi/hdf5/hdf5_reader.hpp"
#include "fast_edi/pictures/picture_folder_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/rosbag2_reader.hpp"
#include "pictures/frame_list.hpp"
#include "pictures/picture.hpp"
#include "recording/file_set.hpp"

namespace fast_edi {

std::unique_ptr<Recording> openRecordingOrPictures(const std::string& path) {
  std::error_code ignored;  // what does not exist is no folder
  if (std::filesystem::is_directory(path, ignored) && hasFrameList(*openFolder(path))) {
    return openPictureFolder(path);
  }
  switch (formatOf(path)) {
    case RecordingFormat::kHdf5:
      return openHdf5(path);
    case RecordingFormat::kRosbag2:
      return openRosbag2(path, decodeCompressed);
    case RecordingFormat::kZip:
      return openPictureArchive(path);
    default:
      return openRecording(path);
  }
}

}  // namespace fast_edi
