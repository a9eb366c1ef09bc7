/// \file
/// Topics of an MCAP file, by its schemas and channels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "recording/rosbag2_storage.hpp"

namespace fast_edi {

/// Collects schemas (the types of messages) and channels (the topics). A channel of a number that
/// is there already is left out: files repeat them.
class McapTopics {
 public:
  static constexpr std::size_t kMaxTopics = 65'536;

  /// Takes the content of a schema or channel; leaves out one that is cut, and records of any other
  /// \p kind.
  void add(std::uint8_t kind, const std::uint8_t* content, std::size_t size);

  const std::vector<Rosbag2Topic>& topics() const { return topics_; }
  /// Index into topics() of a channel.
  std::optional<std::size_t> find(std::uint16_t channel) const;

 private:
  void addSchema(const std::uint8_t* content, std::size_t size);
  void addChannel(const std::uint8_t* content, std::size_t size);

  std::map<std::uint16_t, std::string> schemas_;  ///< names
  std::map<std::uint16_t, std::size_t> numbers_;  ///< from channels to topics_
  std::vector<Rosbag2Topic> topics_;
};

}  // namespace fast_edi
