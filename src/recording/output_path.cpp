#include "recording/output_path.hpp"

#include <filesystem>
#include <system_error>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

}  // namespace

OutputPath::OutputPath(const std::string& path, bool overwrite)
    : path_(path), active_(path + ".active") {
  for (const std::string& output : {path_, active_}) {
    if (fs::is_directory(output)) {
      throw RecordingError("cannot write " + output + ": it is a directory");
    }
    if (!overwrite && fs::exists(output)) {
      throw RecordingError("cannot write " + output + ": it exists already (--force replaces it)");
    }
  }
  // A device or a pipe would give its name to the output.
  if (fs::exists(path_) && !fs::is_regular_file(path_)) {
    throw RecordingError("cannot write " + path_ + ": it is no regular file");
  }
}

void OutputPath::complete() const {
  std::error_code error;
  fs::rename(active_, path_, error);
  if (error) {
    throw RecordingError("cannot rename " + active_ + " to " + path_ + ": " + error.message());
  }
}

}  // namespace fast_edi
