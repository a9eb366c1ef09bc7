/// HDF5 with any content: the input says which arrays of which types and shapes there are, what is
/// in them, and in their chunks as they are stored. HDF5's own library writes the file: what it
/// does with heads that are damaged is not looked for.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <fuzzer/FuzzedDataProvider.h>
#include <hdf5.h>

#include "fast_edi/hdf5/hdf5_reader.hpp"
#include "fuzz/recording_intake.hpp"
#include "hdf5/hdf5_library.hpp"
#include "support/temporary_directory.hpp"

namespace {

using fast_edi::Hdf5Handle;

constexpr std::array<const char*, 22> kNames = {"events/t",
                                                "events/x",
                                                "events/y",
                                                "events/p",
                                                "events/ts",
                                                "events/xs",
                                                "events/ys",
                                                "events/ps",
                                                "t",
                                                "x",
                                                "y",
                                                "p",
                                                "t_offset",
                                                "events",
                                                "davis/left/events",
                                                "events/t_offset",
                                                "images/image0",
                                                "images/image1",
                                                "images/image2",
                                                "davis/left/image_raw",
                                                "davis/left/image_raw_ts",
                                                "ms_to_idx"};
constexpr std::array<const char*, 8> kAttributes = {
    "timestamp", "exposure_start", "exposure_end", "unit",
    "units",     "encoding",       "type",         "sensor_resolution"};
/// Arrays that are filled have no more [bytes].
constexpr std::uint64_t kMaxFilled = 4096;
constexpr H5Z_filter_t kUnknownFilter = 32001;

hid_t anyType(FuzzedDataProvider& input) {
  const std::vector<hid_t> types = {H5T_STD_I8LE,   H5T_STD_U8LE,   H5T_STD_I16LE, H5T_STD_U16BE,
                                    H5T_STD_I32LE,  H5T_STD_U32LE,  H5T_STD_I64LE, H5T_STD_U64BE,
                                    H5T_IEEE_F32LE, H5T_IEEE_F64LE, H5T_STD_B16LE, H5T_C_S1};
  return types[input.ConsumeIntegralInRange<std::size_t>(0, types.size() - 1)];
}

std::vector<hsize_t> anyShape(FuzzedDataProvider& input) {
  std::vector<hsize_t> shape(input.ConsumeIntegralInRange<std::size_t>(0, 5));
  for (hsize_t& size : shape) {
    size = input.ConsumeIntegralInRange<int>(0, 15) == 0
               ? input.ConsumeIntegralInRange<hsize_t>(0, hsize_t{1} << 40)
               : input.ConsumeIntegralInRange<hsize_t>(0, 12);
  }
  return shape;
}

void setFilters(FuzzedDataProvider& input, const Hdf5Handle& creation) {
  if (input.ConsumeBool()) {
    H5Pset_shuffle(creation.id());
  }
  if (input.ConsumeBool()) {
    H5Pset_deflate(creation.id(), 1);
  }
  if (input.ConsumeBool()) {
    H5Pset_fletcher32(creation.id());
  }
  if (input.ConsumeIntegralInRange<int>(0, 15) == 0) {
    H5Pset_filter(creation.id(), kUnknownFilter, H5Z_FLAG_OPTIONAL, 0, nullptr);
  }
}

/// A number, some, or text.
void addAttribute(FuzzedDataProvider& input, hid_t object) {
  const char* const name =
      kAttributes[input.ConsumeIntegralInRange<std::size_t>(0, kAttributes.size() - 1)];
  const bool text = input.ConsumeBool();
  const hsize_t count = input.ConsumeIntegralInRange<hsize_t>(1, 3);
  const Hdf5Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr),
                         H5Sclose);
  Hdf5Handle type(H5Tcopy(text ? H5T_C_S1 : anyType(input)), H5Tclose);
  if (text) {
    H5Tset_size(type.id(), 8);
  }
  const Hdf5Handle attribute(
      H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::vector<std::uint8_t> values = input.ConsumeBytes<std::uint8_t>(24);
  values.resize(24);
  H5Awrite(attribute.id(), type.id(), values.data());
}

