#include "fast_edi/pictures/open_pictures.hpp"

#include <filesystem>

#include "fast_edi/pictures/picture_folder_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "pictures/frame_list.hpp"

namespace fast_edi {

std::unique_ptr<Recording> openRecordingOrPictures(const std::string& path) {
  std::error_code ignored;  // what does not exist is no folder
  if (std::filesystem::is_directory(path, ignored) && hasFrameList(path)) {
    return openPictureFolder(path);
  }
  return openRecording(path);
}

}  // namespace fast_edi
