/// \file
/// A recording of any format as the messages that davis_ros_driver would have published: event
/// arrays, frames stamped in the middle of their exposure, the exposure's length behind each frame,
/// IMU samples, camera_info.
///
/// The first camera with events is `/dvs`; others have the namespace of their name. Triggers are
/// left out: the driver has no topic for them.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/base/raw_bytes.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class RecordingMessages : public MessageSource {
 public:
  /// \param array_ns length of the event arrays; 0: as the recording has them
  explicit RecordingMessages(std::unique_ptr<Recording> recording, std::int64_t array_ns = 0);
  ~RecordingMessages() override;

  bool next(BagMessage& message) override;
  const std::map<std::uint32_t, BagConnection>& connections() const override {
    return connections_;
  }
  const std::vector<BagDamage>& damage() const override { return recording_->damage(); }
  std::uint64_t position() const override { return recording_->position(); }
  std::uint64_t length() const override { return recording_->length(); }
  std::uint64_t fileSize() const override { return recording_->fileSize(); }
  bool knowsExposures() const override { return recording_->knowsExposures(); }
  std::optional<BiasConfiguration> biases() const override { return recording_->biases(); }

 private:
  /// What a stream's messages need.
  struct Output {
    std::uint32_t connection = 0;
    std::uint32_t exposure_connection = 0;  ///< of frames
    std::uint32_t sequence = 0;
    SensorSize size;
    /// The message of events that wait for the end of their array: room for its fields, and their
    /// records; empty if there are none.
    RawBytes array;
    std::int64_t first_ns = 0;  ///< of these events
    std::int64_t last_ns = 0;
  };
  struct Waiting {
    std::uint32_t connection = 0;
    ros::Time time;
    RawBytes bytes;
  };

  template <typename Message>
  std::uint32_t connect(const std::string& topic);
  template <typename Message>
  void send(std::uint32_t connection, std::int64_t record_ns, const Message& message);
  RawBytes takeSpare();
  void add(const RecordingItem& item);
  void addEvents(Output& output, const RecordedEvents& events, std::int64_t record_ns);
  void addFrame(Output& output, const RecordedFrame& frame, std::int64_t record_ns);
  void addImu(Output& output, const RecordedImu& sample, std::int64_t record_ns);
  void addCalibration(const Output& output, const RecordedCalibration& calibration,
                      std::int64_t record_ns);
  void sendArray(Output& output, std::int64_t record_ns);

  std::unique_ptr<Recording> recording_;
  const std::int64_t array_ns_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<Output> outputs_;  ///< one for each stream
  std::deque<Waiting> waiting_;
  Waiting given_;  ///< what next() returned last
  std::vector<RawBytes> spare_;
  std::int64_t record_ns_ = 0;
  bool ended_ = false;
};

}  // namespace fast_edi
