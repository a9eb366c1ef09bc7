/// \file
/// Plain value types that every stage of the pipeline shares.
///
/// Times are integer nanoseconds since the epoch of the stream they belong to ("sensor time" as the
/// driver stamps it). They are compared with each other only, never with the host's clock.
#pragma once

#include <cstddef>
#include <cstdint>

namespace fast_edi {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
constexpr std::int64_t kNanosecondsPerMicrosecond = 1'000;

/// Width and height of a pixel array, origin top left [px].
struct SensorSize {
  int width = 0;
  int height = 0;

  std::size_t pixelCount() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  friend bool operator==(const SensorSize& a, const SensorSize& b) {
    return a.width == b.width && a.height == b.height;
  }
  friend bool operator!=(const SensorSize& a, const SensorSize& b) { return !(a == b); }
};

/// One event: the log intensity of pixel (x, y) has moved by one contrast threshold.
struct Event {
  std::uint16_t x = 0;
  std::uint16_t y = 0;
  std::int64_t t_ns = 0;
  bool on = false;  ///< polarity: true = ON (brighter), false = OFF (darker)
};

/// How long each latent value counts in the double integral.
enum class Weighting {
  kTime,     ///< the elapsed time until the pixel's next event: the integral itself, exactly
  kCounter,  ///< the number of events anywhere in the frame until then (Lin et al., ICRA 2023)
};

/// An instant of an exposure, as a choice.
enum class ExposureInstant { kStart, kMid, kEnd };

/// The half-open interval [start, end) during which a frame collects light [ns].
struct ExposureInterval {
  std::int64_t start_ns = 0;
  std::int64_t end_ns = 0;

  std::int64_t length() const { return end_ns - start_ns; }

  /// The middle is rounded down to whole microseconds after the start, as the driver does it
  /// (start = stamp - floor(L / 2) us): the stamp that a driver gives the middle comes back
  /// exactly.
  std::int64_t at(ExposureInstant instant) const {
    switch (instant) {
      case ExposureInstant::kStart:
        return start_ns;
      case ExposureInstant::kEnd:
        return end_ns;
      case ExposureInstant::kMid:
        break;
    }
    return start_ns + length() / 2 / kNanosecondsPerMicrosecond * kNanosecondsPerMicrosecond;
  }
  friend bool operator==(const ExposureInterval& a, const ExposureInterval& b) {
    return a.start_ns == b.start_ns && a.end_ns == b.end_ns;
  }
  friend bool operator!=(const ExposureInterval& a, const ExposureInterval& b) { return !(a == b); }
};

}  // namespace fast_edi
