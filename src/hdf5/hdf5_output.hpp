/// \file
/// An HDF5 file that is being written: groups, arrays and attributes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fast_edi/hdf5/hdf5_writer.hpp"
#include "hdf5/hdf5_library.hpp"

namespace fast_edi {

/// All member functions throw RecordingError when nothing can be written.
class Hdf5Output {
 public:
  Hdf5Output(const std::string& path, Hdf5Compression compression);

  const Hdf5Handle& file() const { return file_; }
  Hdf5Handle makeGroup(const char* name) const;
  /// An array that is complete by this call.
  /// \param memory type of \p values
  Hdf5Handle writeArray(const Hdf5Handle& parent, const char* name, hid_t type,
                        const std::vector<hsize_t>& shape, hid_t memory, const void* values) const;
  void writeNumber(const Hdf5Handle& parent, const char* name, std::int64_t value) const;

  /// A column that grows by append().
  Hdf5Handle makeColumn(const Hdf5Handle& parent, const char* name, hid_t type,
                        hsize_t chunk) const;
  /// \param rows that it has
  void append(const Hdf5Handle& column, hsize_t rows, hid_t memory, const void* values,
              hsize_t count) const;

  void setNumbers(const Hdf5Handle& object, const char* name,
                  const std::vector<std::int64_t>& values) const;
  void setNumber(const Hdf5Handle& object, const char* name, double value) const;
  void setText(const Hdf5Handle& object, const char* name, const std::string& value) const;

  /// To be called last, when all other handles are closed.
  void close();

 private:
  void require(herr_t status) const;
  Hdf5Handle made(hid_t id, Hdf5Handle::Close closed_by) const;
  Hdf5Handle chunked(const std::vector<hsize_t>& chunk) const;
  void setAttribute(const Hdf5Handle& object, const char* name, hid_t type, const Hdf5Handle& space,
                    hid_t memory, const void* values) const;

  const std::string path_;
  const Hdf5Compression compression_;
  Hdf5Handle file_;
};

}  // namespace fast_edi
