/// \file
/// Pictures of a recording that are decoded by Python: the module that `pip` builds has no decoder.
#pragma once

#include <pybind11/pybind11.h>

#include "fast_edi/recording/picture_decoder.hpp"

namespace fast_edi::python {

/// \param decode takes the format as str and the picture as bytes; returns an array of uint8 or
///        uint16 of shape (height, width) or (height, width, samples) with its encoding, or a str
///        that says what is wrong. What it raises is taken for what is wrong, too.
/// \return to be called, copied and destroyed without the interpreter's lock
PictureDecoder pictureDecoder(pybind11::object decode);

/// As \p decode above returns it. \param fault what is wrong; empty if nothing is
pybind11::object pictureForPython(const Picture& picture, const std::string& fault);

}  // namespace fast_edi::python
