/// replay_calls CALLS VARIANT: runs the pipeline and prints a line for each image (stamp, what
/// became of it, a hash of its bytes) and what was learned, to the last bit. VARIANT: default,
/// plain, end, video.
#include <cstddef>
#include <cstdint>
#include <exception>
#include <iostream>
#include <optional>
#include <string>

#include "calls.hpp"
#include "fast_edi/base/stored_image.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace {

/// FNV-1a of 64 bits.
std::uint64_t hashOf(const fast_edi::ImageView& image) {
  constexpr std::uint64_t kBasis = 0xcbf29ce484222325;
  constexpr std::uint64_t kPrime = 0x100000001b3;
  std::uint64_t hash = kBasis;
  const std::size_t bytes = image.step * static_cast<std::size_t>(image.size.height);
  for (std::size_t i = 0; i < bytes; ++i) {
    hash = (hash ^ image.data[i]) * kPrime;
  }
  return hash;
}

class Printer : public fast_edi::FrameSink {
 public:
  explicit Printer(bool wants_latent_images) : wants_latent_images_(wants_latent_images) {}

  fast_edi::MutableImageView begin(const fast_edi::InputFrame& input) override {
    return input.image.data == nullptr ? fast_edi::MutableImageView()
                                       : image_.reshape(input.image.size, input.image.format);
  }
  void finish(const fast_edi::OutputFrame& output) override {
    std::cout << (output.deblurred ? "deblurred " : "passed ");
    print(output.stamp_ns);
  }
  bool wantsLatentImages() const override { return wants_latent_images_; }
  fast_edi::MutableImageView beginLatent(const fast_edi::InputFrame& input) override {
    return begin(input);
  }
  void finishLatent(const fast_edi::InputFrame&, std::int64_t stamp_ns) override {
    std::cout << "latent ";
    print(stamp_ns);
  }

 private:
  void print(std::int64_t stamp_ns) {
    std::cout << std::dec << stamp_ns << " " << std::hex << hashOf(image_.view()) << "\n";
  }

  bool wants_latent_images_;
  fast_edi::StoredImage image_;
};

/// Thresholds of bags/demo.bag, which are those of simulate_davis.
constexpr fast_edi::ContrastThresholds kThresholds{0.2609, 0.2415};
constexpr int kVideoRate_hz = 300;

std::optional<fast_edi::DeblurParameters> parametersOf(const std::string& variant) {
  fast_edi::DeblurParameters parameters;
  parameters.thresholds = kThresholds;
  if (variant == "plain") {
    parameters.filter.enabled = false;
  } else if (variant == "end") {
    parameters.reference = fast_edi::ExposureInstant::kEnd;
  } else if (variant == "video") {
    parameters.latent.rate_hz = kVideoRate_hz;
  } else if (variant != "default") {
    return std::nullopt;
  }
  return parameters;
}

}  // namespace

int main(int argc, char** argv) {
  const auto parameters = argc == 3 ? parametersOf(argv[2]) : std::nullopt;
  if (!parameters) {
    std::cerr << "usage: replay_calls CALLS default|plain|end|video\n";
    return 1;
  }
  try {
    Printer printer(parameters->latent.rate_hz > 0);
    fast_edi::Deblurrer deblurrer(*parameters, printer);
    fast_edi::arm64::replayCalls(argv[1], deblurrer);
    const fast_edi::DeblurStatus status = deblurrer.status();
    std::cout << std::dec << std::hexfloat << "thresholds " << status.thresholds.on << " "
              << status.thresholds.off << "\ndelay " << status.event_delay_ns << "\n";
  } catch (const std::exception& error) {
    std::cerr << "replay_calls: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
