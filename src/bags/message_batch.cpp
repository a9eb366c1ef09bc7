#include "bags/message_batch.hpp"

namespace fast_edi {

void MessageBatch::add(const ReadMessage& read) {
  entries_.push_back({read, bytes_.size(), {}});
  if (read.message.size > 0) {
    bytes_.insert(bytes_.end(), read.message.data, read.message.data + read.message.size);
  }
}

void MessageBatch::addEnd(const ros::Time& last_time) {
  entries_.emplace_back();
  entries_.back().read.message.time = last_time;
}

void MessageBatch::complete() {
  for (Entry& entry : entries_) {
    entry.read.message.data = bytes_.data() + entry.begin;
  }
}

void MessageBatch::clear() {
  bytes_.clear();
  entries_.clear();
}

std::size_t MessageBatch::bytes() const {
  std::size_t bytes = bytes_.size();
  for (const Entry& entry : entries_) {
    for (const BagPipeline::Output& output : entry.outputs) {
      bytes += output.image->data.size();
      for (const sensor_msgs::ImagePtr& latent : output.latent) {
        bytes += latent->data.size();
      }
    }
  }
  return bytes;
}

}  // namespace fast_edi
