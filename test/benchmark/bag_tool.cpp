/// \file
/// The other side of the deblur_bag figures: makes a large recording, and copies one through
/// rosbag's C++ API, the plain way that deblur_bag is measured against.
///
///     bag_tool make OUT.bag SECONDS MEV_PER_S
///     bag_tool copy IN.bag OUT.bag

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/event_array.hpp"
#include "support/event_generators.hpp"

namespace {

using fast_edi::kNanosecondsPerMicrosecond;
using fast_edi::kNanosecondsPerMillisecond;
using fast_edi::kNanosecondsPerSecond;

constexpr fast_edi::SensorSize kSize{346, 260};
constexpr std::int64_t kFirstStamp_ns = 1'000'000'000 * kNanosecondsPerSecond;
constexpr std::int64_t kArray_ns = 10 * kNanosecondsPerMillisecond;
constexpr std::int64_t kFramePeriod_ns = 40 * kNanosecondsPerMillisecond;
constexpr std::int64_t kExposure_ns = 30 * kNanosecondsPerMillisecond;

ros::Time rosTime(std::int64_t t_ns) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(t_ns));
  return time;
}

void make(const std::string& path, double seconds, double rate_mev_s) {
  rosbag::Bag bag(path, rosbag::bagmode::Write);
  const auto end_ns = kFirstStamp_ns + static_cast<std::int64_t>(seconds * kNanosecondsPerSecond);
  // rate [1/us] * array [ns] / 1000
  const auto count = static_cast<std::size_t>(rate_mev_s * static_cast<double>(kArray_ns) /
                                              kNanosecondsPerMicrosecond);
  std::vector<std::uint8_t> wire = fast_edi::testing::toWire(fast_edi::testing::makeEvents(
      fast_edi::testing::EventScene::kUniform, {kSize, count, kFirstStamp_ns, kArray_ns, 1}));
  sensor_msgs::Image image;
  image.width = kSize.width;
  image.height = kSize.height;
  image.step = kSize.width;
  image.encoding = sensor_msgs::image_encodings::MONO8;
  image.data = fast_edi::testing::makeGreyImage(kSize, 1);

  fast_edi::EventArray array;
  array.width = kSize.width;
  array.height = kSize.height;
  std::int64_t next_frame_ns = kFirstStamp_ns;
  for (std::int64_t t_ns = kFirstStamp_ns; t_ns < end_ns; t_ns += kArray_ns) {
    array.assign(fast_edi::testing::wireView(wire));
    ++array.header.seq;
    array.header.stamp = rosTime(t_ns);
    bag.write("/dvs/events", rosTime(t_ns + kArray_ns), array);
    fast_edi::testing::shiftStamps(kArray_ns, wire);
    if (t_ns + kArray_ns >= next_frame_ns + kExposure_ns) {
      image.header.stamp = rosTime(next_frame_ns + kExposure_ns / 2);
      bag.write("/dvs/image_raw", rosTime(t_ns + kArray_ns), image);
      std_msgs::Int32 exposure;
      exposure.data = static_cast<std::int32_t>(kExposure_ns / kNanosecondsPerMicrosecond);
      bag.write("/dvs/exposure", rosTime(t_ns + kArray_ns), exposure);
      next_frame_ns += kFramePeriod_ns;
    }
  }
  bag.close();
}

void copy(const std::string& in, const std::string& out) {
  const auto begin = std::chrono::steady_clock::now();
  rosbag::Bag input(in, rosbag::bagmode::Read);
  rosbag::Bag output(out, rosbag::bagmode::Write);
  for (const rosbag::MessageInstance& message : rosbag::View(input)) {
    output.write(message.getTopic(), message.getTime(), message, message.getConnectionHeader());
  }
  output.close();
  std::printf("{\"seconds\": %.3f}\n",
              std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  try {
    if (command == "make" && argc == 5) {
      make(argv[2], std::stod(argv[3]), std::stod(argv[4]));
    } else if (command == "copy" && argc == 4) {
      copy(argv[2], argv[3]);
    } else {
      std::cerr
          << "usage: bag_tool make OUT.bag SECONDS MEV_PER_S | bag_tool copy IN.bag OUT.bag\n";
      return EXIT_FAILURE;
    }
  } catch (const std::exception& error) {
    std::cerr << "bag_tool: " << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
