/// record_calls RECORDING CALLS: writes the calls that deblur_bag would make of the pipeline.
/// Topics are those of the DAVIS driver.
#include <algorithm>
#include <cstdint>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "calls.hpp"
#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/open_messages.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "fast_edi/messages/message_conversion.hpp"

namespace {

void record(const fast_edi::BagMessage& message, std::int64_t now_ns,
            fast_edi::arm64::CallWriter& writer) {
  const std::string& topic = message.connection->topic;
  if (topic == "/dvs/events") {
    const auto array = fast_edi::deserialise<fast_edi::EventArrayView>(message);
    writer.addEvents(array->events(), fast_edi::sensorSize(*array), array->header.seq, now_ns);
  } else if (topic == "/dvs/image_raw") {
    const auto image = fast_edi::deserialise<sensor_msgs::Image>(message);
    const fast_edi::ImageReading reading = fast_edi::readImage(*image);
    writer.addFrame({static_cast<std::int64_t>(image->header.stamp.toNSec()), reading.view,
                     reading.verdict == fast_edi::ImageVerdict::kSupported, nullptr},
                    now_ns);
  } else if (topic == "/dvs/exposure") {
    writer.addExposure(fast_edi::deserialise<std_msgs::Int32>(message)->data, now_ns);
  } else {
    writer.advance(now_ns);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: record_calls RECORDING CALLS\n";
    return 1;
  }
  try {
    const std::unique_ptr<fast_edi::MessageSource> recording = fast_edi::openMessages(argv[1]);
    fast_edi::arm64::CallWriter writer(argv[2]);
    fast_edi::BagMessage message;
    std::int64_t now_ns = 0;
    while (recording->next(message)) {
      now_ns = std::max(now_ns, static_cast<std::int64_t>(message.time.toNSec()));
      record(message, now_ns, writer);
    }
    writer.close();
  } catch (const std::exception& error) {
    std::cerr << "record_calls: " << error.what() << "\n";
    return 1;
  }
  return 0;
}
