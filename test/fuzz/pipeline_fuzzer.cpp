/// Pairing of exposures with images and the whole pipeline, by a schedule of events, frames,
/// exposures, jumps of all clocks, sizes, formats and parameters that the input's bytes decide.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fuzzer/FuzzedDataProvider.h>

#include "fast_edi/base/parameter_ranges.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "fuzz/fuzzing.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/schedule_checker.hpp"

namespace {

using fast_edi::DeblurParameters;
using fast_edi::ExposureInstant;
using fast_edi::PixelFormat;
using fast_edi::SensorSize;
using fast_edi::fuzzing::requireNoFault;

constexpr std::int64_t kMs = fast_edi::kNanosecondsPerMillisecond;
constexpr std::int64_t kUs = fast_edi::kNanosecondsPerMicrosecond;
constexpr std::int64_t kLastStamp_ns = UINT32_MAX * fast_edi::kNanosecondsPerSecond;
constexpr int kMaxCalls = 300;

constexpr std::array<SensorSize, 6> kSizes{{{8, 6}, {6, 8}, {1, 1}, {10, 9}, {3, 17}, {0, 5}}};
constexpr std::array<PixelFormat, 8> kFormats{
    PixelFormat::kMono8,        PixelFormat::kBayer8,       PixelFormat::kMono16,
    PixelFormat::kColour8,      PixelFormat::kBayer16,      PixelFormat::kColour16,
    PixelFormat::kColourAlpha8, PixelFormat::kColourAlpha16};

DeblurParameters anyParameters(FuzzedDataProvider& input) {
  DeblurParameters parameters;
  parameters.thresholds = {0.01 * input.ConsumeIntegralInRange<int>(1, 1000),
                           0.01 * input.ConsumeIntegralInRange<int>(1, 1000)};
  const auto instant = [&input] {
    return static_cast<ExposureInstant>(input.ConsumeIntegralInRange<int>(0, 2));
  };
  parameters.weighting =
      input.ConsumeBool() ? fast_edi::Weighting::kTime : fast_edi::Weighting::kCounter;
  parameters.reference = instant();
  parameters.stamp_reference = input.ConsumeBool() ? parameters.reference : instant();
  parameters.exposure_source =
      input.ConsumeBool() ? fast_edi::ExposureSource::kTopic : fast_edi::ExposureSource::kParameter;
  parameters.exposure_time_ns =
      kUs * input.ConsumeIntegralInRange<std::int64_t>(0, fast_edi::kMaxExposure_ns / kUs);
  if (input.ConsumeBool()) {
    parameters.time_offset_ns = input.ConsumeIntegralInRange<std::int64_t>(
        -fast_edi::kMaxTimeOffset_ns, fast_edi::kMaxTimeOffset_ns);
  }
  parameters.close_timeout_ns = input.ConsumeIntegralInRange<std::int64_t>(1, 1000) * kMs;
  parameters.max_buffered_events = input.ConsumeIntegralInRange<std::size_t>(1, 2000);
  parameters.max_backward_jump_ns = input.ConsumeIntegralInRange<std::int64_t>(1, 2000) * kMs;
  parameters.max_forward_jump_ns = input.ConsumeIntegralInRange<std::int64_t>(1, 20000) * kMs;
  parameters.filter.enabled = input.ConsumeBool();
  parameters.refine_contrast = input.ConsumeBool();
  parameters.refine_delay = input.ConsumeBool();
  parameters.passthrough = input.ConsumeIntegralInRange<int>(0, 15) == 0;
  parameters.latent.per_exposure = input.ConsumeIntegralInRange<int>(0, 3);
  return parameters;
}

/// Drives a pipeline by the input's bytes.
class Schedule {
 public:
  explicit Schedule(FuzzedDataProvider& input)
      : input_(input), deblurrer_(anyParameters(input), sink_), checker_(deblurrer_, sink_) {
    sink_.wants_latent_images = input.ConsumeBool();
  }

  void run() {
    for (int call = 0; call < kMaxCalls && input_.remaining_bytes() > 0; ++call) {
      step();
      requireNoFault(checker_.fault());
    }
    deblurrer_.finish();
    requireNoFault(checker_.faultAtEnd());
  }

