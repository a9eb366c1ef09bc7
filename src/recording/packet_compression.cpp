#include "recording/packet_compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <stdexcept>

namespace fast_edi {
namespace {

/// Room for the output at first; it doubles as it fills.
constexpr std::size_t kFirstRoom = std::size_t{256} << 10;
constexpr int kZstdLevel = 1;  ///< the fastest that still halves events

std::string tooLarge(std::size_t max_bytes) {
  return "larger than " + std::to_string(max_bytes) + " bytes when decompressed";
}

/// Makes room behind \p done bytes. \return false at the limit
bool grow(RawBytes& output, std::size_t done, std::size_t max_bytes) {
  if (done < output.size()) {
    return true;
  }
  if (done >= max_bytes) {
    return false;
  }
  output.resize(std::min(max_bytes, std::max(kFirstRoom, 2 * done)));
  return true;
}

}  // namespace

struct Decompressor::State {
  LZ4F_decompressionContext_t lz4 = nullptr;
  ZSTD_DCtx* zstd = nullptr;

  State() {
    if (LZ4F_isError(LZ4F_createDecompressionContext(&lz4, LZ4F_VERSION))) {
      throw std::bad_alloc();
    }
    zstd = ZSTD_createDCtx();
    if (zstd == nullptr) {
      LZ4F_freeDecompressionContext(lz4);
      throw std::bad_alloc();
    }
  }
  ~State() {
    LZ4F_freeDecompressionContext(lz4);
    ZSTD_freeDCtx(zstd);
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  std::string lz4Frame(const std::uint8_t* data, std::size_t size, std::size_t max_bytes,
                       RawBytes& output) {
    LZ4F_resetDecompressionContext(lz4);
    std::size_t done = 0;
    std::size_t taken = 0;
    std::string fault = "LZ4 frame is cut";
    while (taken < size) {
      if (!grow(output, done, max_bytes)) {
        fault = tooLarge(max_bytes);
        break;
      }
      std::size_t room = output.size() - done;
      std::size_t input = size - taken;
      const std::size_t wanted =
          LZ4F_decompress(lz4, output.data() + done, &room, data + taken, &input, nullptr);
      if (LZ4F_isError(wanted)) {
        fault = std::string("LZ4 frame: ") + LZ4F_getErrorName(wanted);
        break;
      }
      done += room;
      taken += input;
      if (wanted == 0) {
        fault.clear();
        break;
      }
      if (room == 0 && input == 0) {
        break;  // no progress: never loop on what a damaged frame says
      }
    }
    output.resize(done);
    return fault;
  }

  std::string zstdFrame(const std::uint8_t* data, std::size_t size, std::size_t max_bytes,
                        RawBytes& output) {
    ZSTD_DCtx_reset(zstd, ZSTD_reset_session_only);
    ZSTD_inBuffer input{data, size, 0};
    std::size_t done = 0;
    std::string fault = "ZSTD frame is cut";
    for (;;) {
      if (!grow(output, done, max_bytes)) {
        fault = tooLarge(max_bytes);
        break;
      }
      ZSTD_outBuffer room{output.data(), output.size(), done};
      const std::size_t before = input.pos;
      const std::size_t wanted = ZSTD_decompressStream(zstd, &room, &input);
      if (ZSTD_isError(wanted)) {
        fault = std::string("ZSTD frame: ") + ZSTD_getErrorName(wanted);
        break;
      }
      const bool progress = room.pos > done || input.pos > before;
      done = room.pos;
      if (wanted == 0) {
        fault.clear();
        break;
      }
      if (!progress) {
        break;
      }
    }
    output.resize(done);
    return fault;
  }
};

Decompressor::Decompressor() : state_(std::make_unique<State>()) {}
Decompressor::~Decompressor() = default;

std::string Decompressor::run(Compression compression, const std::uint8_t* data, std::size_t size,
                              std::size_t max_bytes, RawBytes& output) {
  output.resize(std::min(output.capacity(), max_bytes));
  switch (compression) {
    case Compression::kLz4:
      return state_->lz4Frame(data, size, max_bytes, output);
    case Compression::kZstd:
      return state_->zstdFrame(data, size, max_bytes, output);
    case Compression::kNone:
      break;
  }
  if (size > max_bytes) {
    output.clear();
    return tooLarge(max_bytes);
  }
  output.assign(data, data + size);
  return {};
}

void compress(Compression compression, const std::uint8_t* data, std::size_t size,
              std::vector<std::uint8_t>& output) {
  if (compression == Compression::kLz4) {
    LZ4F_preferences_t preferences = {};
    preferences.frameInfo.contentSize = size;
    output.resize(LZ4F_compressFrameBound(size, &preferences));
    const std::size_t written =
        LZ4F_compressFrame(output.data(), output.size(), data, size, &preferences);
    if (LZ4F_isError(written)) {
      throw std::runtime_error(std::string("LZ4: ") + LZ4F_getErrorName(written));
    }
    output.resize(written);
    return;
  }
  output.resize(ZSTD_compressBound(size));
  const std::size_t written = ZSTD_compress(output.data(), output.size(), data, size, kZstdLevel);
  if (ZSTD_isError(written)) {
    throw std::runtime_error(std::string("ZSTD: ") + ZSTD_getErrorName(written));
  }
  output.resize(written);
}

const char* toString(Compression compression) {
  switch (compression) {
    case Compression::kLz4:
      return "LZ4";
    case Compression::kZstd:
      return "ZSTD";
    case Compression::kNone:
      break;
  }
  return "not compressed";
}

}  // namespace fast_edi
