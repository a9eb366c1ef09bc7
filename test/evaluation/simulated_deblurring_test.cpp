// The whole pipeline on simulated recordings whose truth is known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "evaluation/shaken_poster.hpp"
#include "fast_edi/integral/double_integral.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "measures/image_metrics.hpp"
#include "simulation/davis_simulator.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"
#include "support/reference_double_integral.hpp"
#include "support/tone.hpp"
#include "support/vanilla_edi.hpp"

namespace fast_edi {
namespace {

using testing::parametersFor;
using testing::shakenPoster;

constexpr SensorSize kSize = testing::kPosterSize;

std::vector<std::uint8_t> pixelsOf(const cv::Mat& image) {
  return {image.datastart, image.dataend};
}

cv::Mat imageOf(const std::vector<std::uint8_t>& pixels) {
  return cv::Mat(kSize.height, kSize.width, CV_8UC1, const_cast<std::uint8_t*>(pixels.data()))
      .clone();
}

/// Runs a simulated recording through the pipeline.
std::vector<testing::RecordedFrame> deblurred(const SimulatedSequence& sequence,
                                              const DeblurParameters& parameters) {
  testing::RecordingSink sink;
  Deblurrer deblurrer(parameters, sink);
  std::uint32_t sequence_number = 0;
  std::int64_t now_ns = 0;
  constexpr std::size_t kArray = 5000;
  for (std::size_t i = 0; i < sequence.events.size(); i += kArray) {
    const std::vector<Event> array(
        sequence.events.begin() + static_cast<std::ptrdiff_t>(i),
        sequence.events.begin() +
            static_cast<std::ptrdiff_t>(std::min(i + kArray, sequence.events.size())));
    deblurrer.addEvents(testing::wireView(testing::toWire(array)), kSize, ++sequence_number,
                        now_ns);
  }
  for (const SimulatedFrame& frame : sequence.frames) {
    deblurrer.addFrame(
        testing::makeFrame(frame.exposure.at(ExposureInstant::kMid), kSize, pixelsOf(frame.blurry)),
        now_ns);
  }
  deblurrer.finish();
  return sink.outputs;
}

double meanPsnr(const std::vector<testing::RecordedFrame>& outputs,
                const SimulatedSequence& sequence) {
  double sum = 0.0;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    sum += psnr(imageOf(outputs[i].pixels), sequence.frames[i].sharp);
  }
  return sum / static_cast<double>(outputs.size());
}

double meanBlurryPsnr(const SimulatedSequence& sequence) {
  double sum = 0.0;
  for (const SimulatedFrame& frame : sequence.frames) {
    sum += psnr(frame.blurry, frame.sharp);
  }
  return sum / static_cast<double>(sequence.frames.size());
}

class SimulatedDeblurring : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    noisy_settings_ = std::make_unique<SimulationSettings>(shakenPoster(SensorSettings{}));
    noisy_ = std::make_unique<SimulatedSequence>(simulateSequence(*noisy_settings_));
  }
  static void TearDownTestSuite() {
    noisy_.reset();
    noisy_settings_.reset();
  }

  static std::unique_ptr<SimulationSettings> noisy_settings_;
  static std::unique_ptr<SimulatedSequence> noisy_;
};

std::unique_ptr<SimulationSettings> SimulatedDeblurring::noisy_settings_;
std::unique_ptr<SimulatedSequence> SimulatedDeblurring::noisy_;

TEST_F(SimulatedDeblurring, ReachesTheReferenceWithinOneGreyLevelEverywhere) {
  for (const Weighting weighting : {Weighting::kTime, Weighting::kCounter}) {
    for (const ExposureInstant instant :
         {ExposureInstant::kStart, ExposureInstant::kMid, ExposureInstant::kEnd}) {
      DeblurParameters parameters = parametersFor(*noisy_settings_);
      parameters.filter.enabled = false;
      parameters.weighting = weighting;
      parameters.reference = instant;
      const auto outputs = deblurred(*noisy_, parameters);
      ASSERT_EQ(outputs.size(), noisy_->frames.size());
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        ASSERT_TRUE(outputs[i].frame.deblurred);
        const ExposureInterval& window = noisy_->frames[i].exposure;
        const std::vector<double> integral = testing::referenceDoubleIntegral(
            kSize, noisy_->events, parameters.thresholds, weighting, window, window.at(instant));
        const std::vector<std::uint8_t> blurry = pixelsOf(noisy_->frames[i].blurry);
        for (std::size_t p = 0; p < integral.size(); ++p) {
          ASSERT_NEAR(outputs[i].pixels[p], testing::latentGrey(blurry[p], integral[p]), 1)
              << "frame " << i << " pixel " << p;
        }
      }
    }
  }
}