void fill(FuzzedDataProvider& input, const Hdf5Handle& array, hid_t type,
          const std::vector<hsize_t>& shape, bool chunked) {
  std::uint64_t bytes = H5Tget_size(type);
  for (const hsize_t size : shape) {
    if (size != 0 && bytes > kMaxFilled / size) {
      return;
    }
    bytes *= size;
  }
  if (bytes == 0) {
    return;
  }
  std::vector<std::uint8_t> values = input.ConsumeBytes<std::uint8_t>(bytes);
  values.resize(bytes);
  H5Dwrite(array.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  if (chunked && input.ConsumeIntegralInRange<int>(0, 3) == 0) {
    const std::vector<hsize_t> first(shape.size(), 0);
    const std::vector<std::uint8_t> chunk =
        input.ConsumeBytes<std::uint8_t>(input.ConsumeIntegralInRange<std::size_t>(1, 256));
    if (!chunk.empty()) {
      H5Dwrite_chunk(array.id(), H5P_DEFAULT, input.ConsumeIntegralInRange<std::uint32_t>(0, 3),
                     first.data(), chunk.size(), chunk.data());
    }
  }
}

void addArray(FuzzedDataProvider& input, const Hdf5Handle& file, const char* name,
              const std::vector<hsize_t>& shape) {
  const hid_t type = anyType(input);
  const Hdf5Handle space(
      shape.empty() ? H5Screate(H5S_SCALAR)
                    : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
      H5Sclose);
  const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  bool chunked = false;
  if (!shape.empty() && input.ConsumeBool()) {
    std::vector<hsize_t> chunk(shape.size());
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      chunk[i] = input.ConsumeIntegralInRange<hsize_t>(1, 16);
    }
    chunked = H5Pset_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()) >= 0;
    setFilters(input, creation);
  }
  const Hdf5Handle array(
      H5Dcreate2(file.id(), name, type, space.id(), links.id(), creation.id(), H5P_DEFAULT),
      H5Dclose);
  if (!array) {
    return;
  }
  fill(input, array, type, shape, chunked);
  for (int i = input.ConsumeIntegralInRange<int>(0, 3); i > 0; --i) {
    addAttribute(input, array.id());
  }
}

/// Single arrays, or all columns of a layout with as many numbers each.
void addArrays(FuzzedDataProvider& input, const Hdf5Handle& file) {
  if (input.ConsumeBool()) {
    addArray(input, file, kNames[input.ConsumeIntegralInRange<std::size_t>(0, kNames.size() - 1)],
             anyShape(input));
    return;
  }
  constexpr std::size_t kLayouts = 3;
  constexpr std::size_t kColumns = 4;  // of a layout; together the first of kNames
  const std::size_t first = input.ConsumeIntegralInRange<std::size_t>(0, kLayouts - 1) * kColumns;
  const hsize_t count = input.ConsumeIntegralInRange<hsize_t>(0, 32);
  for (std::size_t i = first; i < first + kColumns; ++i) {
    addArray(input, file, kNames[i], {count});
  }
}

/// HDF5 writes no file that has no name.
std::string filePath() {
  static const fast_edi::TemporaryDirectory directory;
  return directory.file("fuzz.h5");
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  fast_edi::silenceHdf5();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider input(data, size);
  {
    const Hdf5Handle file(H5Fcreate(filePath().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
                          H5Fclose);
    fast_edi::fuzzing::require(static_cast<bool>(file), "HDF5 can write");
    while (input.remaining_bytes() > 0) {
      addArrays(input, file);
    }
  }
  fast_edi::fuzzing::readTwice([] { return fast_edi::openHdf5(filePath()); });
  return 0;
}
