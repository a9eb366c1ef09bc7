#include "config/parameter_keys.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "config/driver_keys.hpp"
#include "fast_edi/base/number_text.hpp"
#include "fast_edi/base/parameter_ranges.hpp"

namespace fast_edi {
namespace {

using TimeMember = std::int64_t DeblurParameters::*;
using InstantMember = ExposureInstant DeblurParameters::*;

template <typename Choice>
using Choices = std::vector<std::pair<std::string, Choice>>;

template <typename Choice>
std::string wordFor(const Choices<Choice>& choices, Choice value) {
  for (const auto& choice : choices) {
    if (choice.second == value) {
      return choice.first;
    }
  }
  return {};
}

const Choices<ExposureInstant>& instants() {
  static const Choices<ExposureInstant> choices = {{"start", ExposureInstant::kStart},
                                                   {"mid", ExposureInstant::kMid},
                                                   {"end", ExposureInstant::kEnd}};
  return choices;
}

/// The whole units apart, so that no nanosecond of a long time is lost in a double.
std::int64_t toNanoseconds(double value, std::int64_t ns_per_unit) {
  const double whole = std::trunc(value);
  return static_cast<std::int64_t>(whole) * ns_per_unit +
         std::llround((value - whole) * static_cast<double>(ns_per_unit));
}

/// A duration, in the unit of the key outside and in nanoseconds inside.
ConfigKey timeKey(const ParameterRange& parameter, std::int64_t ns_per_unit, TimeMember member,
                  const std::string& doc) {
  const double default_value =
      static_cast<double>(DeblurParameters{}.*member) / static_cast<double>(ns_per_unit);
  return numberKey(parameter, numberText(default_value), doc,
                   [member, ns_per_unit](double value, ParameterDraft& draft) {
                     draft.loaded.deblur.*member = toNanoseconds(value, ns_per_unit);
                   });
}

ConfigKey instantKey(const std::string& name, InstantMember member, const std::string& doc) {
  return choiceKey<ExposureInstant>(
      {name, "", wordFor(instants(), DeblurParameters{}.*member), doc}, instants(),
      [member](ExposureInstant value, ParameterDraft& draft) {
        draft.loaded.deblur.*member = value;
      });
}

ConfigKey thresholdKey(const ParameterRange& parameter, double ContrastThresholds::*member,
                       const std::string& polarity) {
  return numberKey(parameter, "from `biases`",
                   "contrast threshold of " + polarity +
                       " events; overrides `biases`. Set live to 0 to use the one from `biases`",
                   [member](double value, ParameterDraft& draft) {
                     draft.loaded.deblur.thresholds.*member = value;
                   });
}

ConfigKey weightingKey() {
  const Choices<Weighting> choices = {{"time", Weighting::kTime}, {"counter", Weighting::kCounter}};
  return choiceKey<Weighting>(
      {"weighting", "", wordFor(choices, DeblurParameters{}.weighting),
       "weight of a latent value in the double integral: the time until the pixel's next event "
       "(exact), or the number of events in the whole frame until then (Lin et al., ICRA 2023)"},
      choices,
      [](Weighting value, ParameterDraft& draft) { draft.loaded.deblur.weighting = value; });
}

ConfigKey exposureSourceKey() {
  const Choices<ExposureSource> choices = {{"topic", ExposureSource::kTopic},
                                           {"parameter", ExposureSource::kParameter}};
  return choiceKey<ExposureSource>(
      {"exposure_source", "", wordFor(choices, DeblurParameters{}.exposure_source),
       "source of the exposure time; without a message, `topic` falls back on the last one "
       "received, then on `exposure_time_us`"},
      choices, [](ExposureSource value, ParameterDraft& draft) {
        draft.loaded.deblur.exposure_source = value;
      });
}

ConfigKey eventPolarityKey() {
  const Choices<EventPolarity> choices = {{"normal", EventPolarity::kNormal},
                                          {"inverted", EventPolarity::kInverted}};
  return choiceKey<EventPolarity>(
      {"event_polarity", "", wordFor(choices, EventMapping{}.polarity),
       "`inverted`: the recording calls events of pixels that grow darker ON"},
      choices, [](EventPolarity value, ParameterDraft& draft) {
        draft.loaded.deblur.event_mapping.polarity = value;
      });
}

ConfigKey eventOrientationKey() {
  const Choices<EventOrientation> choices(kEventOrientations.begin(), kEventOrientations.end());
  return choiceKey<EventOrientation>(
      {"event_orientation", "", toString(EventMapping{}.orientation),
       "how the events are turned to fit the frames, e.g. `flip_y` where their y points upwards; "
       "`rotate_90` is clockwise"},
      choices, [](EventOrientation value, ParameterDraft& draft) {
        draft.loaded.deblur.event_mapping.orientation = value;
      });
}

ConfigKey maxBufferedEventsKey() {
  return integerKey(
      limits::kBufferedEvents, std::to_string(DeblurParameters{}.max_buffered_events),
      "maximum number of events in memory, buffered and queued together; memory grows as needed",
      [](std::int64_t value, ParameterDraft& draft) {
        draft.loaded.deblur.max_buffered_events = static_cast<std::size_t>(value);
      });
}

ConfigKey latentImagesKey() {
  return integerKey(
      limits::kLatentImages, std::to_string(LatentSampling{}.per_exposure),
      "high-rate video on `latent/image_raw`: number of evenly spaced images in each exposure, "
      "and at most as many in the gap before it if events cover the gap; 0 = off",
      [](std::int64_t value, ParameterDraft& draft) {
        draft.loaded.deblur.latent.per_exposure = static_cast<int>(value);
      });
}

/// A key whose value Deblurrer::setParameters() can change between two frames.
ConfigKey live(ConfigKey key) {
  key.description.live = true;
  return key;
}

/// What goes beyond plain EDI: one switch for all of it, then piece by piece.
std::vector<ConfigKey> filterKeys() {
  const FilterParameters defaults;
  return {
      boolKey(
          {"filter", "", boolText(defaults.enabled),
           "all processing beyond plain EDI: the filters and the learning below"},
          [](bool value, ParameterDraft& draft) { draft.loaded.deblur.filter.enabled = value; }),
      boolKey({"filter_despeckle", "", boolText(defaults.gain.despeckle),
               "give hot pixels, alone or in groups and columns, the log gain of their neighbours"},
              [](bool value, ParameterDraft& draft) {
                draft.loaded.deblur.filter.gain.despeckle = value;
              }),
      boolKey({"filter_gain", "", boolText(defaults.gain.smooth),
               "take the noise of events out of the map of log gains, keeping edges and corners"},
              [](bool value, ParameterDraft& draft) {
                draft.loaded.deblur.filter.gain.smooth = value;
              }),
      numberKey(limits::kFilterGainNoise, numberText(static_cast<double>(defaults.gain.noise)),
                "noise of a log gain; differences well above this are edges",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.filter.gain.noise = static_cast<float>(value);
                }),
      numberKey(limits::kFilterGainSigma,
                numberText(static_cast<double>(defaults.gain.spatial_sigma_px)),
                "width of that smoothing",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.filter.gain.spatial_sigma_px = static_cast<float>(value);
                }),
      numberKey(limits::kFilterGainRestore, numberText(static_cast<double>(defaults.gain.restore)),
                "fraction by which log gains of few events are raised: what lies between two "
                "thresholds; 0 = off",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.filter.gain.restore = static_cast<float>(value);
                }),
      boolKey({"filter_frame_noise", "", boolText(defaults.frame_noise),
               "reduce read and shot noise in the deblurred image"},
              [](bool value, ParameterDraft& draft) {
                draft.loaded.deblur.filter.frame_noise = value;
              }),
      numberKey(limits::kFilterFrameNoiseKept, numberText(defaults.frame_noise_kept),
                "fraction of that noise which stays, and with it texture as faint as the noise, in "
                "which trackers find corners; 0 = as clean as can be",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.filter.frame_noise_kept = value;
                }),
      boolKey({"filter_reblur", "", boolText(defaults.reblur),
               "deblur what causes no events, too, by the motion that other pixels' events show; "
               "where that motion does not explain frame and events, nothing changes"},
              [](bool value, ParameterDraft& draft) { draft.loaded.deblur.filter.reblur = value; }),
      boolKey({"filter_motion", "", boolText(defaults.motion),
               "stabilise images away from mid-exposure by warping the mid-exposure image along "
               "the optical flow: those on `latent/image_raw`, and the deblurred frames if "
               "`reference` is `start` or `end`"},
              [](bool value, ParameterDraft& draft) { draft.loaded.deblur.filter.motion = value; }),
      numberKey(
          limits::kFilterTemporal, numberText(defaults.temporal),
          "blend each deblurred frame with the previous one, updated by the events in between; "
          "weight of the previous one, 0 = off",
          [](double value, ParameterDraft& draft) { draft.loaded.deblur.filter.temporal = value; }),
      numberKey(limits::kLevelRamp,
                numberText(static_cast<double>(DeblurParameters{}.level.ramp_ns) /
                           static_cast<double>(kNanosecondsPerMillisecond)),
                "longest ramp of a pixel's log intensity before an event; shorter if the previous "
                "event is more recent; 0 = no ramp, a jump at the event",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.level.ramp_ns =
                      toNanoseconds(value, kNanosecondsPerMillisecond);
                }),
      numberKey(
          limits::kLevelRampFraction, numberText(DeblurParameters{}.level.fraction),
          "fraction of the event's step covered by that ramp; the rest is a jump at the event",
          [](double value, ParameterDraft& draft) { draft.loaded.deblur.level.fraction = value; }),
      boolKey(
          {"refine_contrast", "", boolText(DeblurParameters{}.refine_contrast),
           "learn the contrast thresholds from consecutive frames, within 30 % of the given ones"},
          [](bool value, ParameterDraft& draft) { draft.loaded.deblur.refine_contrast = value; }),
      boolKey({"refine_delay", "", boolText(DeblurParameters{}.refine_delay),
               "learn by how much events lag behind the light, up to 15 ms"},
              [](bool value, ParameterDraft& draft) { draft.loaded.deblur.refine_delay = value; }),
      numberKey(limits::kFrameNoise, numberText(defaults.frame_noise_dn),
                "standard deviation of a frame's noise; 0 = measured in each frame",
                [](double value, ParameterDraft& draft) {
                  draft.loaded.deblur.filter.frame_noise_dn = value;
                }),
  };
}

