#include "config/driver_keys.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace fast_edi {
namespace {

/// Of biases: current as coarse and fine value, or voltage and current of a converter.
constexpr std::array<std::string_view, 4> kBiasSuffixes = {"_coarse", "_fine", "_volt", "_curr"};

constexpr std::array<std::string_view, 14> kPrefixes = {
    "aps_",       "autoexposure_",
    "dvs_",       "background_activity_filter_",
    "frame_",     "imu_",
    "pixel_",     "polarity_",
    "roi_",       "refractory_period_",
    "skip_",      "reset_timestamps_",
    "max_events", "streaming_rate",
};

/// `groups` is what dynamic_reconfigure adds when it writes a file.
constexpr std::array<std::string_view, 4> kNames = {"exposure", "groups", "master",
                                                    "serial_number"};

}  // namespace

bool isDriverKey(const std::string& name) {
  const std::string_view view = name;
  return std::any_of(kBiasSuffixes.begin(), kBiasSuffixes.end(),
                     [&view](std::string_view suffix) {
                       return view.size() > suffix.size() &&
                              view.substr(view.size() - suffix.size()) == suffix;
                     }) ||
         std::any_of(kPrefixes.begin(), kPrefixes.end(),
                     [&view](std::string_view prefix) {
                       return view.substr(0, prefix.size()) == prefix;
                     }) ||
         std::find(kNames.begin(), kNames.end(), view) != kNames.end();
}

}  // namespace fast_edi
