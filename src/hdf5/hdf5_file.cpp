#include "hdf5/hdf5_file.hpp"

#include <algorithm>
#include <new>

#include "fast_edi/recording/byte_source.hpp"
#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

/// Values of an attribute that are looked at.
constexpr hssize_t kMaxAttributeValues = 16;
constexpr std::size_t kMaxAttributeText = 256;
/// Members of a group: images of a day, at 100 a second.
constexpr std::size_t kMaxMembers = 10'000'000;

/// Appends the name of a link; stops at too many.
herr_t appendName(hid_t /*group*/, const char* name, const H5L_info_t* /*info*/, void* names) {
  auto& list = *static_cast<std::vector<std::string>*>(names);
  try {
    list.emplace_back(name);
  } catch (const std::bad_alloc&) {
    return -1;
  }
  return list.size() < kMaxMembers ? 0 : -1;
}

hssize_t valuesOf(const Hdf5Handle& attribute) {
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose);
  return space ? H5Sget_simple_extent_npoints(space.id()) : 0;
}

/// H5T_NO_CLASS for numbers of unusual types, too.
H5T_class_t classOf(const Hdf5Handle& attribute) {
  const Hdf5Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const H5T_class_t kind = type ? H5Tget_class(type.id()) : H5T_NO_CLASS;
  return kind == H5T_STRING || (type && isUsualNumber(type.id())) ? kind : H5T_NO_CLASS;
}

}  // namespace

Hdf5File::Hdf5File(const std::string& path) : path_(path) {
  const FileSource readable(path);  // else it says why
  silenceHdf5();
  file_ = Hdf5Handle(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file_) {
    const std::string reason = hdf5Fault();
    throw RecordingError(path + " cannot be opened as HDF5 (" + reason + ")");
  }
}

std::optional<H5O_type_t> Hdf5File::kindOf(const std::string& name) const {
  // Link by link: H5Lexists() fails where a parent is missing.
  std::size_t end = 0;
  do {
    end = name.find('/', end + 1);
    const std::string part = name.substr(0, end);
    H5L_info_t link = {};
    if (part != "/" &&
        (H5Lexists(id(), part.c_str(), H5P_DEFAULT) <= 0 ||
         H5Lget_info(id(), part.c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)) {
      return std::nullopt;
    }
  } while (end != std::string::npos);
  const Hdf5Handle object(H5Oopen(id(), name.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object) {
    return std::nullopt;
  }
  switch (H5Iget_type(object.id())) {
    case H5I_GROUP:
      return H5O_TYPE_GROUP;
    case H5I_DATASET:
      return H5O_TYPE_DATASET;
    default:
      return std::nullopt;
  }
}

std::vector<std::string> Hdf5File::members(const std::string& group) const {
  const Hdf5Handle opened(H5Gopen2(id(), group.c_str(), H5P_DEFAULT), H5Gclose);
  std::vector<std::string> names;
  hsize_t place = 0;
  if (!opened ||
      H5Literate(opened.id(), H5_INDEX_NAME, H5_ITER_NATIVE, &place, appendName, &names) < 0) {
    const std::string reason = hdf5Fault();
    throw RecordingError(fault(group, "its members cannot be read (" + reason + ")"));
  }
  std::sort(names.begin(), names.end());
  return names;
}

Hdf5Handle Hdf5File::attributeOf(const std::string& object, const char* attribute) const {
  if (H5Aexists_by_name(id(), object.c_str(), attribute, H5P_DEFAULT) <= 0) {
    return {};
  }
  return {H5Aopen_by_name(id(), object.c_str(), attribute, H5P_DEFAULT, H5P_DEFAULT), H5Aclose};
}

std::optional<Hdf5Number> Hdf5File::number(const std::string& object, const char* attribute) const {
  const Hdf5Handle found = attributeOf(object, attribute);
  if (!found || valuesOf(found) != 1) {
    return std::nullopt;
  }
  const H5T_class_t kind = classOf(found);
  Hdf5Number number;
  number.is_whole = kind == H5T_INTEGER;
  if ((kind != H5T_INTEGER && kind != H5T_FLOAT) ||
      H5Aread(found.id(), H5T_NATIVE_DOUBLE, &number.value) < 0) {
    return std::nullopt;
  }
  return number;
}

std::vector<std::int64_t> Hdf5File::wholeNumbers(const std::string& object,
                                                 const char* attribute) const {
  const Hdf5Handle found = attributeOf(object, attribute);
  const hssize_t count = found ? valuesOf(found) : 0;
  if (count < 1 || count > kMaxAttributeValues || classOf(found) != H5T_INTEGER) {
    return {};
  }
  std::vector<std::int64_t> values(static_cast<std::size_t>(count));
  return H5Aread(found.id(), H5T_NATIVE_INT64, values.data()) < 0 ? std::vector<std::int64_t>()
                                                                  : values;
}

std::string Hdf5File::text(const std::string& object, const char* attribute) const {
  const Hdf5Handle found = attributeOf(object, attribute);
  if (!found || valuesOf(found) != 1 || classOf(found) != H5T_STRING) {
    return {};
  }
  const Hdf5Handle type(H5Aget_type(found.id()), H5Tclose);
  // What reads strings of variable length ("global heap") trusts the file: a damaged one ends the
  // process.
  if (H5Tis_variable_str(type.id()) != 0) {
    return {};
  }
  const std::size_t size = H5Tget_size(type.id());
  if (size == 0 || size > kMaxAttributeText) {
    return {};
  }
  std::string value(size, '\0');
  if (H5Aread(found.id(), type.id(), value.data()) < 0) {
    return {};
  }
  return value.substr(0, value.find('\0'));
}

}  // namespace fast_edi
