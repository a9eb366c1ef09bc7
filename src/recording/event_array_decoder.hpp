/// \file
/// Events of dvs_msgs/EventArray in CDR: uint16 x, uint16 y, int32 seconds, uint32 nanoseconds,
/// bool polarity; the next one is aligned again.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/base/types.hpp"
#include "recording/cdr_reader.hpp"

namespace fast_edi {

class EventArrayDecoder {
 public:
  /// \param cdr stands behind the number of events; its message must outlive decoding
  /// \param stated number of events by the message
  void begin(const CdrReader& cdr, std::size_t stated);
  /// Events that are wholly there and not decoded yet.
  std::size_t left() const { return count_ - done_; }
  /// Appends events until there are \p max, or the array ends.
  /// \return whether the array has not ended
  bool decode(std::vector<Event>& events, std::size_t max);
  /// Events of this array that were left out: times before 1970 or after 2106.
  std::size_t untold() const { return untold_; }

 private:
  template <typename Number>
  Number read(std::size_t place) const;

  const std::uint8_t* data_ = nullptr;
  bool big_endian_ = false;
  std::size_t count_ = 0;
  std::size_t done_ = 0;
  std::size_t untold_ = 0;
};

}  // namespace fast_edi
