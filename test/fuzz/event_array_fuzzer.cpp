/// Event arrays from the wire: decoding by both C++ types, then the pipeline's intake.
///
/// Input: messages one behind the other, each with its length in front (two bytes). One of length 0
/// asks for a frame instead, which makes the pipeline use the events.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <ros/serialization.h>

#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "fuzz/fuzzing.hpp"
#include "support/pipeline_input.hpp"
#include "support/schedule_checker.hpp"

namespace {

using fast_edi::SensorSize;
using fast_edi::fuzzing::require;
using fast_edi::fuzzing::requireNoFault;

/// A frame of a larger sensor says nothing more about events and costs its time.
constexpr std::size_t kMaxFramePixels = 4096;
constexpr std::int64_t kTick_ns = 3 * fast_edi::kNanosecondsPerMillisecond;

/// \return false when the message is refused
template <typename Array>
bool decode(std::uint8_t* bytes, std::uint32_t size, Array& array) {
  try {
    ros::serialization::IStream stream(bytes, size);
    ros::serialization::deserialize(stream, array);
    return true;
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
}

class Intake {
 public:
  Intake() : deblurrer_(parameters(), sink_), checker_(deblurrer_, sink_) {}

  void addMessage(const std::uint8_t* bytes, std::size_t size) {
    // Memory of just that size, so that a sanitizer sees any byte read beyond.
    const std::unique_ptr<std::uint8_t[]> message(new std::uint8_t[size]);
    std::memcpy(message.get(), bytes, size);
    fast_edi::EventArray owner;
    fast_edi::EventArrayView view;
    const bool decoded = decode(message.get(), static_cast<std::uint32_t>(size), owner);
    require(decode(message.get(), static_cast<std::uint32_t>(size), view) == decoded,
            "both types of event arrays refuse the same messages");
    if (!decoded) {
      return;
    }
    const fast_edi::WireEvents events = view.events();
    require(events.count == owner.events().count &&
                (events.empty() || std::memcmp(events.data, owner.events().data,
                                               events.count * fast_edi::kWireEventBytes) == 0),
            "both types of event arrays hold the same events");
    size_ = fast_edi::sensorSize(view);
    if (!events.empty()) {
      newest_ns_ = fast_edi::decodeWireEvent(events.record(events.count - 1)).t_ns;
    }
    checker_.expectEvents(events.count);
    deblurrer_.addEvents(events, size_, view.header.seq, now_ns_ += kTick_ns);
    requireNoFault(checker_.fault());
  }

  /// A frame whose exposure ends with the newest event.
  void addFrame() {
    if (size_.pixelCount() == 0 || size_.pixelCount() > kMaxFramePixels) {
      return;
    }
    deblurrer_.addFrame(checker_.expect(fast_edi::testing::makeFlatFrame(newest_ns_, size_)),
                        now_ns_ += kTick_ns);
    requireNoFault(checker_.fault());
  }

  void finish() {
    deblurrer_.finish();
    requireNoFault(checker_.faultAtEnd());
  }

 private:
  static fast_edi::DeblurParameters parameters() {
    fast_edi::DeblurParameters parameters;
    parameters.thresholds = {0.3, 0.2};
    parameters.exposure_source = fast_edi::ExposureSource::kParameter;
    parameters.exposure_time_ns = 10 * fast_edi::kNanosecondsPerMillisecond;
    parameters.stamp_reference = fast_edi::ExposureInstant::kEnd;
    parameters.reference = fast_edi::ExposureInstant::kEnd;
    parameters.max_buffered_events = 1000;
    return parameters;
  }

  fast_edi::testing::RecordingSink sink_;
  fast_edi::Deblurrer deblurrer_;
  fast_edi::testing::ScheduleChecker checker_;
  SensorSize size_;
  std::int64_t newest_ns_ = 0;
  std::int64_t now_ns_ = 0;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Intake intake;
  while (size >= sizeof(std::uint16_t)) {
    std::uint16_t length = 0;
    std::memcpy(&length, data, sizeof(length));
    data += sizeof(length);
    size -= sizeof(length);
    const std::size_t taken = std::min<std::size_t>(length, size);
    if (taken == 0) {
      intake.addFrame();
    } else {
      intake.addMessage(data, taken);
    }
    data += taken;
    size -= taken;
  }
  intake.finish();
  return 0;
}
