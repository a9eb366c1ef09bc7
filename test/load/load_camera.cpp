#include "load/load_camera.hpp"

#include <algorithm>
#include <array>
#include <thread>

#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>
#include <boost/make_shared.hpp>

#include "support/event_generators.hpp"

namespace fast_edi::load {
namespace {

constexpr std::uint32_t kQueue = 1000;
constexpr std::int64_t kZero_ns = 1'000'000'000 * kNanosecondsPerSecond;
constexpr std::int64_t kLongestArray_ns = 10 * kNanosecondsPerMillisecond;
constexpr double kLargestArray = 100'000;  // events; drivers have such a limit, too
/// Events of an array that is sent as the last one is taken. Shorter than the time between two.
constexpr std::int64_t kBurst_ns = 100 * kNanosecondsPerMicrosecond;
constexpr std::int64_t kFramePeriod_ns = kNanosecondsPerSecond / 30;
constexpr std::int64_t kExposure_ns = 30 * kNanosecondsPerMillisecond;
/// From the end of an exposure to its image.
constexpr std::int64_t kReadout_ns = 4 * kNanosecondsPerMillisecond;
constexpr std::chrono::microseconds kPollInterval{200};

}  // namespace

LoadCamera::LoadCamera(const std::string& ns)
    : nh_(ns),
      events_(nh_.advertise<EventArray>("events", kQueue)),
      image_(nh_.advertise<sensor_msgs::Image>("image_raw", kQueue)),
      exposure_(nh_.advertise<std_msgs::Int32>("exposure", kQueue)),
      zero_(Clock::now()) {
  frame_.width = static_cast<std::uint32_t>(kSensor.width);
  frame_.height = static_cast<std::uint32_t>(kSensor.height);
  frame_.step = frame_.width;
  frame_.encoding = sensor_msgs::image_encodings::MONO8;
  frame_.data = testing::makeGreyImage(kSensor, 1);
}

bool LoadCamera::hasSubscribers() const {
  return events_.getNumSubscribers() > 0 && image_.getNumSubscribers() > 0 &&
         exposure_.getNumSubscribers() > 0;
}

LoadCamera::Sent LoadCamera::sendAsTaken(std::size_t events, double seconds) {
  begin(events, kBurst_ns);
  std::array<boost::weak_ptr<const EventArray>, 2> on_the_way;
  const auto begin = Clock::now();
  const auto end = begin + std::chrono::duration<double>(seconds);
  while (Clock::now() < end) {
    bool sent = false;
    for (auto& array : on_the_way) {
      const std::int64_t start_ns = now() - kBurst_ns;
      if (array.expired() && start_ns >= wire_start_ns_ + kBurst_ns) {
        array = sendArray(start_ns);
        sent = true;
      }
    }
    sendDueFrames();
    if (!sent) {
      std::this_thread::sleep_for(kPollInterval);
    }
  }
  sent_.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return sent_;
}

LoadCamera::Sent LoadCamera::sendAtRate(double events_per_second, double seconds) {
  const std::int64_t array_ns = std::min(
      kLongestArray_ns,
      static_cast<std::int64_t>(kLargestArray * kNanosecondsPerSecond / events_per_second));
  begin(static_cast<std::size_t>(events_per_second * static_cast<double>(array_ns) /
                                 kNanosecondsPerSecond),
        array_ns);
  const auto begin = Clock::now();
  const std::int64_t end_ns =
      now() + static_cast<std::int64_t>(seconds * static_cast<double>(kNanosecondsPerSecond));
  // A thread that gets too little time leaves out what it is late for rather than stay behind.
  for (std::int64_t start_ns = now(); start_ns < end_ns;
       start_ns = std::max(start_ns + array_ns, now() - array_ns)) {
    std::this_thread::sleep_until(zero_ + std::chrono::nanoseconds(start_ns + array_ns - kZero_ns));
    sendArray(start_ns);
    sendDueFrames();
  }
  sent_.seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  return sent_;
}

Clock::time_point LoadCamera::sentAt(std::int64_t stamp_ns) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return sent_at_.at(stamp_ns);
}

void LoadCamera::begin(std::size_t events, std::int64_t span_ns) {
  wire_start_ns_ = now() - kNanosecondsPerSecond;  // it can only be moved on
  wire_ = testing::toWire(testing::makeEvents(testing::EventScene::kUniform,
                                              {kSensor, events, wire_start_ns_, span_ns, 1}));
  next_frame_ns_ = now();
  sent_ = {};
}

std::int64_t LoadCamera::now() const {
  return kZero_ns +
         std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - zero_).count();
}

boost::weak_ptr<const EventArray> LoadCamera::sendArray(std::int64_t start_ns) {
  testing::shiftStamps(start_ns - wire_start_ns_, wire_);
  wire_start_ns_ = start_ns;
  const auto array = boost::make_shared<EventArray>();
  array->header.seq = sequence_++;
  array->width = frame_.width;
  array->height = frame_.height;
  array->assign(testing::wireView(wire_));
  events_.publish(EventArray::ConstPtr(array));
  ++sent_.arrays;
  sent_.events += array->events().count;
  return array;
}

void LoadCamera::sendDueFrames() {
  for (; next_frame_ns_ + kExposure_ns + kReadout_ns <= now(); next_frame_ns_ += kFramePeriod_ns) {
    const std::int64_t stamp_ns = next_frame_ns_ + kExposure_ns / 2;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      sent_at_[stamp_ns] = Clock::now();
    }
    const auto image = boost::make_shared<sensor_msgs::Image>(frame_);
    image->header.stamp.fromNSec(static_cast<std::uint64_t>(stamp_ns));
    image_.publish(sensor_msgs::ImageConstPtr(image));
    std_msgs::Int32 exposure;
    exposure.data = static_cast<std::int32_t>(kExposure_ns / kNanosecondsPerMicrosecond);
    exposure_.publish(exposure);
    ++sent_.frames;
  }
}

}  // namespace fast_edi::load
