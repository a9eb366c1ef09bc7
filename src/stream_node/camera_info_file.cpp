#include "stream_node/camera_info_file.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include <yaml-cpp/yaml.h>

#include "fast_edi/messages/message_conversion.hpp"

namespace fast_edi {
namespace {

std::vector<double> numbersOf(const YAML::Node& root, const std::string& key) {
  const YAML::Node data = root[key]["data"];
  if (!data) {
    throw std::runtime_error(key + " has no list \"data\"");
  }
  return data.as<std::vector<double>>();
}

template <typename Matrix>
void readMatrix(const YAML::Node& root, const std::string& key, Matrix& matrix) {
  const std::vector<double> numbers = numbersOf(root, key);
  if (numbers.size() != matrix.size()) {
    throw std::runtime_error(key + " has " + std::to_string(numbers.size()) +
                             " numbers, expected " + std::to_string(matrix.size()));
  }
  std::copy(numbers.begin(), numbers.end(), matrix.begin());
}

sensor_msgs::CameraInfo read(const YAML::Node& root) {
  for (const char* key : {"image_width", "image_height", "camera_matrix", "distortion_model",
                          "distortion_coefficients", "rectification_matrix", "projection_matrix"}) {
    if (!root.IsMap() || !root[key]) {
      throw std::runtime_error(std::string("has no ") + key);
    }
  }
  sensor_msgs::CameraInfo info;
  info.width = root["image_width"].as<std::uint32_t>();
  info.height = root["image_height"].as<std::uint32_t>();
  info.distortion_model = root["distortion_model"].as<std::string>();
  info.D = numbersOf(root, "distortion_coefficients");
  readMatrix(root, "camera_matrix", info.K);
  readMatrix(root, "rectification_matrix", info.R);
  readMatrix(root, "projection_matrix", info.P);
  const std::string fault = cameraInfoFault(info);
  if (!fault.empty()) {
    throw std::runtime_error(fault);
  }
  return info;
}

}  // namespace

sensor_msgs::CameraInfo readCameraInfoFile(const std::string& path) {
  try {
    return read(YAML::LoadFile(path));
  } catch (const std::exception& error) {
    throw std::runtime_error("calibration " + path + ": " + error.what());
  }
}

}  // namespace fast_edi
