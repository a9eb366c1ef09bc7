/// \file
/// Files that are one recording together, in a folder or in an archive; their names are relative to
/// it, e.g. "images/frame_0.png".
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace fast_edi {

/// Bytes one after the other, of which none are kept.
class ByteStream {
 public:
  ByteStream() = default;
  virtual ~ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// As many as there should be.
  virtual std::uint64_t size() const = 0;
  /// The next \p count bytes; fewer only at the end, or where fault() says what is wrong.
  virtual std::size_t read(std::uint8_t* data, std::size_t count) = 0;
  /// Why there are fewer bytes than size(); empty if that is not so, as far as is known.
  virtual std::string fault() const = 0;
};

class FileSet {
 public:
  FileSet() = default;
  virtual ~FileSet() = default;
  FileSet(const FileSet&) = delete;
  FileSet& operator=(const FileSet&) = delete;

  virtual bool has(const std::string& name) const = 0;
  /// \throws RecordingError when it cannot be read
  virtual std::unique_ptr<ByteStream> open(const std::string& name) const = 0;
  /// Names of the files right in \p folder, in any order.
  virtual std::vector<std::string> list(const std::string& folder) const = 0;
  /// The last bytes of a file, at most \p count.
  /// \throws RecordingError when it cannot be read
  virtual std::string tail(const std::string& name, std::size_t count) const = 0;
  /// Of a file, or of all with an empty name, for messages.
  virtual std::string pathOf(const std::string& name) const = 0;
};

/// A file by itself.
/// \throws RecordingError when \p path is no regular file that can be read
std::unique_ptr<ByteStream> openStream(const std::string& path);

std::unique_ptr<FileSet> openFolder(const std::string& path);

}  // namespace fast_edi
