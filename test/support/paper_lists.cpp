#include "support/paper_lists.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/tone.hpp"
#include "support/wire_reader.hpp"

namespace fast_edi::testing {

namespace {
/// Beyond this log intensity a list's values are scaled back to its oldest entry.
constexpr double kRebaseLevel = 100.0;
}  // namespace

PaperLists::PaperLists(SensorSize size, ContrastThresholds thresholds, Weighting weighting)
    : size_(size),
      thresholds_(thresholds),
      weighting_(weighting),
      lists_(size.pixelCount()),
      partials_(size.pixelCount()),
      double_integral_(size.pixelCount(), 1.0) {}

void PaperLists::add(const Event& event) {
  if (event.x >= size_.width || event.y >= size_.height) return;
  if (!has_base_) {
    base_ns_ = event.t_ns;
    has_base_ = true;
  }
  PixelList& list = lists_[static_cast<std::size_t>(event.y) * size_.width + event.x];
  list.level += thresholds_.step(event.on);
  list.entries.push_back(
      {static_cast<double>(event.t_ns - base_ns_), std::exp(list.level), counter_});
  counter_ += 1.0;
}

void PaperLists::add(const WireEvents& events) {
  for (std::size_t i = 0; i < events.count; ++i) add(readWireEvent(events.record(i)));
}

PaperLists::Partial PaperLists::walk(const PixelList& list, double start, double end,
                                     double reference) {
  auto entry = list.entries.begin();
  Partial partial;
  double value = list.value_before;
  for (; entry != list.entries.end() && entry->t < start; ++entry) value = entry->exp_value;
  partial.first_value = value;
  partial.reference_value = value;
  if (entry == list.entries.end() || entry->t >= end) {
    partial.last_value = value;
    return partial;
  }
  first_counter_ = std::min(first_counter_, entry->counter);
  const bool by_time = weighting_ == Weighting::kTime;
  double clock = 0.0;
  double counter = 0.0;
  for (; entry != list.entries.end() && entry->t < end; ++entry) {
    const double next_clock = by_time ? entry->t : entry->counter;
    partial.sum += value * (next_clock - clock);
    clock = next_clock;
    value = entry->exp_value;
    counter = entry->counter;
    if (entry->t < reference) partial.reference_value = value;
  }
  partial.sum -= value * clock;
  partial.last_value = value;
  end_counter_ = std::max(end_counter_, counter + 1.0);
  return partial;
}

void PaperLists::dropBefore(PixelList& list, double end) {
  auto keep = list.entries.begin();
  for (; keep != list.entries.end() && keep->t < end; ++keep) list.value_before = keep->exp_value;
  list.entries.erase(list.entries.begin(), keep);
  if (list.entries.empty()) {
    list.level = 0.0;
    list.value_before = 1.0;
  } else if (std::abs(list.level) > kRebaseLevel) {
    const double scale = 1.0 / list.value_before;
    list.level += std::log(scale);
    list.value_before = 1.0;
    for (Entry& entry : list.entries) entry.exp_value *= scale;
  }
}

const std::vector<double>& PaperLists::close(const ExposureInterval& window,
                                             std::int64_t reference_ns) {
  const double start = static_cast<double>(window.start_ns - base_ns_);
  const double end = static_cast<double>(window.end_ns - base_ns_);
  const double reference = static_cast<double>(reference_ns - base_ns_);
  first_counter_ = std::numeric_limits<double>::infinity();
  end_counter_ = 0.0;
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    partials_[i] = walk(lists_[i], start, end, reference);
    dropBefore(lists_[i], end);
  }

  const bool has_events = first_counter_ < end_counter_;
  const bool by_time = weighting_ == Weighting::kTime;
  const double first_clock = by_time ? start : first_counter_;
  const double end_clock = by_time ? end : end_counter_;
  const double scale = has_events ? 1.0 / (end_clock - first_clock) : 0.0;
  for (std::size_t i = 0; i < partials_.size(); ++i) {
    const Partial& partial = partials_[i];
    const double sum = has_events ? partial.sum - partial.first_value * first_clock +
                                        partial.last_value * end_clock
                                  : 0.0;
    double_integral_[i] = has_events ? sum * scale / partial.reference_value : 1.0;
  }
  return double_integral_;
}

void PaperLists::close(const ExposureInterval& window, std::int64_t reference_ns,
                       const std::uint8_t* blurry, std::uint8_t* latent) {
  close(window, reference_ns);
  for (std::size_t i = 0; i < double_integral_.size(); ++i) {
    latent[i] = latentGrey(blurry[i], double_integral_[i]);
  }
}

const std::vector<PaperLists::Entry>& PaperLists::list(int x, int y) const {
  return lists_[static_cast<std::size_t>(y) * size_.width + x].entries;
}

std::size_t PaperLists::memoryBytes() const {
  std::size_t bytes = lists_.capacity() * sizeof(PixelList);
  for (const PixelList& list : lists_) bytes += list.entries.capacity() * sizeof(Entry);
  return bytes;
}

}  // namespace fast_edi::testing
