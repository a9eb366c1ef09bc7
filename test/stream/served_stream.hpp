/// \file
/// What DV's server sends for a stream, made by this package's own writer.
#pragma once

#include <string>
#include <vector>

#include "fast_edi/recording/aedat4_writer.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi::testing {

struct ServedStream {
  std::string header;
  std::vector<std::string> packets;  ///< each with its stream and size in front

  std::string all() const;
};

/// Writes a file of one stream and takes its header and packets.
class StreamBytes {
 public:
  StreamBytes(const RecordedStream& stream, Aedat4Compression compression);
  void add(const std::vector<Event>& events);
  void add(const RecordedFrame& frame);
  void add(const RecordedImu& sample);
  void add(const RecordedTrigger& trigger);
  /// Once.
  ServedStream take();

 private:
  std::string folder_;
  Aedat4Writer writer_;
};

}  // namespace fast_edi::testing
