#include "recording/aps_frame.hpp"

#include <algorithm>

namespace fast_edi {
namespace {

constexpr int kLargestSample = (1 << ApsFrame::kSampleBits) - 1;
constexpr int kShift = 16 - ApsFrame::kSampleBits;

}  // namespace

ApsFrame::ApsFrame(SensorSize size)
    : size_(size),
      states_(size.pixelCount(), kUnread),
      levels_(size.pixelCount(), 0),
      pixels_(size.pixelCount(), 0) {}

void ApsFrame::clear() {
  std::fill(states_.begin(), states_.end(), kUnread);
  resets_ = 0;
  signals_ = 0;
}

bool ApsFrame::addReset(int x, int y, std::uint16_t sample, std::int64_t t_ns) {
  const std::size_t i = index(x, y);
  const bool next_frame = states_[i] != kUnread;
  if (next_frame) {
    clear();
  }
  if (resets_++ == 0) {
    first_reset_ns_ = t_ns;
  }
  last_reset_ns_ = t_ns;
  states_[i] = kReset;
  levels_[i] = sample;
  return next_frame;
}

void ApsFrame::addSignal(int x, int y, std::uint16_t sample, std::int64_t t_ns) {
  const std::size_t i = index(x, y);
  if (states_[i] != kReset) {
    return;
  }
  if (signals_++ == 0) {
    first_signal_ns_ = t_ns;
  }
  states_[i] = kSignal;
  levels_[i] -= sample;
}

ExposureInterval ApsFrame::exposure() const {
  return {last_reset_ns_ <= first_signal_ns_ ? last_reset_ns_ : first_reset_ns_, first_signal_ns_};
}

const std::vector<std::uint16_t>& ApsFrame::pixels() {
  std::transform(levels_.begin(), levels_.end(), pixels_.begin(), [](std::int32_t level) {
    return static_cast<std::uint16_t>(std::clamp(level, 0, kLargestSample) << kShift);
  });
  return pixels_;
}

}  // namespace fast_edi