 private:
  void step() {
    now_ns_ += input_.ConsumeIntegralInRange<std::int64_t>(0, 60) * kMs;
    switch (input_.ConsumeIntegralInRange<int>(0, 15)) {
      case 0:
        sensor_ns_ = input_.ConsumeIntegralInRange<std::int64_t>(0, kLastStamp_ns);
        break;
      case 1:
        size_ = input_.PickValueInArray(kSizes);
        break;
      case 2:
        format_ = input_.PickValueInArray(kFormats);
        break;
      case 3:
        deblurrer_.advance(now_ns_);
        break;
      case 4:
        checker_.expectPause();
        deblurrer_.pause();
        break;
      case 5:
        deblurrer_.setParameters(anyParameters(input_));
        break;
      case 6:
      case 7:
      case 8:
        deblurrer_.addExposure(anyExposure(), now_ns_);
        break;
      case 9:
      case 10:
      case 11:
        addFrame();
        break;
      default:
        addEvents();
        break;
    }
  }

  std::int32_t anyExposure() {
    return input_.ConsumeBool() ? input_.ConsumeIntegralInRange<std::int32_t>(1, 40'000)
                                : input_.ConsumeIntegral<std::int32_t>();
  }

  void addFrame() {
    if (size_.pixelCount() == 0) {
      return;
    }
    // Around the sensor's time, or anywhere.
    const std::int64_t stamp_ns =
        input_.ConsumeIntegralInRange<int>(0, 7) == 0
            ? input_.ConsumeIntegralInRange<std::int64_t>(0, kLastStamp_ns)
            : std::max<std::int64_t>(0, sensor_ns_ - input_.ConsumeIntegral<std::uint16_t>() * kUs);
    const SensorSize samples{size_.width * fast_edi::bytesPerPixel(format_), size_.height};
    fast_edi::InputFrame frame = fast_edi::testing::makeFrame(
        stamp_ns, samples,
        std::vector<std::uint8_t>(samples.pixelCount(), input_.ConsumeIntegral<std::uint8_t>()));
    frame.image.size = size_;
    frame.image.format = format_;
    frame.supported = input_.ConsumeIntegralInRange<int>(0, 15) != 0;
    deblurrer_.addFrame(checker_.expect(std::move(frame)), now_ns_);
  }

  void addEvents() {
    std::vector<fast_edi::Event> events;
    const int count = input_.ConsumeIntegralInRange<int>(0, 200);
    const bool regular = input_.ConsumeBool();
    const std::int64_t step_ns = input_.ConsumeIntegralInRange<std::int64_t>(0, 500) * kUs;
    for (int i = 0; i < count; ++i) {
      fast_edi::Event event;
      if (regular) {
        event.x = static_cast<std::uint16_t>(i % std::max(1, size_.width));
        event.y = static_cast<std::uint16_t>(i / 7 % std::max(1, size_.height));
        event.on = i % 3 != 0;
        sensor_ns_ += step_ns;
      } else if (input_.remaining_bytes() == 0) {
        break;
      } else {
        event.x = input_.ConsumeIntegralInRange<std::uint16_t>(0, 20);
        event.y = input_.ConsumeIntegralInRange<std::uint16_t>(0, 20);
        event.on = input_.ConsumeBool();
        sensor_ns_ += input_.ConsumeIntegral<std::int16_t>() * kUs;
      }
      sensor_ns_ = std::min(std::max<std::int64_t>(0, sensor_ns_), kLastStamp_ns);
      event.t_ns = sensor_ns_;
      events.push_back(event);
    }
    sequence_ += input_.ConsumeIntegralInRange<int>(0, 15) == 0 ? 2u : 1u;
    const std::vector<std::uint8_t> records = fast_edi::testing::toWire(events);
    checker_.expectEvents(events.size());
    deblurrer_.addEvents(fast_edi::testing::wireView(records), size_, sequence_, now_ns_);
  }

  FuzzedDataProvider& input_;
  fast_edi::testing::RecordingSink sink_;
  fast_edi::Deblurrer deblurrer_;
  fast_edi::testing::ScheduleChecker checker_;
  std::int64_t now_ns_ = 0;
  std::int64_t sensor_ns_ = 1000 * fast_edi::kNanosecondsPerSecond;
  SensorSize size_ = kSizes.front();
  PixelFormat format_ = PixelFormat::kMono8;
  std::uint32_t sequence_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  Schedule(input).run();
  return 0;
}
