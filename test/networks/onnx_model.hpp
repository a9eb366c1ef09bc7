/// \file
/// Small ONNX models, written field by field (see onnx.proto).
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace fast_edi {

class ProtoMessage {
 public:
  ProtoMessage& number(std::uint64_t field, std::uint64_t value) {
    varint(field << 3U);
    varint(value);
    return *this;
  }
  ProtoMessage& text(std::uint64_t field, const std::string& value) {
    varint(field << 3U | 2U);
    varint(value.size());
    bytes_ += value;
    return *this;
  }
  ProtoMessage& message(std::uint64_t field, const ProtoMessage& value) {
    return text(field, value.bytes_);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void varint(std::uint64_t value) {
    for (; value >= 0x80U; value >>= 7U) {
      bytes_ += static_cast<char>((value & 0x7FU) | 0x80U);
    }
    bytes_ += static_cast<char>(value);
  }

  std::string bytes_;
};

/// A tensor or an image as input or output; sizes of 0 have a name instead.
inline ProtoMessage valueInfo(const std::string& name, const std::vector<int>& sizes) {
  ProtoMessage shape;
  for (const int size : sizes) {
    ProtoMessage dimension;
    if (size > 0) {
      dimension.number(1, static_cast<std::uint64_t>(size));
    } else {
      dimension.text(2, "any");
    }
    shape.message(1, dimension);
  }
  constexpr std::uint64_t kFloat = 1;
  const ProtoMessage type =
      ProtoMessage().message(1, ProtoMessage().number(1, kFloat).message(2, shape));
  return ProtoMessage().text(1, name).message(2, type);
}

/// One convolution of 3 by 3 pixels; each output channel is the sum of all input channels, each
/// with \p weight in the middle and 0 around.
struct ConvolutionModel {
  int channels = 1;
  int output_channels = 1;
  int height = 0;  ///< 0: any
  int width = 0;
  float weight = 1.0F;
  int padding = 1;  ///< 1: as large as the input
  bool weights_among_inputs = false;

  std::string bytes() const {
    constexpr std::uint64_t kInts = 7;
    const auto ints = [](const std::string& name, const std::vector<int>& values) {
      ProtoMessage attribute = ProtoMessage().text(1, name);
      for (const int value : values) {
        attribute.number(8, static_cast<std::uint64_t>(value));
      }
      return attribute.number(20, kInts);
    };
    const ProtoMessage node = ProtoMessage()
                                  .text(1, "image")
                                  .text(1, "weights")
                                  .text(2, "result")
                                  .text(3, "convolution")
                                  .text(4, "Conv")
                                  .message(5, ints("kernel_shape", {3, 3}))
                                  .message(5, ints("pads", {padding, padding, padding, padding}))
                                  .message(5, ints("strides", {1, 1}));
    std::vector<float> values(static_cast<std::size_t>(channels * output_channels) * 9, 0.0F);
    for (std::size_t i = 4; i < values.size(); i += 9) {
      values[i] = weight;
    }
    std::string raw(values.size() * sizeof(float), '\0');
    std::memcpy(raw.data(), values.data(), raw.size());
    ProtoMessage tensor;
    for (const int size : {output_channels, channels, 3, 3}) {
      tensor.number(1, static_cast<std::uint64_t>(size));
    }
    tensor.number(2, 1).text(8, "weights").text(9, raw);
    ProtoMessage graph = ProtoMessage().message(1, node).text(2, "graph").message(5, tensor);
    if (weights_among_inputs) {
      graph.message(11, valueInfo("weights", {output_channels, channels, 3, 3}));
    }
    graph.message(11, valueInfo("image", {1, channels, height, width}))
        .message(12, valueInfo("result", {1, output_channels, height, width}));
    constexpr std::uint64_t kIrVersion = 6;
    constexpr std::uint64_t kOperatorSet = 11;
    return ProtoMessage()
        .number(1, kIrVersion)
        .message(7, graph)
        .message(8, ProtoMessage().text(1, "").number(2, kOperatorSet))
        .bytes();
  }
};

}  // namespace fast_edi
