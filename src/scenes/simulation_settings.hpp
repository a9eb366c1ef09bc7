/// \file
/// Everything that can be set about a simulated DAVIS recording.
#pragma once

#include <cstdint>
#include <string>

#include "fast_edi/base/contrast_threshold.hpp"
#include "fast_edi/base/types.hpp"

namespace fast_edi {

constexpr SensorSize kDavis346Size{346, 260};
constexpr SensorSize kDavis240cSize{240, 180};

/// Procedural textures; a picture of the user's own replaces them.
enum class TextureKind {
  kPoster,   ///< a brick wall with stickers: stars, rings, letters, shaded balls; edges and calm
  kNatural,  ///< dead leaves: overlapping shapes of power-law size with 1/f shading; many events
  kFlat,     ///< almost nothing to see: slow shading of a few percent
  kMosaic,   ///< stones of random grey with thin dark joints: corners and fine lines everywhere
  kPage,     ///< a printed page: dark letters on bright paper, ruled boxes
  kClouds,   ///< 1/f noise: no edge, contrast at every scale
  kFacade,   ///< a house front: courses of stone, rows of windows with bars, reflections, shadows
  kWeave,    ///< coarse cloth: crossing threads with irregular shading, a few printed stripes
};

/// Camera motions over the plane, all smooth and bounded.
enum class MotionKind {
  kStill,
  kMild,   ///< about 100 px/s
  kPan,    ///< sideways sweeps of up to 500 px/s
  kSpin,   ///< rotation about the optical axis
  kShake,  ///< a shaken hand, about 900 px/s rms at the fastest corner: strong blur
};

/// What the camera looks at: a plane seen at one sensor pixel per plane pixel in the nominal pose.
struct SceneSettings {
  TextureKind texture = TextureKind::kPoster;
  std::string texture_file;   ///< a picture (any format OpenCV reads) instead of `texture`
  int tags = 0;               ///< AprilTags (36h11, ids 0, 1, ...) spread over the nominal view
  double tag_side_px = 32.0;  ///< side of a tag's black square in the nominal pose [px]
  double density = 0.6;       ///< kPoster: fraction of places that carry a sticker, 0..1
  /// Of the texture: log reflectance is scaled by this around that of mid grey, 0..2. 1 = as drawn.
  double contrast = 1.0;
  int lamps = 0;  ///< bright discs spread over the nominal view, 0..20; they follow the flicker
  double lamp_radiance = 4.0;    ///< of a lamp, 1 = a white surface at illumination 1: saturates
  double lamp_radius_px = 9.0;   ///< in the nominal pose [px]
  double optics_sigma_px = 0.6;  ///< blur of lens and photodiode area, Gaussian sigma [px]
  double illumination = 1.0;     ///< irradiance of a white surface, 1 = bright room
  double flicker_hz = 0.0;       ///< frequency of the light's modulation, 0 = none [Hz]
  double flicker_depth = 0.2;    ///< amplitude of the modulation, relative, 0..1
};

struct MotionSettings {
  MotionKind kind = MotionKind::kShake;
  double scale = 1.0;            ///< factor on all amplitudes, hence on all speeds
  double focal_length_px = 0.0;  ///< 0 = 0.95 (room: 0.7) x the sensor's width [px]
};

/// How colours reach the pixels.
enum class ColourFilter {
  kNone,       ///< monochrome sensor
  kBayerRggb,  ///< each photosite sees one colour, in its frame and in its events alike
};

/// How hot pixels lie together.
enum class HotPixelShape {
  kSingle,
  kPair,    ///< two beside each other
  kBlock,   ///< 2x2
  kRow,     ///< 1x4
  kColumn,  ///< whole columns
};

/// The pixel array. Defaults are those of a DAVIS346 with the biases libcaer sets at start-up, with
/// non-idealities of usual size; ideal() switches all of them off.
///
/// Model of the event part. A pixel compares its log irradiance with the level memorised at its
/// last event; when the difference reaches a threshold it fires, and for `refractory_ns` memorises
/// the present level, so that changes in that time are lost. The memorised level leaks downwards
/// (ON events), noise makes it fire without cause and forget what it had counted until then.
struct SensorSettings {
  SensorSize size = kDavis346Size;
  ColourFilter colour_filter = ColourFilter::kNone;

  ContrastThresholds thresholds{0.2609, 0.2415};  ///< means over the array [natural log]
  double threshold_mismatch = 0.08;   ///< standard deviation over the pixels, relative to the mean
  std::int64_t refractory_ns = 3400;  ///< RefrBp (4, 25)
  double leak_rate_hz = 0.1;          ///< ON events of a still scene [1/s per pixel]
  double shot_noise_bright_hz = 0.5;  ///< noise events where irradiance is 1 [1/s per pixel]
  double shot_noise_dark_hz = 5.0;    ///< ... and where it is 0; linear in between
  double photoreceptor_bright_hz = 0.0;  ///< cut-off of a first-order low-pass at irradiance 1 [Hz]
  double photoreceptor_dark_hz = 0.0;    ///< ... at irradiance 0; both 0 = unlimited bandwidth
  /// Below this many DN (of white_dn at irradiance 1) the pixel's log becomes linear, as in v2e
  /// (Hu et al., CVPR Workshops 2021; 20 DN there): f(I) = I ln(D) / D for I < D, else ln(I).
  /// 0 = a log everywhere [DN]
  double linear_below_dn = 0.0;
  std::int64_t delay_us = 0;        ///< event times are late by this, the frames' are not
  double hot_pixel_fraction = 0.0;  ///< pixels that fire ON all the time, 0..1
  HotPixelShape hot_pixel_shape = HotPixelShape::kSingle;
  double hot_pixel_rate_hz = 1000.0;  ///< ... at this rate [1/s]
  std::int64_t clock_us = 1;          ///< event times are rounded down to multiples of this
  bool random_initial_level = true;   ///< levels at the start anywhere between the two thresholds

