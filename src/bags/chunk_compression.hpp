/// \file
/// Compression of rosbag chunks; bag_chunk.hpp decompresses them.
#pragma once

#include <string>
#include <string_view>

namespace fast_edi {

/// \p data as a chunk has them, so that rosbag's own decoders read them: that of lz4 knows but a
/// part of what frames may have. \param compression "bz2" or "lz4" \throws BagError for more than
/// the compression can take: bz2 ends below 4 GiB
std::string compressChunk(std::string_view compression, std::string_view data);

/// Whether rosbag's decoder of lz4 takes a frame that begins like this.
bool isRosbagLz4(std::string_view frame);

}  // namespace fast_edi
