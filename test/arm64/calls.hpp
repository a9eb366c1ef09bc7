/// \file
/// A recording as the calls that it makes of the pipeline: what carries bags to programs that are
/// built without ROS. A file of these lives between two programs of one build; its layout is that
/// of calls.cpp alone.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi::arm64 {

/// Writes the calls to a file. Each is preceded by one of Deblurrer::advance().
class CallWriter {
 public:
  /// \throws std::runtime_error when the file cannot be written; so do all others
  explicit CallWriter(const std::string& path);

  void advance(std::int64_t now_ns);
  void addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                 std::int64_t now_ns);
  void addFrame(const InputFrame& frame, std::int64_t now_ns);
  void addExposure(std::int32_t exposure_us, std::int64_t now_ns);
  void close();

 private:
  template <typename Number>
  void put(Number number);
  void putBytes(const std::uint8_t* bytes, std::size_t count);
  void putSize(SensorSize size);

  std::string path_;
  std::ofstream out_;
};

/// Makes the calls of a file, then Deblurrer::finish().
/// \throws std::runtime_error when the file cannot be read or is not one that CallWriter wrote
void replayCalls(const std::string& path, Deblurrer& deblurrer);

}  // namespace fast_edi::arm64
