/// \file
/// Bytes of a recording at given offsets, never read beyond their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fast_edi {

/// Bytes at given offsets: a file or memory.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  /// Number of bytes.
  virtual std::uint64_t size() const = 0;
  /// Bytes [offset, offset + count), in \p scratch or in place; nullptr when they do not exist or
  /// cannot be read. Valid until \p scratch changes or the source is destroyed.
  virtual const std::uint8_t* read(std::uint64_t offset, std::size_t count,
                                   std::vector<std::uint8_t>& scratch) const = 0;
};

/// A file that is only ever read.
class FileSource : public ByteSource {
 public:
  /// \throws RecordingError when \p path is no regular file that can be read
  explicit FileSource(const std::string& path);
  ~FileSource() override;
  FileSource(const FileSource&) = delete;
  FileSource& operator=(const FileSource&) = delete;

  std::uint64_t size() const override { return size_; }
  const std::uint8_t* read(std::uint64_t offset, std::size_t count,
                           std::vector<std::uint8_t>& scratch) const override;

 private:
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Memory that somebody else owns.
class MemorySource : public ByteSource {
 public:
  MemorySource(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  std::uint64_t size() const override { return size_; }
  const std::uint8_t* read(std::uint64_t offset, std::size_t count,
                           std::vector<std::uint8_t>& scratch) const override;

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace fast_edi
