#include "hdf5/hdf5_output.hpp"

#include <algorithm>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

/// Of zlib: what is slower gains little.
constexpr unsigned kDeflateLevel = 4;

}  // namespace

Hdf5Output::Hdf5Output(const std::string& path, Hdf5Compression compression)
    : path_(path), compression_(compression) {
  silenceHdf5();
  file_ = made(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
}

void Hdf5Output::require(herr_t status) const {
  if (status < 0) {
    const std::string reason = hdf5Fault();
    throw RecordingError("cannot write " + path_ + " (" + reason + ")");
  }
}

Hdf5Handle Hdf5Output::made(hid_t id, Hdf5Handle::Close closed_by) const {
  require(id < 0 ? -1 : 0);
  return {id, closed_by};
}

Hdf5Handle Hdf5Output::makeGroup(const char* name) const {
  return made(H5Gcreate2(file_.id(), name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
}

/// What arrays in chunks of that shape are made with.
Hdf5Handle Hdf5Output::chunked(const std::vector<hsize_t>& chunk) const {
  Hdf5Handle creation = made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  // A chunk of nothing is refused.
  if (std::find(chunk.begin(), chunk.end(), hsize_t{0}) == chunk.end()) {
    require(H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()));
    if (compression_ == Hdf5Compression::kGzip) {
      require(H5Pset_shuffle(creation.id()));
      require(H5Pset_deflate(creation.id(), kDeflateLevel));
    }
  }
  return creation;
}

Hdf5Handle Hdf5Output::writeArray(const Hdf5Handle& parent, const char* name, hid_t type,
                                  const std::vector<hsize_t>& shape, hid_t memory,
                                  const void* values) const {
  const Hdf5Handle space =
      made(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Hdf5Handle creation = chunked(shape);
  Hdf5Handle array =
      made(H5Dcreate2(parent.id(), name, type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
           H5Dclose);
  if (H5Sget_simple_extent_npoints(space.id()) > 0) {
    require(H5Dwrite(array.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
  }
  return array;
}

void Hdf5Output::writeNumber(const Hdf5Handle& parent, const char* name, std::int64_t value) const {
  const Hdf5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle number = made(H5Dcreate2(parent.id(), name, H5T_STD_I64LE, space.id(),
                                            H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                 H5Dclose);
  require(H5Dwrite(number.id(), H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, &value));
}

Hdf5Handle Hdf5Output::makeColumn(const Hdf5Handle& parent, const char* name, hid_t type,
                                  hsize_t chunk) const {
  const hsize_t rows = 0;
  const hsize_t most = H5S_UNLIMITED;
  const Hdf5Handle space = made(H5Screate_simple(1, &rows, &most), H5Sclose);
  const Hdf5Handle creation = chunked({chunk});
  return made(
      H5Dcreate2(parent.id(), name, type, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
      H5Dclose);
}

void Hdf5Output::append(const Hdf5Handle& column, hsize_t rows, hid_t memory, const void* values,
                        hsize_t count) const {
  const hsize_t rows_then = rows + count;
  require(H5Dset_extent(column.id(), &rows_then));
  const Hdf5Handle in_file = made(H5Dget_space(column.id()), H5Sclose);
  const Hdf5Handle in_memory = made(H5Screate_simple(1, &count, nullptr), H5Sclose);
  require(H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, &rows, nullptr, &count, nullptr));
  require(H5Dwrite(column.id(), memory, in_memory.id(), in_file.id(), H5P_DEFAULT, values));
}

void Hdf5Output::setAttribute(const Hdf5Handle& object, const char* name, hid_t type,
                              const Hdf5Handle& space, hid_t memory, const void* values) const {
  const Hdf5Handle attribute =
      made(H5Acreate2(object.id(), name, type, space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  require(H5Awrite(attribute.id(), memory, values));
}

void Hdf5Output::setNumbers(const Hdf5Handle& object, const char* name,
                            const std::vector<std::int64_t>& values) const {
  const hsize_t count = values.size();
  const Hdf5Handle space = made(H5Screate_simple(1, &count, nullptr), H5Sclose);
  setAttribute(object, name, H5T_STD_I64LE, space, H5T_NATIVE_INT64, values.data());
}

void Hdf5Output::setNumber(const Hdf5Handle& object, const char* name, double value) const {
  const Hdf5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  setAttribute(object, name, H5T_IEEE_F64LE, space, H5T_NATIVE_DOUBLE, &value);
}

void Hdf5Output::setText(const Hdf5Handle& object, const char* name,
                         const std::string& value) const {
  const Hdf5Handle type = made(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type.id(), value.size() + 1));  // and the zero at its end
  const Hdf5Handle space = made(H5Screate(H5S_SCALAR), H5Sclose);
  setAttribute(object, name, type.id(), space, type.id(), value.c_str());
}

void Hdf5Output::close() {
  require(H5Fflush(file_.id(), H5F_SCOPE_LOCAL));
  file_ = Hdf5Handle();
}

}  // namespace fast_edi
