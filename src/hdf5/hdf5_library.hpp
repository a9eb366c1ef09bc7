/// \file
/// HDF5's library (1.10): handles that close themselves, and its errors as text.
#pragma once

#include <string>
#include <utility>

#include <hdf5.h>

namespace fast_edi {

/// Closes an object of HDF5's by the function that is meant for its kind.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);

  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept {
    reset();
    id_ = std::exchange(other.id_, H5I_INVALID_HID);
    close_ = other.close_;
    return *this;
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;

  /// Negative: HDF5 could not make it.
  hid_t id() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  void reset() {
    if (id_ >= 0) {
      close_(id_);
    }
  }

  hid_t id_ = H5I_INVALID_HID;
  Close close_ = nullptr;
};

/// Keeps HDF5 from printing errors, for all of the process: also at its end, when HDF5 would
/// complain of what a damaged file has left open.
void silenceHdf5();

/// Whether a type is one of the usual ones, or an enumeration of such: whole numbers of 8 to 64
/// bits, or floating point of 32 or 64. Converting others, HDF5 trusts what the file says of their
/// bits.
bool isUsualNumber(hid_t type);

/// Why the last call failed, as HDF5 says it. The next call of any of its functions forgets it.
std::string hdf5Fault();

}  // namespace fast_edi
