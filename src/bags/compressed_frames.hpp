/// \file
/// Frames that were recorded as sensor_msgs/CompressedImage, as the frames that they show.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <sensor_msgs/CompressedImage.h>

#include "fast_edi/bags/message_source.hpp"

namespace fast_edi {

/// Adds, behind each message on TOPIC/compressed, the frame as sensor_msgs/Image on TOPIC, marked
/// BagMessage::decoded. Where TOPIC was recorded, too, nothing is added.
///
/// PNG keeps the frame bit for bit; JPEG does not, and its blocks remain in the deblurred frame.
class CompressedFrames : public MessageSource {
 public:
  explicit CompressedFrames(std::unique_ptr<MessageSource> source);

  bool next(BagMessage& message) override;
  const std::map<std::uint32_t, BagConnection>& connections() const override {
    return connections_;
  }
  const std::vector<BagDamage>& damage() const override { return damage_; }
  std::uint64_t position() const override { return source_->position(); }
  std::uint64_t length() const override { return source_->length(); }
  bool countsMessages() const override { return source_->countsMessages(); }
  std::string compression() const override { return source_->compression(); }
  std::uint64_t fileSize() const override { return source_->fileSize(); }
  std::optional<ChunkSource> chunks() const override { return source_->chunks(); }
  bool knowsExposures() const override { return source_->knowsExposures(); }
  std::optional<BiasConfiguration> biases() const override { return source_->biases(); }

 private:
  void connectDecoded();
  void decode(const BagMessage& message, const BagConnection& decoded);
  void noteDamageOfSource();

  std::unique_ptr<MessageSource> source_;
  std::map<std::uint32_t, BagConnection> connections_;
  /// By the id of the connection with the compressed frames.
  std::map<std::uint32_t, std::uint32_t> decoded_;
  std::vector<BagDamage> damage_;
  std::size_t damage_of_source_ = 0;  ///< noted of it so far
  BagMessage waiting_;                ///< a decoded frame; no connection: none
  std::vector<std::uint8_t> bytes_;
};

}  // namespace fast_edi
