#include "node/comparison_view.hpp"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "fast_edi/messages/event_array.hpp"

namespace fast_edi {
namespace {

using Bgr = std::array<int, 3>;

constexpr SensorSize kSensor{4, 4};

sensor_msgs::Image makeImage(const std::string& encoding, std::uint8_t value) {
  sensor_msgs::Image image;
  image.header.stamp = ros::Time(9, 0);
  image.encoding = encoding;
  image.width = 4;
  image.height = 4;
  const std::uint32_t samples = encoding.rfind("rgba", 0) == 0 || encoding.rfind("bgra", 0) == 0 ? 4
                                : encoding.rfind("rgb", 0) == 0 || encoding.rfind("bgr", 0) == 0
                                    ? 3
                                    : 1;
  const std::uint32_t bytes = samples * (encoding.find("16") != std::string::npos ? 2 : 1);
  image.step = 4 * bytes;
  image.data.assign(image.step * image.height, value);
  return image;
}

Bgr pixel(const sensor_msgs::Image& image, std::size_t x, std::size_t y) {
  const std::uint8_t* p = image.data.data() + y * image.step + 3 * x;
  return {p[0], p[1], p[2]};
}

class ComparisonViewTest : public ::testing::Test {
 protected:
  ComparisonView view_;
  ExposureInterval window_{1000, 2000};
};

TEST_F(ComparisonViewTest, ShowsInputEventsAndOutputSideBySide) {
  EventArray array;
  array.append({0, 0, 1000, true});
  array.append({1, 2, 1999, false});
  view_.addEvents(array.events(), kSensor, {});
  const auto picture = view_.draw(makeImage("mono8", 50), makeImage("mono8", 90), window_);
  EXPECT_EQ(picture->encoding, "bgr8");
  EXPECT_EQ(picture->width, 12u);
  EXPECT_EQ(picture->height, 4u);
  EXPECT_EQ(picture->header.stamp, ros::Time(9, 0));
  EXPECT_EQ(pixel(*picture, 3, 3), (Bgr{50, 50, 50}));
  EXPECT_EQ(pixel(*picture, 8, 0), (Bgr{90, 90, 90}));
  EXPECT_EQ(pixel(*picture, 4, 1), (Bgr{255, 255, 255})) << "no event there";
  const Bgr on = pixel(*picture, 4, 0);
  EXPECT_GT(on[2], on[0]) << "an ON event is red";
  const Bgr off = pixel(*picture, 5, 2);
  EXPECT_GT(off[0], off[2]) << "an OFF event is blue";
}

TEST_F(ComparisonViewTest, ShowsOnlyEventsOfTheExposureAndOnTheImage) {
  EventArray array;
  array.append({0, 0, 999, true});
  array.append({4, 0, 1500, true});
  array.append({0, 4, 1500, true});
  array.append({0, 0, 2000, true});
  view_.addEvents(array.events(), kSensor, {});
  const auto picture = view_.draw(makeImage("mono8", 50), makeImage("mono8", 90), window_);
  for (std::size_t y = 0; y < 4; ++y) {
    for (std::size_t x = 4; x < 8; ++x) {
      EXPECT_EQ(pixel(*picture, x, y), (Bgr{255, 255, 255}));
    }
  }
}

TEST_F(ComparisonViewTest, ShowsEventsAsTheyAreMappedToTheFrame) {
  EventArray array;
  array.append({3, 0, 1500, true});
  view_.addEvents(array.events(), kSensor, {EventPolarity::kInverted, EventOrientation::kFlipX});
  const auto picture = view_.draw(makeImage("mono8", 50), makeImage("mono8", 90), window_);
  const Bgr off = pixel(*picture, 4, 0);
  EXPECT_GT(off[0], off[2]);
  EXPECT_EQ(pixel(*picture, 7, 0), (Bgr{255, 255, 255}));
}

TEST_F(ComparisonViewTest, DrawsEveryEncodingThatIsDeblurred) {
  for (const char* encoding : {"mono8", "8UC1", "mono16", "bayer_rggb8", "bayer_gbrg16", "rgb8",
                               "bgr8", "rgba8", "bgra8", "rgb16", "bgr16", "rgba16", "bgra16"}) {
    const sensor_msgs::Image image = makeImage(encoding, 80);
    EXPECT_EQ(pixel(*view_.draw(image, image, window_), 1, 1), (Bgr{80, 80, 80})) << encoding;
  }
}

TEST_F(ComparisonViewTest, DrawsImagesWhoseRowsDoNotFillTheMessage) {
  for (const std::string encoding : {"mono8", "8UC1", "mono16", "rgb8", "bayer_rggb8"}) {
    const sensor_msgs::Image dense = makeImage(encoding, 60);
    sensor_msgs::Image padded = dense;
    padded.step += 3;
    // With and without the padding of the last row.
    for (const std::size_t size : {padded.step * 3 + dense.step, padded.step * 4}) {
      padded.data.assign(size, 60);
      EXPECT_EQ(view_.draw(padded, dense, window_)->data, view_.draw(dense, dense, window_)->data)
          << encoding;
    }
  }
}

TEST_F(ComparisonViewTest, KeepsABoundedNumberOfEvents) {
  EventArray old_events;
  old_events.append({0, 0, 1000, true});
  view_.addEvents(old_events.events(), kSensor, {});
  EventArray many;
  many.reserve(ComparisonView::kMaxEvents + 1);
  many.append({1, 0, 1000, true});
  for (std::size_t i = 0; i < ComparisonView::kMaxEvents; ++i) {
    many.append({2, 0, 1000, true});
  }
  view_.addEvents(many.events(), kSensor, {});
  const auto picture = view_.draw(makeImage("mono8", 50), makeImage("mono8", 90), window_);
  EXPECT_EQ(pixel(*picture, 4, 0), (Bgr{255, 255, 255}));
  EXPECT_EQ(pixel(*picture, 5, 0), (Bgr{255, 255, 255}));
  EXPECT_EQ(pixel(*picture, 6, 0), (Bgr{0, 0, 255}));
  view_.clear();
  EXPECT_EQ(pixel(*view_.draw(makeImage("mono8", 50), makeImage("mono8", 90), window_), 6, 0),
            (Bgr{255, 255, 255}));
}

}  // namespace
}  // namespace fast_edi
