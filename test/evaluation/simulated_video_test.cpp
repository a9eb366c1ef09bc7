// The high-rate video of simulated recordings, whose truth is known at every instant.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "evaluation/shaken_poster.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "measures/image_metrics.hpp"
#include "simulation/davis_simulator.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

using testing::shakenPoster;

constexpr SensorSize kSize = testing::kPosterSize;
/// Odd, so that one of them is the middle.
constexpr std::size_t kImages = 11;
constexpr double kAllowedLoss_db = 3.0;

class SimulatedVideo : public ::testing::Test {
 protected:
  void film(const SimulationSettings& settings, ExposureInstant reference = ExposureInstant::kMid,
            bool motion = true) {
    simulator_ = std::make_unique<DavisSimulator>(settings);
    sequence_ = simulateSequence(settings);
    sink_.wants_latent_images = true;
    DeblurParameters parameters = testing::parametersFor(settings);
    parameters.latent.per_exposure = kImages;
    parameters.reference = reference;
    parameters.filter.motion = motion;
    Deblurrer deblurrer(parameters, sink_);
    deblurrer.addEvents(testing::wireView(testing::toWire(sequence_.events)), kSize, 1, 0);
    for (const SimulatedFrame& frame : sequence_.frames) {
      deblurrer.addFrame(testing::makeFrame(frame.exposure.at(ExposureInstant::kMid), kSize,
                                            {frame.blurry.datastart, frame.blurry.dataend}),
                         0);
    }
    deblurrer.finish();
  }

  double psnrAt(std::int64_t t_ns, const std::vector<std::uint8_t>& pixels) const {
    const cv::Mat shown(kSize.height, kSize.width, CV_8UC1,
                        const_cast<std::uint8_t*>(pixels.data()));
    return psnr(shown, simulator_->latentAt(t_ns));
  }
  double psnrAtItsInstant(const testing::RecordedLatent& image) const {
    return psnrAt(image.stamp_ns, image.pixels);
  }
  double meanOfFrames() const {
    double sum_db = 0.0;
    for (const auto& output : sink_.outputs) {
      sum_db += psnrAt(output.frame.stamp_ns, output.pixels);
    }
    return sum_db / static_cast<double>(sink_.outputs.size());
  }

  /// The images within frame \p i's exposure.
  std::vector<testing::RecordedLatent> within(std::size_t i) const {
    const ExposureInterval& exposure = sequence_.frames[i].exposure;
    std::vector<testing::RecordedLatent> images;
    std::copy_if(sink_.latent_images.begin(), sink_.latent_images.end(), std::back_inserter(images),
                 [&exposure](const testing::RecordedLatent& image) {
                   return image.stamp_ns >= exposure.start_ns && image.stamp_ns < exposure.end_ns;
                 });
    return images;
  }

  std::unique_ptr<DavisSimulator> simulator_;
  SimulatedSequence sequence_;
  testing::RecordingSink sink_;
};

TEST_F(SimulatedVideo, IsNowhereMuchWorseThanInTheMiddleOfTheExposure) {
  for (const SensorSettings& sensor : {SensorSettings{}, SensorSettings::ideal()}) {
    sink_.latent_images.clear();
    film(shakenPoster(sensor));
    std::vector<double> mean(kImages, 0.0);
    const auto frames = static_cast<double>(sequence_.frames.size());
    for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
      const auto images = within(i);
      ASSERT_EQ(images.size(), kImages);
      for (std::size_t k = 0; k < kImages; ++k) {
        mean[k] += psnrAtItsInstant(images[k]) / frames;
      }
    }
    const double middle = mean[kImages / 2];
    for (std::size_t k = 0; k < kImages; ++k) {
      EXPECT_GE(mean[k], middle - kAllowedLoss_db) << "instant " << k << " of " << kImages;
    }
  }
}

TEST_F(SimulatedVideo, BeatsTheBlurryFrameAtEveryInstant) {
  film(shakenPoster(SensorSettings{}));
  for (std::size_t i = 0; i < sequence_.frames.size(); ++i) {
    for (const auto& image : within(i)) {
      const double blurry = psnr(sequence_.frames[i].blurry, simulator_->latentAt(image.stamp_ns));
      EXPECT_GT(psnrAtItsInstant(image), blurry + 3.0) << "frame " << i;
    }
  }
}

TEST_F(SimulatedVideo, BridgesGapsBetterThanHoldingTheFrame) {
  film(shakenPoster(SensorSettings{}));
  std::size_t bridged = 0;
  for (const auto& image : sink_.latent_images) {
    const auto holds = [&image](const SimulatedFrame& frame) {
      return image.stamp_ns >= frame.exposure.start_ns && image.stamp_ns < frame.exposure.end_ns;
    };
    if (std::any_of(sequence_.frames.begin(), sequence_.frames.end(), holds)) {
      continue;
    }
    ++bridged;
    const cv::Mat truth = simulator_->latentAt(image.stamp_ns);
    for (const auto& output : sink_.outputs) {
      if (output.frame.input.stamp_ns == image.source_ns) {
        const cv::Mat held(kSize.height, kSize.width, CV_8UC1,
                           const_cast<std::uint8_t*>(output.pixels.data()));
        EXPECT_GT(psnrAtItsInstant(image), psnr(held, truth) + 3.0);
      }
    }
  }
  // 10 ms of each 40 ms, as densely as within the exposures of 30 ms.
  EXPECT_EQ(bridged, 5u * 4u);
}

TEST_F(SimulatedVideo, FramesThatShowAnEndOfTheExposureAreSteadiedByItsMiddle) {
  for (const ExposureInstant reference : {ExposureInstant::kStart, ExposureInstant::kEnd}) {
    double mean_db[2] = {};
    for (const bool motion : {false, true}) {
      sink_.outputs.clear();
      film(shakenPoster(SensorSettings{}), reference, motion);
      ASSERT_EQ(sink_.outputs.size(), sequence_.frames.size());
      mean_db[motion ? 1 : 0] = meanOfFrames();
    }
    EXPECT_GT(mean_db[1], mean_db[0] + 1.0);
  }
}

}  // namespace
}  // namespace fast_edi
