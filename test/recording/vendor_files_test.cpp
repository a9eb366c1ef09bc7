/// AEDAT4 files that iniVation's own library wrote from a simulated recording; see
/// test/data/recordings/README.md.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "fast_edi/recording/aedat4_reader.hpp"

namespace fast_edi {
namespace {

struct Sums {
  std::size_t events = 0;
  std::uint64_t event_sum = 0;  ///< over times, coordinates and polarities, in their order
  std::vector<std::int64_t> exposures_us;
  std::uint64_t pixel_sum = 0;
  std::size_t samples = 0;

  friend bool operator==(const Sums& a, const Sums& b) {
    return a.events == b.events && a.event_sum == b.event_sum && a.exposures_us == b.exposures_us &&
           a.pixel_sum == b.pixel_sum && a.samples == b.samples;
  }
};

/// Depends on the order (Fowler, Noll and Vo).
void mix(std::uint64_t& sum, std::uint64_t value) {
  sum = (sum ^ value) * 0x100000001B3U;
}

Sums sumsOf(const std::string& name) {
  Aedat4Reader reader(std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/" + name);
  Sums sums;
  RecordingItem item;
  while (reader.next(item)) {
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      sums.events += events->count;
      for (std::size_t i = 0; i < events->count; ++i) {
        const Event& event = events->data[i];
        mix(sums.event_sum, static_cast<std::uint64_t>(event.t_ns));
        mix(sums.event_sum, event.x);
        mix(sums.event_sum, event.y);
        mix(sums.event_sum, event.on ? 1 : 0);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      sums.exposures_us.push_back(frame->exposure.value().length() / kNanosecondsPerMicrosecond);
      EXPECT_EQ(frame->encoding, "mono8");
      for (std::size_t i = 0; i < frame->bytes; ++i) {
        mix(sums.pixel_sum, frame->pixels[i]);
      }
    } else if (std::holds_alternative<RecordedImu>(item.content)) {
      ++sums.samples;
    }
  }
  EXPECT_TRUE(reader.damage().empty());
  return sums;
}

TEST(VendorFiles, HaveTheSameContentInEveryCompression) {
  const Sums plain = sumsOf("vendor_none.aedat4");
  EXPECT_EQ(plain.events, 2436U);
  EXPECT_EQ(plain.exposures_us, std::vector<std::int64_t>(3, 30'000));
  EXPECT_TRUE(sumsOf("vendor_lz4.aedat4") == plain);
  EXPECT_TRUE(sumsOf("vendor_zstd.aedat4") == plain);
}

}  // namespace
}  // namespace fast_edi
