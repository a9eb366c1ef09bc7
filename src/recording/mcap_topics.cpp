#include "recording/mcap_topics.hpp"

#include <utility>

#include "recording/mcap_records.hpp"

namespace fast_edi {

void McapTopics::add(std::uint8_t kind, const std::uint8_t* content, std::size_t size) {
  if (kind == kMcapSchema) {
    addSchema(content, size);
  } else if (kind == kMcapChannel) {
    addChannel(content, size);
  }
}

std::optional<std::size_t> McapTopics::find(std::uint16_t channel) const {
  const auto number = numbers_.find(channel);
  return number != numbers_.end() ? std::optional(number->second) : std::nullopt;
}

void McapTopics::addSchema(const std::uint8_t* content, std::size_t size) {
  McapFields fields(content, size);
  const auto id = fields.number<std::uint16_t>();
  std::string name = fields.text();
  if (fields.ok()) {
    schemas_[id] = std::move(name);
  }
}

void McapTopics::addChannel(const std::uint8_t* content, std::size_t size) {
  McapFields fields(content, size);
  const auto id = fields.number<std::uint16_t>();
  const auto schema = fields.number<std::uint16_t>();
  Rosbag2Topic topic;
  topic.name = fields.text();
  topic.format = fields.text();
  if (!fields.ok() || numbers_.count(id) > 0 || topics_.size() >= kMaxTopics) {
    return;
  }
  topic.type = schemas_[schema];
  numbers_[id] = topics_.size();
  topics_.push_back(std::move(topic));
}

}  // namespace fast_edi
