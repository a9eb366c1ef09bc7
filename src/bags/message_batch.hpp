/// \file
/// Messages of a recording with bytes of their own, and the frames that they have completed, on
/// their way from reading to writing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fast_edi/bags/bag_pipeline.hpp"
#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// A message, and how far its source had come behind it.
struct ReadMessage {
  BagMessage message;
  std::uint64_t position = 0;
  std::uint64_t length = 0;
};

class MessageBatch {
 public:
  struct Entry {
    ReadMessage read;
    std::size_t begin = 0;                     ///< of its bytes in those of the batch
    std::vector<BagPipeline::Output> outputs;  ///< completed by the message
  };

  /// Copies the message.
  void add(const ReadMessage& read);
  /// An entry without a message, for the end of a recording; its time is that of the last message.
  void addEnd(const ros::Time& last_time);
  /// To be called behind the last message, before any of them is used.
  void complete();

  /// Empties the batch; its memory stays for the next messages.
  void clear();
  /// Drops the messages from this one on.
  void endBefore(std::size_t entry) { entries_.resize(entry); }

  std::vector<Entry>& entries() { return entries_; }
  /// Of messages and images.
  std::size_t bytes() const;
  /// Of the memory for messages.
  std::size_t capacity() const { return bytes_.capacity(); }
  bool isFull() const { return bytes_.size() >= kFullBytes; }

 private:
  /// Small messages go together, so that handing them on costs little; frames of a usual size come
  /// one by one, since many images may follow from each.
  static constexpr std::size_t kFullBytes = std::size_t{1} << 16;

  std::vector<std::uint8_t> bytes_;
  std::vector<Entry> entries_;
};

}  // namespace fast_edi
