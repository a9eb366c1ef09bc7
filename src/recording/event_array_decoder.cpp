#include "recording/event_array_decoder.hpp"

#include <algorithm>
#include <cstring>

#include "fast_edi/exposure/stamp_limits.hpp"

namespace fast_edi {
namespace {

// The first event begins at a multiple of four, behind the 32-bit number of events: 13 bytes. Each
// later one begins at the next multiple of two, and its seconds at the next multiple of four. So
// all but x and y of the first one lie at the same places of blocks of 16 bytes.
constexpr std::size_t kBlockBytes = 16;
constexpr std::size_t kFirstBytes = 13;
constexpr std::size_t kSecondsOffset = 4;
constexpr std::size_t kNanosecondsOffset = 8;
constexpr std::size_t kPolarityOffset = 12;

}  // namespace

void EventArrayDecoder::begin(const CdrReader& cdr, std::size_t stated) {
  data_ = cdr.here();
  big_endian_ = cdr.isBigEndian();
  const std::size_t there =
      cdr.rest() < kFirstBytes ? 0 : (cdr.rest() - kFirstBytes) / kBlockBytes + 1;
  count_ = std::min(stated, there);
  done_ = 0;
  untold_ = 0;
}

template <typename Number>
Number EventArrayDecoder::read(std::size_t place) const {
  Number number;
  std::memcpy(&number, data_ + place, sizeof(number));
  return big_endian_ ? byteSwapped(number) : number;
}

bool EventArrayDecoder::decode(std::vector<Event>& events, std::size_t max) {
  for (; done_ < count_ && events.size() < max; ++done_) {
    const std::size_t block = done_ * kBlockBytes;
    const std::size_t x = done_ == 0 ? 0 : block - sizeof(std::uint16_t);
    const std::int64_t t_ns = read<std::int32_t>(block + kSecondsOffset) * kNanosecondsPerSecond +
                              read<std::uint32_t>(block + kNanosecondsOffset);
    if (!isStamp(t_ns)) {
      ++untold_;
      continue;
    }
    events.push_back({read<std::uint16_t>(x), read<std::uint16_t>(x + sizeof(std::uint16_t)), t_ns,
                      data_[block + kPolarityOffset] != 0});
  }
  return done_ < count_;
}

}  // namespace fast_edi
