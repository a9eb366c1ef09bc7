/// Image messages: from the wire, to the pipeline, to the outgoing image with its camera_info and
/// the comparison picture.
///
/// Input: one byte, then a serialised sensor_msgs/Image (odd byte), or the fields of one (even).
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fuzzer/FuzzedDataProvider.h>
#include <ros/serialization.h>
#include <sensor_msgs/image_encodings.h>
#include <boost/make_shared.hpp>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/messages/message_frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"
#include "fuzz/fuzzing.hpp"
#include "node/comparison_view.hpp"
#include "support/event_generators.hpp"

namespace {

using fast_edi::fuzzing::require;
namespace encodings = sensor_msgs::image_encodings;

constexpr std::int64_t kMs = fast_edi::kNanosecondsPerMillisecond;

std::string anyEncoding(FuzzedDataProvider& input) {
  const std::vector<std::string> known{
      encodings::MONO8,       encodings::TYPE_8UC1,  encodings::MONO16,
      encodings::RGB8,        encodings::BGR8,       encodings::BAYER_RGGB8,
      encodings::BAYER_GBRG8, encodings::TYPE_16UC1, encodings::TYPE_32FC1};
  const auto index = input.ConsumeIntegralInRange<std::size_t>(0, known.size());
  return index < known.size() ? known[index] : input.ConsumeRandomLengthString(32);
}

std::uint32_t anyLength(FuzzedDataProvider& input) {
  return input.ConsumeBool() ? input.ConsumeIntegralInRange<std::uint32_t>(0, 20)
                             : input.ConsumeIntegral<std::uint32_t>();
}

sensor_msgs::ImageConstPtr imageFromFields(FuzzedDataProvider& input) {
  const auto image = boost::make_shared<sensor_msgs::Image>();
  image->header.stamp = {input.ConsumeIntegral<std::uint32_t>(),
                         input.ConsumeIntegralInRange<std::uint32_t>(0, 999'999'999)};
  image->encoding = anyEncoding(input);
  image->is_bigendian = input.ConsumeIntegralInRange<std::uint8_t>(0, 2);
  image->width = anyLength(input);
  image->height = anyLength(input);
  image->step = anyLength(input);
  image->data = input.ConsumeRemainingBytes<std::uint8_t>();
  return image;
}

/// \return null when the message is refused
sensor_msgs::ImageConstPtr imageFromWire(const std::uint8_t* data, std::size_t size) {
  fast_edi::BagMessage raw;
  raw.data = data;
  raw.size = static_cast<std::uint32_t>(size);
  try {
    return fast_edi::deserialise<sensor_msgs::Image>(raw);
  } catch (const ros::serialization::StreamOverrunException&) {
    return nullptr;
  }
}

/// One frame through everything, amid events where its size is a sensor's.
void deblur(const sensor_msgs::ImageConstPtr& message, fast_edi::ExposureInstant reference) {
  const fast_edi::ImageReading reading = fast_edi::readImage(*message);
  if (reading.verdict == fast_edi::ImageVerdict::kMalformed) {
    require(!reading.reason.empty(), "a refusal says why");
    return;
  }
  fast_edi::DeblurParameters parameters;
  parameters.thresholds = {0.3, 0.2};
  parameters.exposure_source = fast_edi::ExposureSource::kParameter;
  parameters.exposure_time_ns = 10 * kMs;
  parameters.reference = reference;
  fast_edi::ComparisonView comparison;
  int outputs = 0;
  fast_edi::MessageFrameSink sink(
      "camera", [&](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                    const fast_edi::OutputFrame& output) {
        ++outputs;
        require(image->width == message->width && image->height == message->height &&
                    image->encoding == message->encoding,
                "size and encoding stay");
        require(info->header.stamp == image->header.stamp &&
                    info->header.frame_id == image->header.frame_id &&
                    info->width == image->width && info->height == image->height,
                "camera_info is that of the image");
        if (output.input.supported) {
          static_cast<void>(comparison.draw(*message, *image, output.exposure));
        }
      });
  fast_edi::Deblurrer deblurrer(parameters, sink);
  const fast_edi::InputFrame frame = fast_edi::makeInputFrame(message, reading, 0);
  if (reading.verdict == fast_edi::ImageVerdict::kSupported && frame.stamp_ns > kMs * 20 &&
      message->header.stamp.sec < UINT32_MAX) {
    const std::vector<std::uint8_t> records = fast_edi::testing::toWire(
        {{0, 0, frame.stamp_ns - 20 * kMs, true},
         {0, 0, frame.stamp_ns - kMs, true},
         {static_cast<std::uint16_t>(frame.image.size.width - 1),
          static_cast<std::uint16_t>(frame.image.size.height - 1), frame.stamp_ns + kMs, false},
         {0, 0, frame.stamp_ns + 20 * kMs, true}});
    const fast_edi::WireEvents events = fast_edi::testing::wireView(records);
    comparison.addEvents(events, frame.image.size, {});
    deblurrer.addEvents(events, frame.image.size, 1, 0);
  }
  deblurrer.addFrame(frame, 1);
  deblurrer.finish();
  require(outputs == 1, "one output for the frame");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto reference = static_cast<fast_edi::ExposureInstant>(data[0] / 2 % 3);
  sensor_msgs::ImageConstPtr image;
  if (data[0] % 2 == 1) {
    image = imageFromWire(data + 1, size - 1);
  } else {
    FuzzedDataProvider input(data + 1, size - 1);
    image = imageFromFields(input);
  }
  if (image) {
    deblur(image, reference);
  }
  return 0;
}
