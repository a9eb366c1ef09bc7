#include "tag_node/tag_messages.hpp"
#include "fast_edi/base/sensor_size.hpp"

#include <cmath>

#include <sensor_msgs/distortion_models.h>
#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

using visualization_msgs::Marker;

constexpr double kThicknessOverSide = 0.02;
constexpr float kGreen = 0.8F;
constexpr float kShown = 0.8F;
/// OpenCV's counts of coefficients, by the name that ROS has for them.
constexpr std::size_t kPlumbBobCoefficients = 5;
constexpr std::size_t kRationalCoefficients = 8;
constexpr std::size_t kFisheyeCoefficients = 4;

CameraReading refuse(std::string reason) {
  CameraReading reading;
  reading.reason = std::move(reason);
  return reading;
}

/// \return what is wrong, if anything
std::string readDistortion(const sensor_msgs::CameraInfo& info, CameraModel& camera) {
  const std::string& model = info.distortion_model;
  if (info.D.empty()) {
    return "";
  }
  std::size_t expected = 0;
  if (model == sensor_msgs::distortion_models::PLUMB_BOB) {
    expected = kPlumbBobCoefficients;
  } else if (model == sensor_msgs::distortion_models::RATIONAL_POLYNOMIAL) {
    expected = kRationalCoefficients;
  } else if (model == "equidistant" || model == "fisheye") {
    expected = kFisheyeCoefficients;
    camera.fisheye = true;
  } else {
    return "distortion_model \"" + model +
           "\", expected plumb_bob, rational_polynomial or equidistant";
  }
  if (info.D.size() != expected) {
    return std::to_string(info.D.size()) + " coefficients in D, expected " +
           std::to_string(expected) + " for " + model;
  }
  camera.distortion.assign(info.D.begin(), info.D.end());
  for (const double coefficient : camera.distortion) {
    if (!std::isfinite(coefficient)) {
      return "D is not finite";
    }
  }
  return "";
}

geometry_msgs::Pose toMessage(const TagPose& pose) {
  geometry_msgs::Pose message;
  message.position.x = pose.position_m.x();
  message.position.y = pose.position_m.y();
  message.position.z = pose.position_m.z();
  message.orientation.x = pose.orientation.x();
  message.orientation.y = pose.orientation.y();
  message.orientation.z = pose.orientation.z();
  message.orientation.w = pose.orientation.w();
  return message;
}

}  // namespace

CameraReading readCamera(const sensor_msgs::CameraInfo* info, cv::Size image_size, bool rectified) {
  if (info == nullptr) {
    return refuse("no camera_info was received");
  }
  CameraModel camera;
  camera.fx_px = rectified ? info->P[0] : info->K[0];
  camera.cx_px = rectified ? info->P[2] : info->K[2];
  camera.fy_px = rectified ? info->P[5] : info->K[4];
  camera.cy_px = rectified ? info->P[6] : info->K[5];
  const std::string matrix = rectified ? "P" : "K";
  if (camera.fx_px == 0.0 && camera.fy_px == 0.0) {
    return refuse(matrix + " of camera_info is zero: the camera is not calibrated");
  }
  if (!(camera.fx_px > 0.0) || !(camera.fy_px > 0.0) || !std::isfinite(camera.fx_px) ||
      !std::isfinite(camera.fy_px) || !std::isfinite(camera.cx_px) ||
      !std::isfinite(camera.cy_px)) {
    return refuse(matrix + " of camera_info: expected focal lengths above 0 and finite values");
  }
  if (info->width != 0 && info->height != 0 &&
      (static_cast<int>(info->width) != image_size.width ||
       static_cast<int>(info->height) != image_size.height)) {
    return refuse("camera_info is for " + sizeText(info->width, info->height) +
                  " pixels, the image has " + sizeText(image_size.width, image_size.height));
  }
  if (!rectified) {
    const std::string fault = readDistortion(*info, camera);
    if (!fault.empty()) {
      return refuse("camera_info: " + fault);
    }
  }
  CameraReading reading;
  reading.camera = std::move(camera);
  return reading;
}

visualization_msgs::MarkerArrayPtr makeTagMarkers(const std_msgs::Header& header,
                                                  const std::vector<TagDetection>& tags,
                                                  const std::optional<CameraModel>& camera,
                                                  const TagMarkerSettings& settings) {
  auto array = boost::make_shared<visualization_msgs::MarkerArray>();
  array->markers.reserve(tags.size() + 1);
  Marker clear;
  clear.header = header;
  clear.ns = settings.family;
  clear.action = Marker::DELETEALL;
  clear.pose.orientation.w = 1.0;
  array->markers.push_back(clear);
  for (const TagDetection& tag : tags) {
    Marker marker;
    marker.header = header;
    marker.ns = settings.family;
    marker.id = tag.id;
    marker.type = Marker::CUBE;
    marker.action = Marker::ADD;
    marker.pose.orientation.w = 1.0;
    marker.scale.x = settings.tag_size_m;
    marker.scale.y = settings.tag_size_m;
    marker.scale.z = settings.tag_size_m * kThicknessOverSide;
    marker.color.g = kGreen;
    if (camera) {
      if (const auto pose = estimateTagPose(tag.corners, settings.tag_size_m, *camera)) {
        marker.pose = toMessage(*pose);
        marker.color.a = kShown;
      }
    }
    for (const cv::Point2d& corner : tag.corners) {
      geometry_msgs::Point point;
      point.x = corner.x;
      point.y = corner.y;
      marker.points.push_back(point);
    }
    array->markers.push_back(std::move(marker));
  }
  return array;
}

}  // namespace fast_edi
