/// \file
/// What tests of the pipeline feed it with, and the sink that remembers what came out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/events/event_wire.hpp"
#include "fast_edi/pipeline/deblurrer.hpp"

namespace fast_edi::testing {

/// One output frame with a copy of its pixels.
struct RecordedFrame {
  OutputFrame frame;
  std::vector<std::uint8_t> pixels;

  friend bool operator==(const RecordedFrame& a, const RecordedFrame& b) {
    return a.frame.stamp_ns == b.frame.stamp_ns && a.frame.deblurred == b.frame.deblurred &&
           a.frame.exposure == b.frame.exposure && a.frame.events == b.frame.events &&
           (a.frame.deblurred || a.frame.pass_reason == b.frame.pass_reason) &&
           a.frame.input.owner == b.frame.input.owner && a.pixels == b.pixels;
  }
};

/// One image of the high-rate video with a copy of its pixels.
struct RecordedLatent {
  std::int64_t stamp_ns = 0;
  std::int64_t source_ns = 0;  ///< input stamp of the frame that it was computed from
  std::size_t frames = 0;      ///< that had been finished before
  std::vector<std::uint8_t> pixels;
};

/// Keeps all outputs. Checks that begin() and finish() come in pairs.
class RecordingSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override {
    open();
    return memoryFor(input);
  }

  void finish(const OutputFrame& output) override {
    close();
    outputs.push_back({output, memory_});
  }

  void noteTrust(const std::vector<float>& trust) override {
    balanced_ = balanced_ && open_;
    trust_maps.push_back(trust);
  }

  bool wantsLatentImages() const override { return wants_latent_images; }
  MutableImageView beginLatent(const InputFrame& input) override {
    open();
    return memoryFor(input);
  }
  void finishLatent(const InputFrame& input, std::int64_t stamp_ns) override {
    close();
    latent_images.push_back({stamp_ns, input.stamp_ns, outputs.size(), memory_});
  }

  bool isBalanced() const { return balanced_ && !open_; }

  std::vector<std::vector<float>> trust_maps;
  std::vector<RecordedFrame> outputs;
  bool wants_latent_images = false;
  std::vector<RecordedLatent> latent_images;

 private:
  void open() {
    balanced_ = balanced_ && !open_;
    open_ = true;
  }
  void close() {
    balanced_ = balanced_ && open_;
    open_ = false;
  }

  MutableImageView memoryFor(const InputFrame& input) {
    if (input.image.data == nullptr) {
      memory_.clear();
      return {};
    }
    const auto step = static_cast<std::size_t>(input.image.size.width) *
                      static_cast<std::size_t>(bytesPerPixel(input.image.format));
    memory_.assign(step * static_cast<std::size_t>(input.image.size.height), 0);
    return {memory_.data(), input.image.size, step, input.image.format};
  }

  std::vector<std::uint8_t> memory_;
  bool open_ = false;
  bool balanced_ = true;
};

/// A mono8 frame that owns its pixels.
inline InputFrame makeFrame(std::int64_t stamp_ns, SensorSize size,
                            std::vector<std::uint8_t> pixels) {
  const auto owner = std::make_shared<const std::vector<std::uint8_t>>(std::move(pixels));
  InputFrame frame;
  frame.stamp_ns = stamp_ns;
  frame.image = {owner->data(), size, static_cast<std::size_t>(size.width), PixelFormat::kMono8};
  frame.owner = owner;
  return frame;
}

/// A frame all of whose pixels have the same value.
inline InputFrame makeFlatFrame(std::int64_t stamp_ns, SensorSize size, std::uint8_t value = 100) {
  return makeFrame(stamp_ns, size, std::vector<std::uint8_t>(size.pixelCount(), value));
}

}  // namespace fast_edi::testing
