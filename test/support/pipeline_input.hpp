/// \file
/// What tests of the pipeline feed it with, and the sink that remembers what came out.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fast_edi/core/deblurrer.hpp"
#include "fast_edi/core/event_wire.hpp"

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

/// Keeps all outputs. Checks that begin() and finish() come in pairs.
class RecordingSink : public FrameSink {
 public:
  MutableImageView begin(const InputFrame& input) override {
    balanced_ = balanced_ && !open_;
    open_ = true;
    if (input.image.data == nullptr) {
      memory_.clear();
      return {};
    }
    const auto step = static_cast<std::size_t>(input.image.size.width) *
                      static_cast<std::size_t>(bytesPerPixel(input.image.format));
    memory_.assign(step * static_cast<std::size_t>(input.image.size.height), 0);
    return {memory_.data(), input.image.size, step, input.image.format};
  }

  void finish(const OutputFrame& output) override {
    balanced_ = balanced_ && open_;
    open_ = false;
    outputs.push_back({output, memory_});
  }

  bool isBalanced() const { return balanced_ && !open_; }

  std::vector<RecordedFrame> outputs;

 private:
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
