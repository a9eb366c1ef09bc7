/// \file
/// ROS messages as a recording: what writers of other formats take.
///
/// Each frame waits for the exposure message behind it; one that is followed by the next frame
/// first has no known exposure.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <sensor_msgs/Image.h>

#include "fast_edi/bags/message_source.hpp"
#include "fast_edi/bags/topic_names.hpp"
#include "fast_edi/events/sequence_gaps.hpp"
#include "fast_edi/recording/recording.hpp"

namespace fast_edi {

class BagRecording : public Recording {
 public:
  /// \param paths of one recording or several, as openMessages() takes them
  /// \param topics frames, events and exposures; IMU samples are those of the only
  ///        topic that has them
  /// \throws RecordingError when they cannot be read, or have no events and no frames on these
  /// topics
  BagRecording(const std::vector<std::string>& paths, const TopicNames& topics);
  ~BagRecording() override;

  std::string format() const override { return "ROS messages"; }
  const std::vector<RecordedStream>& streams() const override { return streams_; }
  bool next(RecordingItem& item) override;
  const std::vector<RecordingDamage>& damage() const override { return source_->damage(); }
  std::uint64_t position() const override { return source_->position(); }
  std::uint64_t length() const override { return source_->length(); }
  std::uint64_t fileSize() const override { return source_->fileSize(); }

  /// Messages that contradict themselves, and were left out.
  std::uint64_t malformed() const { return malformed_; }

 private:
  bool take(const BagMessage& message, RecordingItem& item);
  bool giveFrame(std::optional<std::int64_t> exposure_ns, RecordingItem& item);
  void findSizes(const std::vector<std::string>& paths);

  TopicNames topics_;
  std::string imu_topic_;
  std::unique_ptr<MessageSource> source_;
  std::vector<RecordedStream> streams_;
  sensor_msgs::ImagePtr waiting_;  ///< for its exposure
  sensor_msgs::ImagePtr given_;
  std::vector<Event> events_;
  SequenceGaps sequence_gaps_;
  std::uint32_t lost_arrays_ = 0;  ///< since the last events that were given
  std::int64_t record_ns_ = 0;
  std::uint64_t malformed_ = 0;
};

}  // namespace fast_edi
