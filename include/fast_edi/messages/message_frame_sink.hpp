/// \file
/// From image messages to the pipeline and from the pipeline to image messages: what node, nodelet
/// and `deblur_bag` share, so that they publish and write the same.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>

#include "fast_edi/messages/message_conversion.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi {

/// What an InputFrame's `owner` points to when it was made from a message.
struct MessageFrame {
  sensor_msgs::ImageConstPtr message;
  std::int64_t arrival_ns = 0;  ///< on the clock that the pipeline was given as now_ns
};

/// Wraps \p message without copying pixels; the frame keeps it alive.
/// \param reading what readImage(*message) said
/// \pre reading.verdict is not kMalformed
InputFrame makeInputFrame(const sensor_msgs::ImageConstPtr& message, const ImageReading& reading,
                          std::int64_t arrival_ns);

/// The frame that makeInputFrame() made \p frame from.
const MessageFrame& messageFrame(const InputFrame& frame);

/// Lets the pipeline write straight into the memory of outgoing messages.
class MessageFrameSink : public FrameSink {
 public:
  /// \param image and \param info are complete and nobody else's; info has the image's header.
  using Deliver =
      std::function<void(const sensor_msgs::ImagePtr& image, const sensor_msgs::CameraInfoPtr& info,
                         const OutputFrame& output)>;

  /// \param image is complete and nobody else's
  using DeliverLatent = std::function<void(const sensor_msgs::ImagePtr& image)>;

  using DeliverTrust = std::function<void(const std::vector<float>& trust)>;

  /// \param frame_id used for images that have none
  MessageFrameSink(std::string frame_id, Deliver deliver);

  /// Who wants the high-rate video, if anybody.
  /// \param wanted called for each frame
  void setLatent(std::function<bool()> wanted, DeliverLatent deliver);

  /// Who wants to know how far filter_reblur trusted the pixels of the image that comes next.
  void setTrust(DeliverTrust deliver) { deliver_trust_ = std::move(deliver); }

  /// Who does the work on frames later. Comes before the frame is delivered: its image is complete
  /// once the work is done.
  void setDefer(std::function<void(const FrameWork& work)> defer) { defer_ = std::move(defer); }

  /// The calibration for all later frames.
  void setCameraInfo(const sensor_msgs::CameraInfoConstPtr& info) { camera_info_ = info; }

  MutableImageView begin(const InputFrame& input) override;
  void finish(const OutputFrame& output) override;
  void noteTrust(const std::vector<float>& trust) override {
    if (deliver_trust_) {
      deliver_trust_(trust);
    }
  }
  bool takesWork() const override { return defer_ != nullptr; }
  void defer(const FrameWork& work) override { defer_(work); }
  bool wantsLatentImages() const override { return latent_wanted_ && latent_wanted_(); }
  MutableImageView beginLatent(const InputFrame& input) override { return begin(input); }
  void finishLatent(const InputFrame& input, std::int64_t stamp_ns) override;

 private:
  sensor_msgs::ImagePtr takeImage(std::int64_t stamp_ns);

  std::string frame_id_;
  Deliver deliver_;
  sensor_msgs::CameraInfoConstPtr camera_info_;
  std::function<bool()> latent_wanted_;
  DeliverLatent deliver_latent_;
  DeliverTrust deliver_trust_;
  std::function<void(const FrameWork& work)> defer_;
  sensor_msgs::ImagePtr image_;  ///< between begin() and finish()
};

}  // namespace fast_edi
