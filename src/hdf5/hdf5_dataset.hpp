/// \file
/// An array of numbers in an HDF5 file, read some rows at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hdf5/hdf5_file.hpp"

namespace fast_edi {

class Hdf5Dataset {
 public:
  /// A chunk of a dataset has no more, decompressed [bytes].
  static constexpr std::size_t kMaxChunkBytes = std::size_t{128} << 20;
  static constexpr std::size_t kMaxDimensions = 4;

  /// \param file must outlive this
  /// \throws RecordingError when it cannot be read: other elements than numbers, data in other
  ///         files, filters that are not installed, sizes that the file cannot hold
  Hdf5Dataset(const Hdf5File& file, std::string name);

  const std::string& name() const { return name_; }
  /// Rows come first; one to kMaxDimensions numbers. A single number is one row.
  const std::vector<hsize_t>& shape() const { return shape_; }
  hsize_t rows() const { return shape_.front(); }
  /// Of one row.
  std::size_t rowElements() const;
  bool isFloat() const { return is_float_; }
  std::size_t elementBytes() const { return element_bytes_; }

  /// Rows [first, first + count), which must exist, as numbers of the type \p memory.
  /// \param values room for them
  /// \return what is wrong; empty if nothing is
  std::string read(hsize_t first, hsize_t count, hid_t memory, void* values);

 private:
  void checkType(hid_t type);
  void checkShape();
  void checkStorage(hid_t creation, std::uint64_t stored);
  void checkFilters(hid_t creation);
  std::string checkChunks(hsize_t first, hsize_t count);
  std::string checkChunk(const std::vector<hsize_t>& offset);
  [[noreturn]] void refuse(const std::string& what) const;

  const Hdf5File& file_;
  const std::string name_;
  Hdf5Handle dataset_;
  std::vector<hsize_t> shape_;
  std::size_t element_bytes_ = 0;
  bool is_float_ = false;
  bool is_scalar_ = false;
  std::vector<hsize_t> chunk_;  ///< its shape; empty: not in chunks
  std::size_t chunk_bytes_ = 0;
  std::optional<unsigned> deflate_;     ///< which of the filters that is
  std::optional<unsigned> checksum_;    ///< the same of fletcher32
  bool is_checkable_ = true;            ///< whether the size of chunks can be found out
  std::vector<hsize_t> checked_chunk_;  ///< the last one that was inflated to learn its size
};

}  // namespace fast_edi
