#include "bags/chunk_compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>

#include <cstdint>
#include <limits>

#include "fast_edi/bags/bag_error.hpp"

namespace fast_edi {
namespace {

// As rosbag sets them.
constexpr int kBz2BlockSize = 9;  ///< 900 kB
constexpr int kBz2WorkFactor = 30;

std::string compressBz2(std::string_view data) {
  // By the manual of libbz2: 1 % more than the input, and 600 bytes.
  constexpr std::size_t kMargin = 600;
  constexpr std::size_t kShareOfGrowth = 100;
  const std::size_t most = data.size() + data.size() / kShareOfGrowth + kMargin;
  if (most > std::numeric_limits<unsigned>::max()) {
    throw BagError("a chunk of " + std::to_string(data.size()) + " bytes is too large for bz2");
  }
  std::string compressed(most, '\0');
  auto size = static_cast<unsigned>(most);
  const int result = BZ2_bzBuffToBuffCompress(
      compressed.data(), &size, const_cast<char*>(data.data()), static_cast<unsigned>(data.size()),
      kBz2BlockSize, 0, kBz2WorkFactor);
  if (result != BZ_OK) {
    throw BagError("bz2 failed with code " + std::to_string(result));
  }
  compressed.resize(size);
  return compressed;
}

std::string compressLz4(std::string_view data) {
  LZ4F_preferences_t preferences = {};
  preferences.frameInfo.blockSizeID = LZ4F_max1MB;
  preferences.frameInfo.blockMode = LZ4F_blockIndependent;
  preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  std::string compressed(LZ4F_compressFrameBound(data.size(), &preferences), '\0');
  const std::size_t size = LZ4F_compressFrame(compressed.data(), compressed.size(), data.data(),
                                              data.size(), &preferences);
  if (LZ4F_isError(size)) {
    throw BagError(std::string("lz4 failed: ") + LZ4F_getErrorName(size));
  }
  compressed.resize(size);
  return compressed;
}

}  // namespace

std::string compressChunk(std::string_view compression, std::string_view data) {
  return compression == "bz2" ? compressBz2(data) : compressLz4(data);
}

bool isRosbagLz4(std::string_view frame) {
  // Version 1, independent blocks, a checksum of the content; neither its size nor checksums of
  // blocks nor a dictionary (roslz4/src/lz4s.c).
  constexpr std::size_t kFlagsAt = 4;
  constexpr std::uint8_t kFlags = 0x64;
  return frame.size() > kFlagsAt && static_cast<std::uint8_t>(frame[kFlagsAt]) == kFlags;
}

}  // namespace fast_edi