ConfigKey biasesKey() {
  ConfigKey key = mapKey({"biases", "", "none",
                          "bias settings from which the thresholds are computed, or the path of a "
                          "YAML file with them, such as the driver's"},
                         biasKeys());
  key.is_foreign = isDriverKey;
  key.may_be_file = true;
  return key;
}

std::vector<ConfigKey> buildTopLevelKeys() {
  std::vector<ConfigKey> keys = {
      live(thresholdKey(limits::kContrastOn, &ContrastThresholds::on, "ON")),
      live(thresholdKey(limits::kContrastOff, &ContrastThresholds::off, "OFF")),
      biasesKey(),
      weightingKey(),
      live(instantKey("reference", &DeblurParameters::reference,
                      "instant of the exposure that the deblurred image shows")),
      live(instantKey("stamp_reference", &DeblurParameters::stamp_reference,
                      "instant of the exposure that the stamp of an input image refers to")),
      live(exposureSourceKey()),
      live(timeKey(limits::kExposureTime, kNanosecondsPerMicrosecond,
                   &DeblurParameters::exposure_time_ns, "exposure time; 0 = unknown")),
      live(timeKey(limits::kTimeOffset, kNanosecondsPerMicrosecond,
                   &DeblurParameters::time_offset_ns,
                   "event time minus frame time of the same instant")),
      live(timeKey(limits::kEventDelay, kNanosecondsPerMicrosecond,
                   &DeblurParameters::event_delay_ns,
                   "how far events lag behind the light; refine_delay learns from there on")),
      live(eventPolarityKey()),
      live(eventOrientationKey()),
      live(timeKey(limits::kCloseTimeout, kNanosecondsPerMillisecond,
                   &DeblurParameters::close_timeout_ns,
                   "how long after its arrival a frame waits for its last events")),
      maxBufferedEventsKey(),
      timeKey(limits::kBackwardJump, kNanosecondsPerMillisecond,
              &DeblurParameters::max_backward_jump_ns,
              "an event older than the newest one by more than this is a clock jump, by less a "
              "late event"),
      timeKey(limits::kForwardJump, kNanosecondsPerMillisecond,
              &DeblurParameters::max_forward_jump_ns,
              "an event ahead of the newest one by more than this is a clock jump, once the next "
              "array confirms it"),
      live(latentImagesKey()),
      textKey({"response_file", "", "none",
               "camera response: file with 256 natural-log irradiances, one for each 8-bit DN"},
              [](const std::string& value, ParameterDraft& draft) { draft.response_file = value; }),
      numberKey(limits::kResponseOffset, "0", "offset d of the linear response: intensity = DN + d",
                [](double value, ParameterDraft& draft) { draft.response_offset_dn = value; }),
      textKey({"frame_id", "", "\"\"", "`frame_id` of the output if that of the input is empty"},
              [](const std::string& value, ParameterDraft& draft) {
                draft.loaded.ros.frame_id = value;
              }),
      live(boolKey(
          {"passthrough", "", boolText(DeblurParameters{}.passthrough),
           "publish every frame unchanged"},
          [](bool value, ParameterDraft& draft) { draft.loaded.deblur.passthrough = value; })),
      boolKey({"lazy", "", boolText(RosParameters{}.lazy),
               "subscribe to the inputs only while an output image has a subscriber"},
              [](bool value, ParameterDraft& draft) { draft.loaded.ros.lazy = value; }),
      textKey({"learned_file", "", "\"\"",
               "where the service `save_learned` writes; a relative path starts at `$ROS_HOME` or "
               "`~/.ros`, empty is a file with the node's name there"},
              [](const std::string& value, ParameterDraft& draft) {
                draft.loaded.ros.learned_file = value;
              }),
  };
  for (ConfigKey& key : filterKeys()) {
    keys.push_back(live(std::move(key)));
  }
  return keys;
}