TEST_F(SimulatedDeblurring, CounterWeightingEqualsArrayLikeEdi) {
  const ContrastThresholds equal{0.25, 0.25};
  PixelEventLists lists(kSize, {});
  lists.append(testing::wireView(testing::toWire(noisy_->events)));
  DoubleIntegral integral(kSize, equal, Weighting::kCounter);
  testing::VanillaEdi vanilla(kSize, equal);
  std::vector<float> gain(kSize.pixelCount());
  // O(events x pixels) for the array-like one: a short window does.
  const ExposureInterval& exposure = noisy_->frames[2].exposure;
  const ExposureInterval window{exposure.start_ns,
                                exposure.start_ns + 3 * kNanosecondsPerMillisecond};
  const std::int64_t reference_ns = window.at(ExposureInstant::kMid);
  const IntegrationReport report = integral.integrate(lists, window, reference_ns, gain.data());
  ASSERT_GT(report.events, 1000u);
  vanilla.begin(window, reference_ns);
  for (const Event& event : noisy_->events) {
    vanilla.add(event);
  }
  const std::vector<double> expected = vanilla.doubleIntegral();
  for (std::size_t i = 0; i < gain.size(); ++i) {
    ASSERT_NEAR(1.0 / static_cast<double>(gain[i]) / expected[i], 1.0, 1e-4) << i;
  }
}

TEST_F(SimulatedDeblurring, TimeWeightingBeatsCounterWeightingAndBothBeatTheBlurryFrame) {
  const SimulationSettings settings = shakenPoster(SensorSettings::ideal());
  const SimulatedSequence sequence = simulateSequence(settings);
  DeblurParameters parameters = parametersFor(settings);
  parameters.filter.enabled = false;
  const double by_time = meanPsnr(deblurred(sequence, parameters), sequence);
  parameters.weighting = Weighting::kCounter;
  const double by_counter = meanPsnr(deblurred(sequence, parameters), sequence);
  EXPECT_GT(by_time, by_counter);
  EXPECT_GT(by_counter, meanBlurryPsnr(sequence));
}

TEST_F(SimulatedDeblurring, TheMiddleOfTheExposureIsTheBestInstant) {
  DeblurParameters parameters = parametersFor(*noisy_settings_);
  const double blurry = meanBlurryPsnr(*noisy_);
  EXPECT_GT(meanPsnr(deblurred(*noisy_, parameters), *noisy_), blurry);
  DavisSimulator simulator(*noisy_settings_);
  for (const ExposureInstant instant : {ExposureInstant::kStart, ExposureInstant::kEnd}) {
    parameters.reference = instant;
    const auto outputs = deblurred(*noisy_, parameters);
    double sum = 0.0;
    double blurry_sum = 0.0;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      const cv::Mat truth = simulator.latentAt(noisy_->frames[i].exposure.at(instant));
      sum += psnr(imageOf(outputs[i].pixels), truth);
      blurry_sum += psnr(noisy_->frames[i].blurry, truth);
    }
    // The latent image shows the instant that its stamp says, not another one.
    EXPECT_GT(sum, blurry_sum + 3.0 * static_cast<double>(outputs.size()));
  }
}

TEST_F(SimulatedDeblurring, TheFiltersGainOverPlainEdiUnderNoise) {
  DeblurParameters parameters = parametersFor(*noisy_settings_);
  const double filtered = meanPsnr(deblurred(*noisy_, parameters), *noisy_);
  parameters.filter.enabled = false;
  EXPECT_GT(filtered, meanPsnr(deblurred(*noisy_, parameters), *noisy_));
}

TEST_F(SimulatedDeblurring, MildlyBlurredFramesAreNotHarmed) {
  SimulationSettings settings = shakenPoster(SensorSettings{});
  settings.motion.kind = MotionKind::kMild;
  settings.motion.scale = 0.3;
  settings.scene.illumination = 0.4;
  const SimulatedSequence sequence = simulateSequence(settings);
  EXPECT_GT(meanPsnr(deblurred(sequence, parametersFor(settings)), sequence),
            meanBlurryPsnr(sequence));
}

TEST_F(SimulatedDeblurring, HotPixelsAndFlickerLeaveNoSpecks) {
  SimulationSettings settings = shakenPoster(SensorSettings{});
  settings.motion.kind = MotionKind::kStill;
  settings.sensor.hot_pixel_fraction = 0.001;
  settings.scene.flicker_hz = 100.0;
  settings.scene.flicker_depth = 0.3;
  const SimulatedSequence sequence = simulateSequence(settings);
  const auto outputs = deblurred(sequence, parametersFor(settings));
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    ASSERT_TRUE(outputs[i].frame.deblurred);
    // A speck: a pixel far from the median of its surroundings where the input has none.
    cv::Mat median;
    const cv::Mat image = imageOf(outputs[i].pixels);
    cv::medianBlur(image, median, 3);
    cv::Mat blurry_median;
    cv::medianBlur(sequence.frames[i].blurry, blurry_median, 3);
    for (int y = 1; y + 1 < kSize.height; ++y) {
      for (int x = 1; x + 1 < kSize.width; ++x) {
        const int out = std::abs(image.at<std::uint8_t>(y, x) - median.at<std::uint8_t>(y, x));
        const int in = std::abs(sequence.frames[i].blurry.at<std::uint8_t>(y, x) -
                                blurry_median.at<std::uint8_t>(y, x));
        ASSERT_LE(out, in + 25) << "frame " << i << " at " << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace fast_edi
