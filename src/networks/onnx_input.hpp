/// \file
/// What an ONNX model takes, read from its file: OpenCV's dnn does not tell.
#pragma once

#include <string>

namespace fast_edi {

/// Of the only input, an image as 1 x channels x height x width; 0: any.
struct OnnxInput {
  int channels = 0;
  int height = 0;
  int width = 0;
};

/// \param model content of an ONNX file (a ModelProto of Protocol Buffers, see onnx.proto of
///        github.com/onnx/onnx)
/// \throws std::runtime_error when it is not one, or does not take one image
OnnxInput onnxInput(const std::string& model);

}  // namespace fast_edi