std::vector<ParameterDescription> descriptionsOf(const std::vector<ConfigKey>& keys) {
  std::vector<ParameterDescription> descriptions;
  for (const ConfigKey& key : keys) {
    descriptions.push_back(key.description);
  }
  return descriptions;
}

}  // namespace

const std::vector<ConfigKey>& topLevelKeys() {
  static const std::vector<ConfigKey> keys = buildTopLevelKeys();
  return keys;
}

std::vector<ParameterDescription> parameterDescriptions() {
  return descriptionsOf(topLevelKeys());
}

std::vector<ParameterDescription> biasDescriptions() {
  return descriptionsOf(biasKeys());
}

std::string markdownTable(const std::vector<ParameterDescription>& descriptions) {
  const bool some_live = std::any_of(descriptions.begin(), descriptions.end(),
                                     [](const ParameterDescription& key) { return key.live; });
  std::string table = std::string("| name | type | values | unit | default |") +
                      (some_live ? " live |" : "") + " meaning |\n|---|---|---|---|---|" +
                      (some_live ? "---|" : "") + "---|\n";
  for (const ParameterDescription& key : descriptions) {
    table += "| `" + key.name + "` | " + key.type + " | " + key.range + " | " + key.unit + " | " +
             key.default_value + " | " + (some_live ? (key.live ? "yes | " : " | ") : "") +
             key.doc + " |\n";
  }
  return table;
}

}  // namespace fast_edi
