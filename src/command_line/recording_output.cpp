#include "recording_output.hpp"

#include <filesystem>
#include <stdexcept>

#include "fast_edi/hdf5/hdf5_writer.hpp"
#include "fast_edi/recording/aedat4_writer.hpp"

namespace fast_edi::tools {
namespace {

std::string endingOf(const std::string& path) {
  return std::filesystem::path(path).extension().string();
}

bool isHdf5(const std::string& path) {
  return endingOf(path) == ".h5" || endingOf(path) == ".hdf5";
}

[[noreturn]] void refuse(const std::string& compression, const char* expected) {
  throw std::invalid_argument("--compression " + compression + ": expected " + expected);
}

Aedat4Compression aedat4Compression(const std::string& name) {
  if (name == "none") {
    return Aedat4Compression::kNone;
  }
  if (name == "lz4" || name.empty()) {
    return Aedat4Compression::kLz4;
  }
  if (name != "zstd") {
    refuse(name, "none, lz4 or zstd for AEDAT4");
  }
  return Aedat4Compression::kZstd;
}

Hdf5Compression hdf5Compression(const std::string& name) {
  if (name == "none") {
    return Hdf5Compression::kNone;
  }
  if (name != "gzip" && !name.empty()) {
    refuse(name, "none or gzip for HDF5");
  }
  return Hdf5Compression::kGzip;
}

}  // namespace

bool isRecordingOutput(const std::string& path) {
  return endingOf(path) == ".aedat4" || isHdf5(path);
}

void checkCompression(const std::string& path, const std::string& compression) {
  if (isHdf5(path)) {
    hdf5Compression(compression);
  } else {
    aedat4Compression(compression);
  }
}

std::unique_ptr<RecordingWriter> makeRecordingWriter(const std::string& path,
                                                     const std::vector<RecordedStream>& streams,
                                                     const std::string& compression,
                                                     bool overwrite) {
  if (isHdf5(path)) {
    return std::make_unique<Hdf5Writer>(path, streams, hdf5Compression(compression), overwrite);
  }
  return std::make_unique<Aedat4Writer>(path, streams, aedat4Compression(compression), overwrite);
}

}  // namespace fast_edi::tools
