#include "calls.hpp"

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace fast_edi::arm64 {
namespace {

enum class Kind : std::uint8_t { kAdvance, kEvents, kFrame, kExposure };

/// Numbers as they lie in memory: both processors are little endian.
class CallReader {
 public:
  explicit CallReader(const std::string& path) : path_(path), in_(path, std::ios::binary) {
    if (!in_) {
      throw std::runtime_error(path + ": cannot be opened");
    }
  }

  bool atEnd() { return in_.peek() == std::ifstream::traits_type::eof(); }

  template <typename Number>
  Number get() {
    static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
    Number number;
    read(&number, sizeof(number));
    return number;
  }

  SensorSize getSize() {
    const auto width = get<std::int32_t>();
    return {width, get<std::int32_t>()};
  }

  std::vector<std::uint8_t> getBytes() {
    std::vector<std::uint8_t> bytes(get<std::uint32_t>());
    read(bytes.data(), bytes.size());
    return bytes;
  }

 private:
  void read(void* to, std::size_t bytes) {
    if (!in_.read(static_cast<char*>(to), static_cast<std::streamsize>(bytes))) {
      throw std::runtime_error(path_ + ": ends within a call");
    }
  }

  std::string path_;
  std::ifstream in_;
};

InputFrame readFrame(CallReader& reader) {
  InputFrame frame;
  frame.stamp_ns = reader.get<std::int64_t>();
  frame.supported = reader.get<std::uint8_t>() != 0;
  frame.image.size = reader.getSize();
  frame.image.format = reader.get<PixelFormat>();
  const auto pixels = std::make_shared<const std::vector<std::uint8_t>>(reader.getBytes());
  frame.image.data = pixels->empty() ? nullptr : pixels->data();
  frame.image.step = static_cast<std::size_t>(frame.image.size.width) *
                     static_cast<std::size_t>(bytesPerPixel(frame.image.format));
  frame.owner = pixels;
  return frame;
}

void replayEvents(CallReader& reader, std::int64_t now_ns, Deblurrer& deblurrer) {
  const SensorSize size = reader.getSize();
  const auto sequence = reader.get<std::uint32_t>();
  const std::vector<std::uint8_t> records = reader.getBytes();
  deblurrer.addEvents({records.data(), records.size() / kWireEventBytes}, size, sequence, now_ns);
}

}  // namespace

CallWriter::CallWriter(const std::string& path) : path_(path), out_(path, std::ios::binary) {
  if (!out_) {
    throw std::runtime_error(path + ": cannot be written");
  }
}

template <typename Number>
void CallWriter::put(Number number) {
  static_assert(std::is_arithmetic_v<Number> || std::is_enum_v<Number>);
  out_.write(reinterpret_cast<const char*>(&number), sizeof(number));
}

void CallWriter::putBytes(const std::uint8_t* bytes, std::size_t count) {
  put(static_cast<std::uint32_t>(count));
  out_.write(reinterpret_cast<const char*>(bytes), static_cast<std::streamsize>(count));
}

void CallWriter::putSize(SensorSize size) {
  put(std::int32_t{size.width});
  put(std::int32_t{size.height});
}

void CallWriter::advance(std::int64_t now_ns) {
  put(Kind::kAdvance);
  put(now_ns);
}

void CallWriter::addEvents(const WireEvents& events, SensorSize size, std::uint32_t sequence,
                           std::int64_t now_ns) {
  put(Kind::kEvents);
  put(now_ns);
  putSize(size);
  put(sequence);
  putBytes(events.data, events.count * kWireEventBytes);
}

void CallWriter::addFrame(const InputFrame& frame, std::int64_t now_ns) {
  put(Kind::kFrame);
  put(now_ns);
  put(frame.stamp_ns);
  put(static_cast<std::uint8_t>(frame.supported));
  putSize(frame.image.size);
  put(frame.image.format);
  // Without padding at the end of rows.
  const ImageView& image = frame.image;
  const std::size_t row_bytes = static_cast<std::size_t>(image.size.width) *
                                static_cast<std::size_t>(bytesPerPixel(image.format));
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < image.size.height; ++y) {
    pixels.insert(pixels.end(), image.row(y), image.row(y) + row_bytes);
  }
  putBytes(pixels.data(), pixels.size());
}

void CallWriter::addExposure(std::int32_t exposure_us, std::int64_t now_ns) {
  put(Kind::kExposure);
  put(now_ns);
  put(exposure_us);
}

void CallWriter::close() {
  out_.close();
  if (!out_) {
    throw std::runtime_error(path_ + ": cannot be written");
  }
}

void replayCalls(const std::string& path, Deblurrer& deblurrer) {
  CallReader reader(path);
  while (!reader.atEnd()) {
    const Kind kind = reader.get<Kind>();
    const auto now_ns = reader.get<std::int64_t>();
    deblurrer.advance(now_ns);
    switch (kind) {
      case Kind::kAdvance:
        break;
      case Kind::kEvents:
        replayEvents(reader, now_ns, deblurrer);
        break;
      case Kind::kFrame:
        deblurrer.addFrame(readFrame(reader), now_ns);
        break;
      case Kind::kExposure:
        deblurrer.addExposure(reader.get<std::int32_t>(), now_ns);
        break;
      default:
        throw std::runtime_error(path + ": no such kind of call");
    }
  }
  deblurrer.finish();
}

}  // namespace fast_edi::arm64
