#include "hdf5/hdf5_library.hpp"

#include <algorithm>
#include <array>

namespace fast_edi {
namespace {

/// Keeps the first description, which is that of the innermost function.
herr_t keepFirst(unsigned /*depth*/, const H5E_error2_t* error, void* text) {
  auto& kept = *static_cast<std::string*>(text);
  if (kept.empty() && error->desc != nullptr) {
    kept = error->desc;
  }
  return 0;
}

}  // namespace

bool isUsualNumber(hid_t type) {
  if (H5Tget_class(type) == H5T_ENUM) {
    const Hdf5Handle base(H5Tget_super(type), H5Tclose);
    return base && H5Tget_class(base.id()) == H5T_INTEGER && isUsualNumber(base.id());
  }
  const std::array<hid_t, 20> usual = {
      H5T_STD_I8LE,  H5T_STD_I8BE,   H5T_STD_U8LE,   H5T_STD_U8BE,   H5T_STD_I16LE,
      H5T_STD_I16BE, H5T_STD_U16LE,  H5T_STD_U16BE,  H5T_STD_I32LE,  H5T_STD_I32BE,
      H5T_STD_U32LE, H5T_STD_U32BE,  H5T_STD_I64LE,  H5T_STD_I64BE,  H5T_STD_U64LE,
      H5T_STD_U64BE, H5T_IEEE_F32LE, H5T_IEEE_F32BE, H5T_IEEE_F64LE, H5T_IEEE_F64BE};
  return std::any_of(usual.begin(), usual.end(),
                     [type](hid_t known) { return H5Tequal(type, known) > 0; });
}

void silenceHdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

std::string hdf5Fault() {
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keepFirst, &text);
  return text.empty() ? "HDF5 gives no reason" : "HDF5: " + text;
}

}  // namespace fast_edi
