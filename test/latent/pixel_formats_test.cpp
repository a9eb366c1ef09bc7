/// Colours and photosites, of 8 and 16 bits, come out of the pipeline as grey frames would.
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/pipeline/deblurrer.hpp"
#include "support/event_generators.hpp"
#include "support/pipeline_input.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr SensorSize kSize{40, 30};
constexpr std::int64_t kFrames = 3;

using Plane = std::vector<int>;

/// Samples of a frame; those of each channel differ, alpha included.
Plane makeChannel(int channel, std::int64_t frame, PixelFormat format) {
  Plane plane;
  for (const std::uint8_t level :
       testing::makeGreyImage(kSize, static_cast<std::uint64_t>(10 * frame + channel))) {
    // Not whole 8-bit levels.
    plane.push_back(level * dnPerDn8(format) + (bytesPerSample(format) == 2 ? 31 * channel : 0));
  }
  return plane;
}

void putSample(int level, PixelFormat format, std::vector<std::uint8_t>& bytes) {
  bytes.push_back(static_cast<std::uint8_t>(level & 0xff));
  if (bytesPerSample(format) == 2) {
    bytes.push_back(static_cast<std::uint8_t>(level >> 8));
  }
}

/// The samples of one channel.
Plane planeOf(const std::vector<std::uint8_t>& bytes, int channel, PixelFormat format) {
  Plane plane;
  for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
    const std::uint8_t* sample = bytes.data() +
                                 i * static_cast<std::size_t>(bytesPerPixel(format)) +
                                 channel * bytesPerSample(format);
    plane.push_back(sample[0] + (bytesPerSample(format) == 2 ? 256 * sample[1] : 0));
  }
  return plane;
}

/// What the pipeline makes of frames whose samples are those of \p channels_in.
std::vector<testing::RecordedFrame> deblurred(const std::vector<int>& channels_in,
                                              PixelFormat format) {
  DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.25};
  parameters.exposure_source = ExposureSource::kParameter;
  parameters.exposure_time_ns = 20 * kMs;
  parameters.filter.temporal = 0.5;
  // Learned from the mean of the colours, which differs.
  parameters.refine_contrast = false;
  parameters.refine_delay = false;
  testing::RecordingSink sink;
  Deblurrer deblurrer(parameters, sink);
  for (std::int64_t i = 0; i < kFrames; ++i) {
    std::vector<Plane> planes;
    for (const int channel : channels_in) {
      planes.push_back(makeChannel(channel, i, format));
    }
    auto pixels = std::make_shared<std::vector<std::uint8_t>>();
    for (std::size_t pixel = 0; pixel < kSize.pixelCount(); ++pixel) {
      for (const Plane& plane : planes) {
        putSample(plane[pixel], format, *pixels);
      }
    }
    const std::int64_t start_ns = kNanosecondsPerSecond + i * 40 * kMs;
    InputFrame frame;
    frame.stamp_ns = start_ns + 15 * kMs;
    frame.image = {pixels->data(), kSize,
                   static_cast<std::size_t>(kSize.width * bytesPerPixel(format)), format};
    frame.owner = pixels;
    deblurrer.addFrame(frame, start_ns);
    const auto events =
        testing::makeEvents(testing::EventScene::kMovingEdges,
                            {kSize, 5000, start_ns, 40 * kMs, static_cast<std::uint64_t>(i) + 1});
    deblurrer.addEvents(testing::wireView(testing::toWire(events)), kSize,
                        static_cast<std::uint32_t>(i) + 1, start_ns + 40 * kMs);
  }
  deblurrer.finish();
  EXPECT_EQ(deblurrer.counters().frames_deblurred, static_cast<std::uint64_t>(kFrames));
  return sink.outputs;
}

PixelFormat greyOf(PixelFormat format) {
  return bytesPerSample(format) == 2 ? PixelFormat::kMono16 : PixelFormat::kMono8;
}

TEST(PixelFormats, EachColourIsThatOfAGreyFrame) {
  for (const PixelFormat format : {PixelFormat::kColour8, PixelFormat::kColour16,
                                   PixelFormat::kColourAlpha8, PixelFormat::kColourAlpha16}) {
    const std::vector<int> all = hasAlpha(format) ? std::vector<int>{0, 1, 2, 3}  //
                                                  : std::vector<int>{0, 1, 2};
    const auto outputs = deblurred(all, format);
    ASSERT_EQ(outputs.size(), static_cast<std::size_t>(kFrames));
    for (int channel = 0; channel < channels(format); ++channel) {
      SCOPED_TRACE("format " + std::to_string(static_cast<int>(format)) + ", channel " +
                   std::to_string(channel));
      const auto grey = deblurred({channel}, greyOf(format));
      ASSERT_EQ(grey.size(), outputs.size());
      for (std::size_t i = 0; i < outputs.size(); ++i) {
        EXPECT_EQ(planeOf(outputs[i].pixels, channel, format),
                  planeOf(grey[i].pixels, 0, greyOf(format)));
      }
      EXPECT_NE(planeOf(outputs[0].pixels, channel, format), makeChannel(channel, 0, format))
          << "nothing was deblurred";
    }
  }
}

TEST(PixelFormats, AlphaPassesThroughUnchanged) {
  for (const PixelFormat format : {PixelFormat::kColourAlpha8, PixelFormat::kColourAlpha16}) {
    const auto outputs = deblurred({0, 1, 2, 3}, format);
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      EXPECT_EQ(planeOf(outputs[i].pixels, 3, format),
                makeChannel(3, static_cast<std::int64_t>(i), format));
    }
  }
}

TEST(PixelFormats, PhotositesOf16BitsAreThoseOf8BitsFinerGraded) {
  const auto fine = deblurred({0}, PixelFormat::kBayer16);
  const auto coarse = deblurred({0}, PixelFormat::kBayer8);
  ASSERT_EQ(fine.size(), coarse.size());
  const Plane fine_plane = planeOf(fine[0].pixels, 0, PixelFormat::kBayer16);
  const Plane coarse_plane = planeOf(coarse[0].pixels, 0, PixelFormat::kBayer8);
  for (std::size_t i = 0; i < fine_plane.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(fine_plane[i]) / kDn16PerDn8, coarse_plane[i], 1.6) << i;
  }
  // Neighbours of other colours have no part in a photosite.
  EXPECT_NE(fine_plane,
            planeOf(deblurred({0}, PixelFormat::kMono16)[0].pixels, 0, PixelFormat::kMono16));
}

}  // namespace
}  // namespace fast_edi
