#include "hdf5/hdf5_dataset.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>
#include <utility>

#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/deflated_size.hpp"

namespace fast_edi {
namespace {

/// What HDF5 keeps of a dataset in any case.
constexpr std::size_t kLeastCacheBytes = std::size_t{1} << 20;
/// A prime number of places for chunks, of which few are kept.
constexpr std::size_t kCacheSlots = 521;
/// Used chunks are dropped first.
constexpr double kCachePreemption = 1.0;
/// No file holds more numbers [bytes] for each byte of its own.
constexpr std::uint64_t kMaxExpansion = 1000;
/// A small file may have more.
constexpr std::uint64_t kAnyFileHolds = std::uint64_t{64} << 20;
/// A compressed chunk is hardly larger than its content.
constexpr hsize_t kChunkOverhead = 4096;
constexpr hsize_t kChunkOverheadShare = 16;

constexpr std::size_t kChecksumBytes = 4;

/// Filters by the numbers that are registered for them, and what Debian packages them in.
struct KnownFilter {
  H5Z_filter_t id;
  const char* name;
  const char* package;
};
constexpr std::array<KnownFilter, 10> kKnownFilters = {
    {{H5Z_FILTER_SZIP, "szip", "an HDF5 with szip"},
     {307, "bzip2", "hdf5-filter-plugin"},
     {32000, "lzf", "hdf5-plugin-lzf"},
     {32001, "blosc", "hdf5-filter-plugin-blosc-serial"},
     {32004, "lz4", "hdf5-filter-plugin"},
     {32008, "bitshuffle", "hdf5-filter-plugin"},
     {32013, "zfp", "hdf5-filter-plugin-zfp-serial"},
     {32015, "zstd", nullptr},
     {32026, "blosc2", nullptr},
     {36559, "ecf (Prophesee)", nullptr}}};
/// Those of HDF5 itself that are safe with any parameters.
constexpr std::array<H5Z_filter_t, 4> kOwnFilters = {H5Z_FILTER_DEFLATE, H5Z_FILTER_SHUFFLE,
                                                     H5Z_FILTER_FLETCHER32, H5Z_FILTER_SZIP};

std::string howToInstall(H5Z_filter_t id) {
  const auto* known = std::find_if(kKnownFilters.begin(), kKnownFilters.end(),
                                   [id](const KnownFilter& filter) { return filter.id == id; });
  const std::string name = known == kKnownFilters.end() ? "" : std::string(known->name) + ", ";
  const std::string package = known == kKnownFilters.end() || known->package == nullptr
                                  ? ""
                                  : "install " + std::string(known->package) + " (Debian), or ";
  return "it is compressed by a filter that HDF5 has not (" + name + "number " +
         std::to_string(id) + "): " + package +
         "\"pip install hdf5plugin\" and set HDF5_PLUGIN_PATH to the folder that \"python3 -c "
         "'import hdf5plugin; print(hdf5plugin.PLUGIN_PATH)'\" prints";
}

std::string shapeText(const std::vector<hsize_t>& shape) {
  std::string text;
  for (const hsize_t size : shape) {
    text += (text.empty() ? "" : " x ") + std::to_string(size);
  }
  return text;
}

/// Saturates.
std::uint64_t product(const std::vector<hsize_t>& sizes, std::uint64_t bytes) {
  for (const hsize_t size : sizes) {
    bytes = size != 0 && bytes > UINT64_MAX / size ? UINT64_MAX : bytes * size;
  }
  return bytes;
}

}  // namespace

Hdf5Dataset::Hdf5Dataset(const Hdf5File& file, std::string name)
    : file_(file), name_(std::move(name)) {
  Hdf5Handle opened(H5Dopen2(file_.id(), name_.c_str(), H5P_DEFAULT), H5Dclose);
  if (!opened) {
    refuse("it cannot be opened (" + hdf5Fault() + ")");
  }
  const Hdf5Handle type(H5Dget_type(opened.id()), H5Tclose);
  const Hdf5Handle space(H5Dget_space(opened.id()), H5Sclose);
  const Hdf5Handle creation(H5Dget_create_plist(opened.id()), H5Pclose);
  if (!type || !space || !creation) {
    refuse("its type and size cannot be read (" + hdf5Fault() + ")");
  }
  checkType(type.id());
  const int dimensions = H5Sget_simple_extent_ndims(space.id());
  if (dimensions < 0 || dimensions > static_cast<int>(kMaxDimensions)) {
    refuse(std::to_string(dimensions) + " dimensions, expected at most " +
           std::to_string(kMaxDimensions));
  }
  is_scalar_ = dimensions == 0;
  shape_.assign(is_scalar_ ? 1 : static_cast<std::size_t>(dimensions), 1);
  if (!is_scalar_) {
    H5Sget_simple_extent_dims(space.id(), shape_.data(), nullptr);
  }
  checkShape();
  checkStorage(creation.id(), H5Dget_storage_size(opened.id()));
  // Anew, with room for a whole chunk, which would else be decompressed for each block.
  const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.id(), kCacheSlots, std::max(kLeastCacheBytes, chunk_bytes_),
                     kCachePreemption);
  opened = Hdf5Handle();
  dataset_ = Hdf5Handle(H5Dopen2(file_.id(), name_.c_str(), access.id()), H5Dclose);
  if (!dataset_) {
    refuse("it cannot be opened (" + hdf5Fault() + ")");
  }
}

