/// \file
/// Several recordings as one: what `rosbag record --split` made of a long one.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// Messages of all of them in the order of their record times, whatever the order in which they
/// are given. Offsets of damage are those of the file that its text names.
class JoinedRecordings : public MessageSource {
 public:
  struct Part {
    std::string path;  ///< for messages alone
    std::unique_ptr<MessageSource> source;
  };

  /// \pre at least one part
  explicit JoinedRecordings(std::vector<Part> parts);

  bool next(BagMessage& message) override;
  /// The same topic, type and publisher in several parts is one connection.
  const std::map<std::uint32_t, BagConnection>& connections() const override {
    return connections_;
  }
  const std::vector<BagDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override;
  std::uint64_t length() const override;
  bool countsMessages() const override;
  /// Of the first part.
  std::string compression() const override;
  std::uint64_t fileSize() const override;
  bool knowsExposures() const override;
  /// Of the first part that holds them.
  std::optional<BiasConfiguration> biases() const override;

 private:
  struct Reading {
    Part part;
    std::map<std::uint32_t, std::uint32_t> ids;  ///< of its connections, among all
    std::size_t damage = 0;                      ///< noted of it so far
    BagMessage message;                          ///< its next one; no connection: none
  };

  void connect(Reading& reading);
  void advance(Reading& reading);

  std::vector<Reading> readings_;
  std::map<std::uint32_t, BagConnection> connections_;
  std::vector<BagDamage> damage_;
  Reading* given_ = nullptr;  ///< whose message next() returned last
};

}  // namespace fast_edi
