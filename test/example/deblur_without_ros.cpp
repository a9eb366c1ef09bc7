/// Deblurs one frame with the core library alone: no ROS, no OpenCV.
#include <cstdint>
#include <iostream>
#include <vector>

#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace {

constexpr std::int64_t kMs = fast_edi::kNanosecondsPerMillisecond;
constexpr std::int64_t kStart = 1000 * kMs;  // of the exposure
constexpr int kExposure_ms = 16;

/// Receives one image for each frame.
class Printer : public fast_edi::FrameSink {
 public:
  fast_edi::MutableImageView begin(const fast_edi::InputFrame& input) override {
    return image_.reshape(input.image.size, input.image.format);
  }
  void finish(const fast_edi::OutputFrame& output) override {
    std::cout << (output.deblurred ? "deblurred:" : "passed through:");
    for (int x = 0; x < image_.view().size.width; ++x) {
      std::cout << ' ' << int{image_.view().row(0)[x]};
    }
    std::cout << '\n';
  }

 private:
  fast_edi::StoredImage image_;
};

}  // namespace

int main() {
  fast_edi::DeblurParameters parameters;
  parameters.thresholds = {0.25, 0.25};
  parameters.exposure_source = fast_edi::ExposureSource::kParameter;
  parameters.exposure_time_ns = kExposure_ms * kMs;
  parameters.filter.enabled = false;  // plain EDI
  // A bright edge moves over one row of pixels, one pixel in each millisecond. Pixel x goes from 40
  // to 40 exp(4 * 0.25) = 109 at x ms, which causes four events; the frame has the mean of both.
  const fast_edi::SensorSize size{kExposure_ms, 1};
  std::vector<std::uint8_t> frame;
  std::vector<fast_edi::Event> events{{0, 0, kStart - kMs, true}};
  for (std::uint16_t x = 0; x < kExposure_ms; ++x) {
    frame.push_back(static_cast<std::uint8_t>((40 * x + 109 * (kExposure_ms - x)) / kExposure_ms));
    for (int step = 0; step < 4; ++step) {
      events.push_back({x, 0, kStart + x * kMs + step, true});
    }
  }
  events.push_back({0, 0, kStart + (kExposure_ms + 1) * kMs, true});

  Printer printer;
  fast_edi::Deblurrer deblurrer(parameters, printer);
  deblurrer.addEvents(events.data(), events.size(), size, 0);
  const std::int64_t stamp = kStart + kExposure_ms * kMs / 2;
  deblurrer.addFrame({stamp, {frame.data(), size, frame.size()}, true, nullptr}, 0);
}
