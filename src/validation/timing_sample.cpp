#include "fast_edi/validation/timing_sample.hpp"

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
/// Pixels of a sample, about.
constexpr int kEnoughPixels = 25'000;

int rowStep(SensorSize size) {
  return 1 + static_cast<int>(size.pixelCount()) / kEnoughPixels;
}

}  // namespace

std::vector<float> TimingSampler::logExposure(const ImageView& image) const {
  std::array<float, kLevels> table{};
  table.fill(std::numeric_limits<float>::quiet_NaN());
  for (int dn = kLowestEvidence_dn; dn <= kHighestEvidence_dn; ++dn) {
    table[static_cast<std::size_t>(dn)] = std::log(static_cast<float>(dn));
  }
  std::vector<float> result;
  result.reserve(sample_size_.pixelCount());
  const int bytes = bytesPerPixel(image.format);
  for (int y = 0; y < image.size.height; y += row_step_) {
    const std::uint8_t* pixel = image.row(y);
    for (int x = 0; x < image.size.width; ++x, pixel += bytes) {
      result.push_back(table[level8(pixel, image.format)]);
    }
  }
  return result;
}

TimingSampler::TimingSampler(SensorSize size, const std::vector<SampleRequest>& requests)
    : size_(size),
      row_step_(rowStep(size)),
      sample_size_{size.width, (size.height + row_step_ - 1) / row_step_},
      slots_(requests.size()) {
  for (std::size_t i = 0; i < requests.size(); ++i) {
    slots_[i].request = requests[i];
    slots_[i].sample.events =
        std::make_unique<PixelEventLists>(sample_size_, PixelEventLists::Limits{});
  }
}

void TimingSampler::addEvents(const WireEvents& events, SensorSize size) {
  if (size != size_) {
    return;
  }
  for (std::size_t i = 0; i < events.count; ++i) {
    Event event = decodeWireEvent(events.record(i));
    if (event.y % row_step_ != 0) {
      continue;
    }
    event.y = static_cast<std::uint16_t>(event.y / row_step_);
    for (Slot& slot : slots_) {
      const ExposureInterval& wanted = slot.request.events;
      if (event.t_ns >= wanted.start_ns && event.t_ns < wanted.end_ns) {
        slot.sample.events->append(event);  // refuses late ones
      }
    }
  }
}

void TimingSampler::addFrame(std::size_t index, const SampledFrame& frame, const ImageView& image) {
  if (image.size != size_) {
    return;
  }
  for (Slot& slot : slots_) {
    const bool first = index == slot.request.first_frame;
    if (!first && index != slot.request.first_frame + 1) {
      continue;
    }
    SampledFrame& kept = first ? slot.sample.first : slot.sample.second;
    kept = frame;
    kept.log_exposure = logExposure(image);
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
