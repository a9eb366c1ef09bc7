/// \file
/// An HDF5 file that is only ever read: what is in it, and attributes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hdf5/hdf5_library.hpp"

namespace fast_edi {

/// A number as an attribute has it.
struct Hdf5Number {
  double value = 0.0;
  bool is_whole = false;  ///< of a type for whole numbers
};

class Hdf5File {
 public:
  /// \throws RecordingError
  explicit Hdf5File(const std::string& path);

  const std::string& path() const { return path_; }
  hid_t id() const { return file_.id(); }

  // Objects by their paths, e.g. "events/x". Soft and external links, which may lead anywhere, are
  // not followed.
  bool hasGroup(const std::string& name) const { return kindOf(name) == H5O_TYPE_GROUP; }
  bool hasDataset(const std::string& name) const { return kindOf(name) == H5O_TYPE_DATASET; }
  /// Names of a group's members, sorted.
  /// \throws RecordingError when the group is damaged
  std::vector<std::string> members(const std::string& group) const;

  // Attributes; nothing where there is none of that kind. The file itself is "/".
  std::optional<Hdf5Number> number(const std::string& object, const char* attribute) const;
  std::vector<std::int64_t> wholeNumbers(const std::string& object, const char* attribute) const;
  /// Of a fixed length; see the implementation.
  std::string text(const std::string& object, const char* attribute) const;

  /// What is wrong with a part of the file, to be thrown.
  std::string fault(const std::string& object, const std::string& what) const {
    return path_ + ", " + object + ": " + what;
  }

 private:
  std::optional<H5O_type_t> kindOf(const std::string& name) const;
  Hdf5Handle attributeOf(const std::string& object, const char* attribute) const;

  std::string path_;
  Hdf5Handle file_;
};

}  // namespace fast_edi
