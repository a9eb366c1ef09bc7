#include "fast_edi/bags/bag_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <ros/serialization.h>
#include <sensor_msgs/image_encodings.h>
#include <std_msgs/Int32.h>
#include <boost/make_shared.hpp>

#include "fast_edi/bags/bag_deserialise.hpp"
#include "fast_edi/messages/event_array.hpp"
#include "pipeline/frame_renderer.hpp"

namespace fast_edi {
namespace {

std::vector<std::uint8_t> trustPixels(const std::vector<float>& trust) {
  constexpr float kMost = 255.0F;
  std::vector<std::uint8_t> pixels;
  pixels.reserve(trust.size());
  for (const float share : trust) {
    pixels.push_back(static_cast<std::uint8_t>(std::lround(kMost * share)));
  }
  return pixels;
}

/// \param trust of its pixels; empty: none is trusted
sensor_msgs::ImagePtr makeTrustImage(const sensor_msgs::Image& like,
                                     std::vector<std::uint8_t> trust) {
  auto image = boost::make_shared<sensor_msgs::Image>();
  image->header = like.header;
  image->width = like.width;
  image->height = like.height;
  image->step = like.width;
  image->encoding = sensor_msgs::image_encodings::MONO8;
  image->data = std::move(trust);
  image->data.resize(std::size_t{like.width} * like.height);
  return image;
}

}  // namespace

BagPipeline::BagPipeline(const TopicNames& topics, const LoadedParameters& parameters)
    : topics_(topics),
      camera_info_topic_(topics.cameraInfo()),
      sink_(parameters.ros.frame_id,
            [this](const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                   const OutputFrame& frame) {
              // Only kept here: the pipeline's calls must not throw, and writing to a full disk
              // does.
              outputs_.push_back({image, info, frame, {}, nullptr, std::exchange(work_, nullptr)});
              if (shows_trust_) {
                outputs_.back().trust = makeTrustImage(*image, std::exchange(trust_, {}));
              }
            }),
      deblurrer_(parameters.deblur, sink_) {
  sink_.setLatent([] { return true; },
                  [this](const sensor_msgs::ImagePtr& image) {
                    outputs_.back().latent.push_back(image);  // its frame came in the same call
                  });
}

void BagPipeline::showTrust() {
  shows_trust_ = true;
  sink_.setTrust([this](const std::vector<float>& trust) { trust_ = trustPixels(trust); });
}

void BagPipeline::deferWork() {
  sink_.setDefer([this](const FrameWork& work) { work_ = work; });
}

void BagPipeline::complete(Output& output, FrameRenderer& renderer) {
  if (output.work && output.work(renderer) && output.trust) {
    output.trust = makeTrustImage(*output.image, trustPixels(renderer.trust()));
  }
  output.work = nullptr;  // with the memory that it holds
}

bool BagPipeline::add(const BagMessage& message) {
  // A damaged record time must not turn the clock back.
  now_ns_ = std::max(now_ns_, static_cast<std::int64_t>(message.time.toNSec()));
  deblurrer_.advance(now_ns_);
  return use(message);
}

void BagPipeline::finish() {
  deblurrer_.finish();
}

std::vector<BagPipeline::Output> BagPipeline::takeOutputs() {
  return std::exchange(outputs_, {});
}

BagPipeline::Use BagPipeline::useOf(const BagConnection& connection) const {
  if (connection.topic == topics_.events) {
    return Use::kEvents;
  }
  if (connection.topic == topics_.image) {
    return Use::kImage;
  }
  if (connection.topic == topics_.exposure) {
    return Use::kExposure;
  }
  return connection.topic == camera_info_topic_ ? Use::kCameraInfo : Use::kNone;
}

bool BagPipeline::use(const BagMessage& message) {
  try {
    switch (useOf(*message.connection)) {
      case Use::kEvents: {
        const auto array = deserialise<EventArrayView>(message);
        deblurrer_.addEvents(array->events(), sensorSize(*array), array->header.seq, now_ns_);
        break;
      }
      case Use::kImage: {
        const sensor_msgs::ImageConstPtr image = deserialise<sensor_msgs::Image>(message);
        const ImageReading reading = readImage(*image);
        if (reading.verdict == ImageVerdict::kMalformed) {
          return false;
        }
        deblurrer_.addFrame(makeInputFrame(image, reading, now_ns_), now_ns_);
        break;
      }
      case Use::kExposure:
        deblurrer_.addExposure(deserialise<std_msgs::Int32>(message)->data, now_ns_);
        break;
      case Use::kCameraInfo: {
        const sensor_msgs::CameraInfoConstPtr info = deserialise<sensor_msgs::CameraInfo>(message);
        if (!cameraInfoFault(*info).empty()) {
          return false;
        }
        sink_.setCameraInfo(info);
        break;
      }
      case Use::kNone:
        break;
    }
  } catch (const ros::serialization::StreamOverrunException&) {
    return false;
  }
  return true;
}

}  // namespace fast_edi