void Hdf5Dataset::refuse(const std::string& what) const {
  throw RecordingError(file_.fault(name_, what));
}

void Hdf5Dataset::checkType(hid_t type) {
  if (!isUsualNumber(type)) {
    refuse("expected numbers: whole ones of 8 to 64 bits, or floating point of 32 or 64");
  }
  is_float_ = H5Tget_class(type) == H5T_FLOAT;
  element_bytes_ = H5Tget_size(type);
}

void Hdf5Dataset::checkShape() {
  std::error_code ignored;  // it was opened
  const std::uintmax_t file_bytes = std::filesystem::file_size(file_.path(), ignored);
  const std::uint64_t most = kAnyFileHolds + (ignored ? 0 : file_bytes * kMaxExpansion);
  if (product(shape_, element_bytes_) > most) {
    refuse("it states " + shapeText(shape_) + " numbers, expected at most " +
           std::to_string(most / element_bytes_) + " in a file of " + std::to_string(file_bytes) +
           " bytes");
  }
}

void Hdf5Dataset::checkStorage(hid_t creation, std::uint64_t stored) {
  const H5D_layout_t layout = H5Pget_layout(creation);
  if (layout == H5D_VIRTUAL || H5Pget_external_count(creation) > 0) {
    refuse("its data lie in other files, expected them in this one");
  }
  if (layout != H5D_CHUNKED) {
    const std::uint64_t expected = product(shape_, element_bytes_);
    // None is stored of what was never written.
    if (stored != 0 && stored != expected) {
      refuse("it has " + std::to_string(stored) + " bytes, expected " + std::to_string(expected));
    }
    return;
  }
  chunk_.resize(shape_.size());
  if (H5Pget_chunk(creation, static_cast<int>(chunk_.size()), chunk_.data()) !=
          static_cast<int>(shape_.size()) ||
      std::find(chunk_.begin(), chunk_.end(), hsize_t{0}) != chunk_.end()) {
    refuse("chunks of other dimensions than its own");
  }
  const std::uint64_t bytes = product(chunk_, element_bytes_);
  if (bytes > kMaxChunkBytes) {
    refuse("chunks of " + shapeText(chunk_) + " numbers, expected at most " +
           std::to_string(kMaxChunkBytes >> 20) +
           " MiB each (h5repack -l CHUNK=... makes smaller "
           "ones)");
  }
  chunk_bytes_ = static_cast<std::size_t>(bytes);
  checkFilters(creation);
  // Without filters all chunks have the same size. HDF5 itself says so of each, whatever its index
  // says, reads as many bytes as the index says, and beyond the end of those that hold less.
  if (H5Pget_nfilters(creation) == 0) {
    if (stored % bytes != 0) {
      refuse("it has " + std::to_string(stored) + " bytes, expected whole chunks of " +
             std::to_string(bytes));
    }
    is_checkable_ = false;
  }
}