  double white_dn = 215.0;         ///< DN of a white surface at illumination 1
  double read_noise_dn = 1.5;      ///< standard deviation [DN]
  double electrons_per_dn = 90.0;  ///< sets the frame's shot noise; 0 = none
  int frame_bits = 8;              ///< 8 or 16 (the same range: DN16 = 257 x DN)

  /// No noise, no mismatch, no refractory period: frames are exact up to rounding, events exact.
  static SensorSettings ideal();
};

/// When frames are taken. Frame i is exposed over [start + lead + i period, ... + exposure).
struct TimingSettings {
  std::int64_t start_ns = 1'700'000'000 * kNanosecondsPerSecond;  ///< multiple of 1 us
  int frames = 30;
  std::int64_t period_us = 40'000;
  std::int64_t exposure_us = 20'000;  ///< at most the period
  double exposure_swing = 0.0;    ///< up and down by this part, as automatic exposure does, 0..1
  std::int64_t lead_us = 20'000;  ///< events before the first exposure and after the last period

  /// Exposure time of frame \p i.
  std::int64_t exposureUs(int i) const;
};

/// What the camera moves in.
enum class SceneKind {
  kPlane,  ///< before one textured plane, by MotionSettings
  kRoom,   ///< through a furnished room, by RoomSettings; with poses and an inertial sensor
};

/// A box-shaped room with posters on all sides, in which pillars and low boxes stand, and a
/// hand-held camera's way through it. SceneSettings give its textures (one poster for each face),
/// lens and light; its walls are grey: tags, flicker and colour filters belong to the plane.
///
/// World frame: right-handed, z up, the origin in the middle of the floor.
struct RoomSettings {
  double length_m = 7.0;       ///< along x
  double width_m = 6.0;        ///< along y
  double height_m = 3.0;       ///< along z
  double texel_m = 0.003;      ///< finest structure of the textures
  double poster_px_m = 0.010;  ///< size of what is one pixel to a texture of the plane
  double lap_s = 25.0;         ///< about the time of one lap; the recording holds whole laps
  double gentle_s = 3.0;       ///< at the start and the end: walking without shaking
  double shake_rms_deg = 2.2;  ///< of the rotation about the image's x and y axes, each
  double shake_hz = 4.5;       ///< mean frequency of the shaking
  double wander = 1.0;         ///< factor on walking's own movements, translation and rotation
};

/// An inertial sensor in the camera's optical frame (x right, y down, z forward), its origin in the
/// camera's optical centre. Its noise is white, its biases are random walks from a drawn start.
struct ImuSettings {
  double rate_hz = 400.0;
  double accelerometer_noise = 4e-3;  ///< density [m/s^2/sqrt(Hz)]
  double gyroscope_noise = 2e-4;      ///< density [rad/s/sqrt(Hz)]
  double accelerometer_walk = 2e-4;   ///< of the bias [m/s^3/sqrt(Hz)]
  double gyroscope_walk = 1e-5;       ///< of the bias [rad/s^2/sqrt(Hz)]
  double accelerometer_bias = 0.05;   ///< at the start, standard deviation by axis [m/s^2]
  double gyroscope_bias = 5e-3;       ///< at the start, standard deviation by axis [rad/s]
};

struct SimulationSettings {
  SceneKind kind = SceneKind::kPlane;
  RoomSettings room;  ///< with kRoom
  ImuSettings imu;    ///< with kRoom
  SceneSettings scene;
  MotionSettings motion;
  SensorSettings sensor;
  TimingSettings timing;
  std::uint64_t seed = 1;
  double max_step_px = 0.25;  ///< motion between two renderings is kept below this [px]
  /// Longest time between two renderings, so that leak and noise keep their order in a still scene.
  std::int64_t max_step_us = 1000;

  double focalLengthPx() const;
  /// From the first to the last instant simulated.
  std::int64_t lengthNs() const;
  /// \throws std::invalid_argument naming the first value out of range and what is allowed
  void validate() const;
};

/// \throws std::invalid_argument listing the names that are known
SceneKind sceneKindFromName(const std::string& name);
/// \throws std::invalid_argument listing the names that are known
TextureKind textureKindFromName(const std::string& name);
/// \throws std::invalid_argument listing the names that are known
HotPixelShape hotPixelShapeFromName(const std::string& name);
/// \throws std::invalid_argument listing the names that are known
MotionKind motionKindFromName(const std::string& name);

}  // namespace fast_edi
