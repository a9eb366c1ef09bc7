/// \file
/// The messages of a recording through the pipeline, as the nodelet does it live.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "fast_edi/messages/message_frame_sink.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {

/// The clock of the close timeout is the bag's record time.
class BagPipeline {
 public:
  struct Output {
    sensor_msgs::ImagePtr image;
    sensor_msgs::CameraInfoPtr info;
    OutputFrame frame;  ///< its input comes from messageFrame(), which has the record time too
    std::vector<sensor_msgs::ImagePtr> latent;  ///< images of the high-rate video behind it
    /// How far filter_reblur trusted each pixel, 0 to 255; null unless showTrust() was called.
    sensor_msgs::ImagePtr trust;
    FrameWork work;  ///< what is left to do for image and trust, see complete(); else empty
  };

  /// \throws std::invalid_argument for parameters out of range
  BagPipeline(const TopicNames& topics, const LoadedParameters& parameters);

  /// From now on, outputs have maps of trust.
  void showTrust();
  /// From now on, filters of frames are left to complete() where no later frame depends on them.
  void deferWork();
  /// Does the work that is left of an output; on any thread, also while the pipeline goes on.
  static void complete(Output& output, FrameRenderer& renderer);

  /// Takes the next message of the recording, in the order of record times; other topics than ours
  /// only let time pass.
  /// \return false for a message on a topic of ours that contradicts itself: it is not used
  bool add(const BagMessage& message);
  /// Closes waiting frames with what has come: the end of the recording.
  void finish();
  /// What was finished since the last call.
  std::vector<Output> takeOutputs();

  const DeblurCounters& counters() const { return deblurrer_.counters(); }
  DeblurStatus status() const { return deblurrer_.status(); }

 private:
  enum class Use { kNone, kEvents, kImage, kExposure, kCameraInfo };

  Use useOf(const BagConnection& connection) const;
  bool use(const BagMessage& message);

  const TopicNames topics_;
  const std::string camera_info_topic_;
  MessageFrameSink sink_;
  Deblurrer deblurrer_;
  std::vector<Output> outputs_;
  bool shows_trust_ = false;
  std::vector<std::uint8_t> trust_;  ///< of the image that is being written
  FrameWork work_;                   ///< the same
  std::int64_t now_ns_ = 0;          ///< the bag's record time
};

}  // namespace fast_edi
