#include "networks/onnx_input.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <set>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace fast_edi {
namespace {

// Field numbers of onnx.proto.
constexpr std::uint64_t kModelGraph = 7;
constexpr std::uint64_t kGraphInitializer = 5;
constexpr std::uint64_t kGraphInput = 11;
constexpr std::uint64_t kTensorName = 8;
constexpr std::uint64_t kValueName = 1;
constexpr std::uint64_t kValueType = 2;
constexpr std::uint64_t kTypeTensor = 1;
constexpr std::uint64_t kTensorShape = 2;
constexpr std::uint64_t kShapeDimension = 1;
constexpr std::uint64_t kDimensionValue = 1;

/// One field of a message.
struct Field {
  std::uint64_t number = 0;
  std::uint64_t value = 0;  ///< of a varint
  std::string_view bytes;   ///< of a text, message or array
};

/// The fields of a message of Protocol Buffers, one by one.
class FieldReader {
 public:
  explicit FieldReader(std::string_view message) : left_(message) {}

  /// \throws std::runtime_error where no field can be
  bool next(Field& field) {
    constexpr unsigned kTypeBits = 3;
    if (left_.empty()) {
      return false;
    }
    const std::uint64_t key = varint();
    field = {key >> kTypeBits, 0, {}};
    switch (key & ((1U << kTypeBits) - 1)) {
      case 0:
        field.value = varint();
        return true;
      case 1:
        take(sizeof(std::uint64_t));
        return true;
      case 2:
        field.bytes = take(varint());
        return true;
      case 5:
        take(sizeof(std::uint32_t));
        return true;
      default:
        throw std::runtime_error("not an ONNX model");
    }
  }

 private:
  std::uint64_t varint() {
    constexpr unsigned kBitsPerByte = 7;
    constexpr unsigned kBits = 64;
    constexpr std::uint8_t kMore = 0x80;
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < kBits; shift += kBitsPerByte) {
      const auto byte = static_cast<std::uint8_t>(take(1).front());
      value |= static_cast<std::uint64_t>(byte & (kMore - 1)) << shift;
      if ((byte & kMore) == 0) {
        return value;
      }
    }
    throw std::runtime_error("not an ONNX model");
  }

  std::string_view take(std::uint64_t size) {
    if (size > left_.size()) {
      throw std::runtime_error("not an ONNX model, or one that was cut short");
    }
    const std::string_view taken = left_.substr(0, size);
    left_.remove_prefix(size);
    return taken;
  }

  std::string_view left_;
};

/// All fields of that number that are texts, messages or arrays.
std::vector<std::string_view> partsOf(std::string_view message, std::uint64_t number) {
  std::vector<std::string_view> parts;
  FieldReader reader(message);
  for (Field field; reader.next(field);) {
    if (field.number == number) {
      parts.push_back(field.bytes);
    }
  }
  return parts;
}

/// The last one, as Protocol Buffers has it; empty for none.
std::string_view partOf(std::string_view message, std::uint64_t number) {
  const std::vector<std::string_view> parts = partsOf(message, number);
  return parts.empty() ? std::string_view() : parts.back();
}

/// 0 for a dimension that has a name, or none at all.
int sizeOf(std::string_view dimension) {
  int size = 0;
  FieldReader reader(dimension);
  for (Field field; reader.next(field);) {
    if (field.number == kDimensionValue && field.bytes.empty() &&
        field.value <= static_cast<std::uint64_t>(std::numeric_limits<int>::max())) {
      size = static_cast<int>(field.value);
    }
  }
  return size;
}

}  // namespace

OnnxInput onnxInput(const std::string& model) {
  constexpr std::size_t kImageDimensions = 4;
  const std::string_view graph = partOf(model, kModelGraph);
  if (graph.empty()) {
    throw std::runtime_error("not an ONNX model: it has no graph");
  }
  // Older models list their weights among the inputs.
  std::set<std::string_view> weights;
  for (const std::string_view tensor : partsOf(graph, kGraphInitializer)) {
    weights.insert(partOf(tensor, kTensorName));
  }
  std::vector<std::string_view> inputs;
  for (const std::string_view input : partsOf(graph, kGraphInput)) {
    if (weights.count(partOf(input, kValueName)) == 0) {
      inputs.push_back(input);
    }
  }
  if (inputs.size() != 1) {
    throw std::runtime_error("it has " + std::to_string(inputs.size()) +
                             " inputs, expected one image");
  }
  const std::string_view shape =
      partOf(partOf(partOf(inputs.front(), kValueType), kTypeTensor), kTensorShape);
  const std::vector<std::string_view> dimensions = partsOf(shape, kShapeDimension);
  if (dimensions.size() != kImageDimensions) {
    throw std::runtime_error("its input has " + std::to_string(dimensions.size()) +
                             " dimensions, expected four: 1, channels, height, width");
  }
  return {sizeOf(dimensions[1]), sizeOf(dimensions[2]), sizeOf(dimensions[3])};
}

}  // namespace fast_edi
