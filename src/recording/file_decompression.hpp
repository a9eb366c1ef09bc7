/// \file
/// Files that were compressed as a whole, as rosbag2 does it by `--compression-mode file`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {

/// A file of ZSTD frames begins with these.
constexpr std::uint8_t kZstdMagic[] = {0x28, 0xB5, 0x2F, 0xFD};

bool beginsWithZstd(const std::uint8_t* data, std::size_t size);

/// Decompresses up to the first damage into a file without a name in the system's folder for
/// temporary files, where it exists as long as what is returned. A file that grows more than any
/// recording does is cut there.
/// \param fault what is wrong; empty if nothing is
/// \throws RecordingError when there is no place for it
std::unique_ptr<ByteSource> decompressFile(const ByteSource& file, std::string& fault);

}  // namespace fast_edi
