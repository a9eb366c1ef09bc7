#include "validation/advice.hpp"

namespace fast_edi {
namespace {

struct Texts {
  const char* ros_driver;
  const char* dv;
  const char* other;
};

Texts textsFor(Remedy remedy) {
  switch (remedy) {
    case Remedy::kBackgroundActivityFilterOff:
      return {"driver: background_activity_filter_enabled: false",
              "DV: the camera's background activity filter off, and no noise filter between camera "
              "and recorder",
              "background activity and noise filters off, in the camera and where it was recorded"};
    case Remedy::kRefractoryFilterOff:
      return {"driver: refractory_period_enabled: false (or the bias RefrBp higher)",
              "DV: the camera's refractory period filter off (or the bias RefrBp higher)",
              "the camera's refractory filter off, or a shorter refractory period of its pixels"};
    case Remedy::kSkipFilterOff:
      return {"driver: skip_enabled: false", "DV: the camera's filter that skips events off",
              "the camera's filter that skips events off"};
    case Remedy::kBothPolarities:
      return {"driver: polarity_suppress: false, polarity_flatten: false; else check",
              "DV: events of both polarities, with no filter of polarity before the recorder; else "
              "check",
              "record and convert events of both polarities; else check"};
    case Remedy::kHotPixelsMasked:
      return {"driver: pixel_auto_train, or pixel_0_column/_row to pixel_7_...",
              "DV: the camera's filter of single pixels", "mask them in the camera, if it can"};
    case Remedy::kFixedFrameRegion:
      return {"driver: keep the region of interest of the frames (aps_roi_...) fixed",
              "DV: keep the region of interest of the frames fixed",
              "keep the region of interest of the frames fixed"};
    case Remedy::kWholeSensor:
      return {"driver: whole sensor for frames (aps_roi_...) and events",
              "DV: whole sensor for frames and events, neither cropped nor scaled before the "
              "recorder",
              "whole sensor for frames and events, neither cropped nor scaled"};
    case Remedy::kFrameEncoding:
      return {"driver: frame_mode 0, 1 or 2", "DV: grey or colour frames of 8 or 16 bits",
              "convert them to grey or colour of 8 or 16 bits"};
    case Remedy::kFewerLosses:
      return {
          "record with a larger buffer (rosbag record --buffsize 0), on the driver's machine, "
          "without compression, and at a lower event rate (biases)",
          "record on the machine of the camera, without compression, and at a lower event rate "
          "(biases)",
          "record on the machine of the camera, without compression, and at a lower event rate "
          "(biases)"};
    case Remedy::kLaterStart:
      return {
          "start recording a second after the driver; or cut it off: rosbag filter IN.bag "
          "OUT.bag \"t.secs > ...\"",
          "start recording a second after the camera", "start recording a second after the camera"};
    case Remedy::kGivenExposure:
      return {"exposure_time_us as proposed below, or as the driver has it",
              "exposure_time_us as proposed below, or as DV had it",
              "exposure_time_us as proposed below, or as the camera had it"};
    case Remedy::kHeldExposure:
      return {"update the driver, or hold the exposure fixed (autoexposure_enabled: false)",
              "update DV, or hold the exposure fixed",
              "update the recording program, or hold the exposure fixed"};
    case Remedy::kEventsBetween:
      return {"driver: keep events running between the exposures",
              "DV: keep events running between the exposures",
              "keep events running between the exposures"};
    case Remedy::kBiases:
      return {"driver: check", "DV: check", "camera: check"};
  }
  return {"", "", ""};
}

}  // namespace

std::string adviceFor(Remedy remedy, RecordingOrigin origin) {
  const Texts texts = textsFor(remedy);
  switch (origin) {
    case RecordingOrigin::kRosDriver:
      return texts.ros_driver;
    case RecordingOrigin::kDv:
      return texts.dv;
    case RecordingOrigin::kOther:
      break;
  }
  return texts.other;
}

}  // namespace fast_edi