void Hdf5Dataset::checkFilters(hid_t creation) {
  const int count = H5Pget_nfilters(creation);
  for (unsigned i = 0; static_cast<int>(i) < count; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    unsigned config = 0;
    const H5Z_filter_t id =
        H5Pget_filter2(creation, i, &flags, &values, nullptr, 0, nullptr, &config);
    if (id < 0) {
      refuse("its filters cannot be read (" + hdf5Fault() + ")");
    }
    const bool own = std::find(kOwnFilters.begin(), kOwnFilters.end(), id) != kOwnFilters.end();
    if (!own && id < H5Z_FILTER_RESERVED) {
      refuse("compressed by HDF5's filter number " + std::to_string(id) +
             ", expected deflate (gzip), shuffle, fletcher32 or szip");
    }
    if (H5Zfilter_avail(id) <= 0) {
      refuse(howToInstall(id));
    }
    // What is inflated first tells its size; see checkChunk().
    if (deflate_ && id != H5Z_FILTER_FLETCHER32) {
      refuse("compressed once more behind deflate, expected just a checksum there");
    }
    if (id == H5Z_FILTER_DEFLATE) {
      deflate_ = i;
    } else if (id == H5Z_FILTER_FLETCHER32) {
      checksum_ = i;
    }
    // What others hold only they know.
    is_checkable_ = is_checkable_ && own && id != H5Z_FILTER_SZIP;
  }
}

std::size_t Hdf5Dataset::rowElements() const {
  return std::accumulate(shape_.begin() + 1, shape_.end(), std::size_t{1}, std::multiplies<>());
}

std::string Hdf5Dataset::read(hsize_t first, hsize_t count, hid_t memory, void* values) {
  std::string fault = checkChunks(first, count);
  if (!fault.empty()) {
    return fault;
  }
  if (is_scalar_) {
    return H5Dread(dataset_.id(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0 ? hdf5Fault()
                                                                                     : "";
  }
  std::vector<hsize_t> offset(shape_.size(), 0);
  std::vector<hsize_t> block = shape_;
  offset[0] = first;
  block[0] = count;
  const Hdf5Handle in_file(H5Dget_space(dataset_.id()), H5Sclose);
  const Hdf5Handle in_memory(
      H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose);
  if (!in_file || !in_memory ||
      H5Sselect_hyperslab(in_file.id(), H5S_SELECT_SET, offset.data(), nullptr, block.data(),
                          nullptr) < 0 ||
      H5Dread(dataset_.id(), memory, in_memory.id(), in_file.id(), H5P_DEFAULT, values) < 0) {
    return hdf5Fault();
  }
  return {};
}

/// Looks at each chunk that the rows lie in before HDF5 takes memory for it.
std::string Hdf5Dataset::checkChunks(hsize_t first, hsize_t count) {
  if (chunk_.empty() || !is_checkable_ || count == 0) {
    return {};
  }
  const hsize_t begin = first / chunk_[0] * chunk_[0];
  std::vector<hsize_t> offset(chunk_.size(), 0);
  offset[0] = begin;
  for (;;) {
    std::string fault = checkChunk(offset);
    if (!fault.empty()) {
      return fault;
    }
    // The next one, like an odometer, whose last digit turns first.
    std::size_t d = chunk_.size();
    while (d > 0 && (offset[d - 1] += chunk_[d - 1]) >= (d == 1 ? first + count : shape_[d - 1])) {
      --d;
      offset[d] = d == 0 ? begin : 0;
    }
    if (d == 0) {
      return {};
    }
  }
}

/// HDF5 itself reads chunks that hold less than they should beyond their end.
std::string Hdf5Dataset::checkChunk(const std::vector<hsize_t>& offset) {
  if (offset == checked_chunk_) {
    return {};
  }
  hsize_t stored = 0;
  if (H5Dget_chunk_storage_size(dataset_.id(), offset.data(), &stored) < 0) {
    return hdf5Fault();
  }
  const std::string where = "the chunk at " + shapeText(offset);
  if (stored > chunk_bytes_ + chunk_bytes_ / kChunkOverheadShare + kChunkOverhead) {
    return where + " has " + std::to_string(stored) + " bytes compressed, expected at most about " +
           std::to_string(chunk_bytes_);
  }
  if (stored == 0) {
    return {};  // never written
  }
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stored));
  std::uint32_t left_out = 0;
  if (H5Dread_chunk(dataset_.id(), H5P_DEFAULT, offset.data(), &left_out, bytes.data()) < 0) {
    return hdf5Fault();
  }
  const auto is_applied = [left_out](const std::optional<unsigned>& filter) {
    return filter && (left_out >> *filter & 1U) == 0;
  };
  const std::size_t content =
      bytes.size() -
      (is_applied(checksum_) ? std::min(bytes.size(), kChecksumBytes) : std::size_t{0});
  if (is_applied(deflate_) ? !inflatesTo(bytes, chunk_bytes_) : content != chunk_bytes_) {
    return where + " is damaged: expected " + std::to_string(chunk_bytes_) + " bytes decompressed";
  }
  checked_chunk_ = offset;
  return {};
}

}  // namespace fast_edi
