#include "survey/timing_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace fast_edi {
namespace {

/// Grey levels outside say little [8-bit DN].
constexpr int kLowestEvidence_dn = 12;
constexpr int kHighestEvidence_dn = 243;
constexpr std::size_t kLevels = 256;
/// Of a stretched frame's pixels, those that are black or white at most.
constexpr double kMostAtEnds = 0.002;
constexpr std::size_t kLeastStretched = 2;  ///< samples
/// Pixels of a sample, about.
constexpr int kEnoughPixels = 25'000;

int rowStep(SensorSize size) {
  return 1 + static_cast<int>(size.pixelCount()) / kEnoughPixels;
}

std::array<float, kLevels> logTable() {
  std::array<float, kLevels> table{};
  table.fill(std::numeric_limits<float>::quiet_NaN());
  for (int dn = kLowestEvidence_dn; dn <= kHighestEvidence_dn; ++dn) {
    table[static_cast<std::size_t>(dn)] = std::log(static_cast<float>(dn));
  }
  return table;
}

std::vector<std::uint8_t> levelsOf(const ImageView& image) {
  std::vector<std::uint8_t> levels;
  levels.reserve(image.size.pixelCount());
  const int bytes = bytesPerPixel(image.format);
  for (int y = 0; y < image.size.height; ++y) {
    const std::uint8_t* pixel = image.row(y);
    for (int x = 0; x < image.size.width; ++x, pixel += bytes) {
      levels.push_back(static_cast<std::uint8_t>(level8(pixel, image.format)));
    }
  }
  return levels;
}

}  // namespace

void readExposure(SampledFrame& frame, const SampleGrid& grid, EventOrientation orientation) {
  const std::array<float, kLevels> table = logTable();
  const EventMapping mapping{EventPolarity::kNormal, orientation};
  frame.log_exposure.clear();
  frame.log_exposure.reserve(grid.size().pixelCount());
  for (int y = 0; y < grid.sensor.height; y += grid.row_step) {
    for (int x = 0; x < grid.sensor.width; ++x) {
      const Event at = mapping.apply(
          Event{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), 0, true},
          grid.sensor);
      const bool inside = at.x < frame.size.width && at.y < frame.size.height;
      const std::size_t pixel =
          static_cast<std::size_t>(at.y) * static_cast<std::size_t>(frame.size.width) + at.x;
      frame.log_exposure.push_back(inside ? table[frame.levels[pixel]]
                                          : std::numeric_limits<float>::quiet_NaN());
    }
  }
}

bool areStretched(const std::vector<TimingSample>& samples) {
  const auto is_stretched = [](const SampledFrame& frame) {
    std::array<std::size_t, kLevels> counts{};
    for (const std::uint8_t level : frame.levels) {
      ++counts[level];
    }
    const auto most =
        static_cast<std::size_t>(kMostAtEnds * static_cast<double>(frame.levels.size()));
    return counts.front() > 0 && counts.back() > 0 && counts.front() <= most &&
           counts.back() <= most;
  };
  return samples.size() >= kLeastStretched &&
         std::all_of(samples.begin(), samples.end(), [&](const TimingSample& sample) {
           return is_stretched(sample.first) && is_stretched(sample.second);
         });
}

void invertPolarity(TimingSample& sample) {
  auto inverted =
      std::make_unique<PixelEventLists>(sample.events->size(), PixelEventLists::Limits{});
  inverted->keepIntervals(true);
  const auto width = static_cast<std::uint32_t>(sample.events->size().width);
  const std::uint64_t end = sample.events->endSequence();
  for (std::uint64_t sequence = sample.events->beginSequence(); sequence < end;) {
    const PackedEventSpan span = sample.events->span(sequence, end);
    for (std::size_t i = 0; i < span.count; ++i) {
      const std::uint32_t pixel = span.data[i].code >> 1;
      inverted->append(Event{static_cast<std::uint16_t>(pixel % width),
                             static_cast<std::uint16_t>(pixel / width),
                             span.base_ns + static_cast<std::int64_t>(span.data[i].dt_ns),
                             (span.data[i].code & 1u) == 0});
    }
    sequence += span.count;
  }
  sample.events = std::move(inverted);
}

TimingSampler::TimingSampler(SensorSize size, const std::vector<SampleRequest>& requests)
    : grid_{size, rowStep(size)}, slots_(requests.size()) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    slots_[i].request = requests[i];
    slots_[i].sample.events =
        std::make_unique<PixelEventLists>(grid_.size(), PixelEventLists::Limits{});
    slots_[i].sample.events->keepIntervals(true);
  }
}

void TimingSampler::addEvents(const WireEvents& events, SensorSize size) {
  if (size != grid_.sensor) {
    return;
  }
  for (std::size_t i = 0; i < events.count; ++i) {
    Event event = decodeWireEvent(events.record(i));
    if (event.y % grid_.row_step != 0) {
      continue;
    }
    event.y = static_cast<std::uint16_t>(event.y / grid_.row_step);
    for (Slot& slot : slots_) {
      const ExposureInterval& wanted = slot.request.events;
      if (event.t_ns >= wanted.start_ns && event.t_ns < wanted.end_ns) {
        slot.sample.events->append(event);  // refuses late ones
      }
    }
  }
}

void TimingSampler::addFrame(std::size_t index, const SampledFrame& frame, const ImageView& image) {
  const SensorSize turned{grid_.sensor.height, grid_.sensor.width};
  if (image.data == nullptr || (image.size != grid_.sensor && image.size != turned)) {
    return;
  }
  for (Slot& slot : slots_) {
    const bool first = index == slot.request.first_frame;
    if (!first && index != slot.request.first_frame + 1) {
      continue;
    }
    SampledFrame& kept = first ? slot.sample.first : slot.sample.second;
    kept = frame;
    kept.levels = levelsOf(image);
    kept.size = image.size;
    readExposure(kept, grid_, EventOrientation::kNormal);
    (first ? slot.has_first : slot.has_second) = true;
  }
}

std::vector<TimingSample> TimingSampler::take() {
  std::vector<TimingSample> samples;
  for (Slot& slot : slots_) {
    if (slot.has_first && slot.has_second && !slot.sample.events->empty()) {
      samples.push_back(std::move(slot.sample));
    }
  }
  slots_.clear();
  return samples;
}

}  // namespace fast_edi
