#include "support/vanilla_edi.hpp"

#include <algorithm>
#include <cmath>

#include "support/tone.hpp"
#include "support/wire_reader.hpp"

namespace fast_edi::testing {

VanillaEdi::VanillaEdi(SensorSize size, ContrastThresholds thresholds)
    : size_(size),
      thresholds_(thresholds),
      level_(size.pixelCount()),
      latent_(size.pixelCount()),
      accumulator_(size.pixelCount()),
      reference_(size.pixelCount()) {}

void VanillaEdi::begin(const ExposureInterval& window, std::int64_t reference_ns) {
  window_ = window;
  reference_ns_ = reference_ns;
  event_count_ = 0;
  reference_passed_ = false;
  std::fill(level_.begin(), level_.end(), 0.0);
  std::fill(latent_.begin(), latent_.end(), 1.0);
  std::fill(accumulator_.begin(), accumulator_.end(), 0.0);
}

void VanillaEdi::add(const Event& event) {
  if (event.t_ns < window_.start_ns || event.t_ns >= window_.end_ns) return;
  if (event.x >= size_.width || event.y >= size_.height) return;
  if (!reference_passed_ && event.t_ns >= reference_ns_) {
    reference_ = latent_;
    reference_passed_ = true;
  }
  const std::size_t pixel = static_cast<std::size_t>(event.y) * size_.width + event.x;
  level_[pixel] += thresholds_.step(event.on);
  latent_[pixel] = std::exp(level_[pixel]);

  const std::size_t pixel_count = latent_.size();
  const double* __restrict latent = latent_.data();
  double* __restrict accumulator = accumulator_.data();
  for (std::size_t i = 0; i < pixel_count; ++i) accumulator[i] += latent[i];
  ++event_count_;
}

void VanillaEdi::add(const WireEvents& events) {
  for (std::size_t i = 0; i < events.count; ++i) add(readWireEvent(events.record(i)));
}

const std::vector<double>& VanillaEdi::referenceImage() const {
  return reference_passed_ ? reference_ : latent_;
}

double VanillaEdi::valueAt(std::size_t pixel) const {
  if (event_count_ == 0) return 1.0;
  return accumulator_[pixel] / static_cast<double>(event_count_) / referenceImage()[pixel];
}

std::vector<double> VanillaEdi::doubleIntegral() const {
  std::vector<double> result(latent_.size());
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = valueAt(i);
  return result;
}

void VanillaEdi::writeImage(const std::uint8_t* blurry, std::uint8_t* latent) const {
  for (std::size_t i = 0; i < latent_.size(); ++i) latent[i] = latentGrey(blurry[i], valueAt(i));
}

}  // namespace fast_edi::testing
