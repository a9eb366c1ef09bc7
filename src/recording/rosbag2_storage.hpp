/// \file
/// One file of a rosbag2: messages of ROS 2 in the order of their record times.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording.hpp"
#include "recording/damage_notes.hpp"

namespace fast_edi {

struct Rosbag2Topic {
  std::string name;
  std::string type;    ///< e.g. "sensor_msgs/msg/Image"
  std::string format;  ///< of its messages: "cdr"
};

/// A message; `data` is valid until the next call of Rosbag2Storage::next().
struct Rosbag2Message {
  std::size_t topic = 0;  ///< index into Rosbag2Storage::topics()
  std::int64_t record_ns = 0;
  std::uint64_t offset = 0;  ///< in the file, for notes on damage
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

class Rosbag2Storage {
 public:
  /// Messages are no larger [bytes], compressed or not.
  static constexpr std::size_t kMaxMessageBytes = std::size_t{128} << 20;

  Rosbag2Storage() = default;
  virtual ~Rosbag2Storage() = default;
  Rosbag2Storage(const Rosbag2Storage&) = delete;
  Rosbag2Storage& operator=(const Rosbag2Storage&) = delete;

  /// For people, e.g. "MCAP, LZ4".
  virtual std::string format() const = 0;
  virtual const std::vector<Rosbag2Topic>& topics() const = 0;
  /// \return false at the end
  virtual bool next(Rosbag2Message& message) = 0;
  /// Restarts, as if no message had been read.
  void rewind() {
    damage_.resize(std::min(damage_.size(), first_notes_));
    restart();
  }
  /// How far next() has come, 0..1.
  virtual double progress() const = 0;

  const std::vector<RecordingDamage>& damage() const { return damage_; }

 protected:
  void note(std::uint64_t offset, const std::string& what) { noteDamage(damage_, {offset, what}); }
  /// What was noted so far belongs to opening the file.
  void keepNotes() { first_notes_ = damage_.size(); }
  virtual void restart() = 0;

 private:
  std::vector<RecordingDamage> damage_;
  std::size_t first_notes_ = 0;
};

}  // namespace fast_edi
