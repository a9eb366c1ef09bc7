#include "fast_edi/latent/camera_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fast_edi/base/number_text.hpp"

namespace fast_edi {
namespace {

constexpr std::size_t kTableSize = 256;
/// Far more than a response file needs; a device that never ends must not fill the memory.
constexpr std::size_t kMaxFileBytes = std::size_t{1} << 20;
constexpr double kMaxDn8 = 255.0;
constexpr double kMaxDn16 = 65535.0;

/// Truncation rounds to nearest after this is added to a number that is not negative.
constexpr float kHalf = 0.5F;

/// Limits to [0, max]; NaN becomes one of the two. \p max must be positive.
///
/// Floats order like their bits read as a signed integer, unless both are negative. Sign masks
/// instead of comparisons, because GCC does not vectorise loops with two floating-point comparisons
/// (each might trap) and turns chained integer ones into branches.
inline float clampLevel(float level, float max) {
  static_assert(std::numeric_limits<float>::is_iec559, "relies on the layout of IEEE 754");
  constexpr int kSignShift = 31;
  std::int32_t bits = 0;
  std::int32_t max_bits = 0;
  std::memcpy(&bits, &level, sizeof(bits));
  std::memcpy(&max_bits, &max, sizeof(max_bits));
  bits &= ~(bits >> kSignShift);
  const std::int32_t above_max = bits - max_bits;
  bits = max_bits + (above_max & (above_max >> kSignShift));
  std::memcpy(&level, &bits, sizeof(level));
  return level;
}

template <typename Level>
Level loadLevel(const std::uint8_t* bytes) {
  Level level = 0;
  std::memcpy(&level, bytes, sizeof(level));
  return level;
}

template <typename Level>
void storeLevel(Level level, std::uint8_t* bytes) {
  std::memcpy(bytes, &level, sizeof(level));
}

/// The linear response for consecutive samples: DN' = g (DN + d) - d.
template <typename Level>
void applyLinear(const std::uint8_t* in, const float* gain, std::size_t count, float offset,
                 std::uint8_t* out) {
  constexpr auto kMax = static_cast<float>(std::numeric_limits<Level>::max());
  for (std::size_t i = 0; i < count; ++i) {
    const float exposure = static_cast<float>(loadLevel<Level>(in + i * sizeof(Level))) + offset;
    const float level = clampLevel(gain[i] * exposure - offset, kMax);
    // Through int, since float to unsigned has no vector instruction before AVX-512.
    storeLevel(static_cast<Level>(static_cast<int>(level + kHalf)), out + i * sizeof(Level));
  }
}

/// Both ways through a tabulated response, for levels 0..N-1 of one pixel depth.
///
/// Forward is an array of exposures. Backward, rounding to the nearest level is counting the
/// `thresholds` (exposures of level + 1/2) that do not exceed x. The leading bits of a positive
/// float grow with it and divide each octave evenly, so they index `buckets`, which hold the count
/// at the bucket's lower end; what is left are the few thresholds inside the bucket.
class LevelTable {
 public:
  /// \param log_exposure natural-log exposure of a level in [0, levels - 1], increasing; at the
  ///        last level at most 0
  /// \param bucket_bits log2 of the buckets per octave
  template <typename LogExposure>
  LevelTable(std::size_t levels, int bucket_bits, const LogExposure& log_exposure)
      : shift_(kMantissaBits - bucket_bits) {
    exposures_.reserve(levels);
    thresholds_.reserve(levels);
    for (std::size_t level = 0; level < levels; ++level) {
      const auto number = static_cast<double>(level);
      exposures_.push_back(static_cast<float>(std::exp(log_exposure(number))));
      if (level + 1 < levels) {
        thresholds_.push_back(static_cast<float>(std::exp(log_exposure(number + kRounding))));
      }
    }
    // No exposure reaches this one, which ends every search within a bucket.
    thresholds_.push_back(std::numeric_limits<float>::infinity());
    first_bucket_ = bucket(thresholds_.front());
    const std::uint32_t last_bucket = bucket(thresholds_[levels - 2]);
    buckets_.reserve(last_bucket - first_bucket_ + 1);
    std::size_t level = 0;
    for (std::uint32_t index = first_bucket_; index <= last_bucket; ++index) {
      while (bucket(thresholds_[level]) < index) {
        ++level;
      }
      buckets_.push_back(static_cast<std::uint16_t>(level));
    }
    lowest_ = thresholds_.front();
    highest_ = thresholds_[levels - 2];
  }

  float exposure(std::size_t level) const { return exposures_[level]; }

  /// Nearest level of an exposure; NaN gives 0.
  std::size_t level(float exposure) const {
    if (!(exposure >= lowest_)) {
      return 0;
    }
    if (exposure >= highest_) {
      return exposures_.size() - 1;
    }
    std::size_t level = buckets_[bucket(exposure) - first_bucket_];
    while (exposure >= thresholds_[level]) {
      ++level;
    }
    return level;
  }

 private:
  static constexpr int kMantissaBits = 23;
  static constexpr double kRounding = 0.5;

  std::uint32_t bucket(float exposure) const {
    static_assert(std::numeric_limits<float>::is_iec559, "relies on the layout of IEEE 754");
    std::uint32_t bits = 0;
    std::memcpy(&bits, &exposure, sizeof(bits));
    return bits >> shift_;
  }

  int shift_;
  std::vector<float> exposures_;
  std::vector<float> thresholds_;  ///< [level]: from here on, the next level is nearer
  std::vector<std::uint16_t> buckets_;
  std::uint32_t first_bucket_ = 0;
  float lowest_ = 0.0F;   ///< below: level 0
  float highest_ = 0.0F;  ///< from here on: the last level
};

/// A tabulated response for consecutive samples.
template <typename Level>
void applyTable(const LevelTable& table, const std::uint8_t* in, const float* gain,
                std::size_t count, std::uint8_t* out) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto level = loadLevel<Level>(in + i * sizeof(Level));
    // A gain of 1 is exact even where a table rises by less than a float can tell.
    const auto result =
        gain[i] == 1.0F ? level : static_cast<Level>(table.level(gain[i] * table.exposure(level)));
    storeLevel(result, out + i * sizeof(Level));
  }
}

/// Buckets per octave, as a power of two: 8-bit levels of a linear response lie at least 1/255
/// apart, so that a bucket rarely holds more than one threshold; 16-bit ones at most eight.
constexpr int kBucketBits8 = 10;
constexpr int kBucketBits16 = 13;

double interpolate(const std::vector<double>& values, double position) {
  const auto below = std::min(static_cast<std::size_t>(position), values.size() - 2);
  const double fraction = position - static_cast<double>(below);
  return values[below] + fraction * (values[below + 1] - values[below]);
}

/// Index of the first value that is not finite or not above the one before it; kTableSize if none.
std::size_t firstFault(const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]) || (i > 0 && values[i] <= values[i - 1])) {
      return i;
    }
  }
  return values.size();
}

std::string describe(double value) {
  return roundedText(value, std::numeric_limits<double>::max_digits10);
}

std::string faultText(const std::vector<double>& values, std::size_t index) {
  std::string text = "value " + std::to_string(index) + " of the camera response is " +
                     describe(values[index]) + ", expected a finite number";
  if (index > 0) {
    text += " above the one before it (" + describe(values[index - 1]) + ")";
  }
  return text;
}

std::string spanText(double span) {
  return "the camera response spans " + describe(span) + " natural-log units, expected at most " +
         describe(CameraResponse::kMaxLogSpan);
}

}  // namespace

struct CameraResponse::Tables {
  explicit Tables(std::vector<double> log_exposure_values)
      : log_exposure(std::move(log_exposure_values)),
        levels8(kTableSize, kBucketBits8,
                [this](double level) { return interpolate(log_exposure, level); }),
        levels16(static_cast<std::size_t>(kMaxDn16) + 1, kBucketBits16,
                 [this](double level) { return interpolate(log_exposure, level / kDn16PerDn8); }) {}

  std::vector<double> log_exposure;  ///< [DN], 0 at DN 255
  LevelTable levels8;
  LevelTable levels16;
};

CameraResponse CameraResponse::linear(double offset_dn) {
  if (!(offset_dn >= 0.0 && offset_dn <= kMaxDn8)) {
    throw std::invalid_argument("the offset of the camera response is " + describe(offset_dn) +
                                " DN, expected 0..255");
  }
  CameraResponse response;
  response.offset_dn_ = offset_dn;
  return response;
}

CameraResponse CameraResponse::fromTable(const std::vector<double>& log_irradiance) {
  if (log_irradiance.size() != kTableSize) {
    throw std::invalid_argument("the camera response has " + std::to_string(log_irradiance.size()) +
                                " values, expected 256");
  }
  const std::size_t fault = firstFault(log_irradiance);
  if (fault < log_irradiance.size()) {
    throw std::invalid_argument(faultText(log_irradiance, fault));
  }
  const double top = log_irradiance.back();
  const double span = top - log_irradiance.front();
  if (!(span <= kMaxLogSpan)) {
    throw std::invalid_argument(spanText(span));
  }
  // Relative to the top, since floats then hold it whatever the unit of the table.
  std::vector<double> relative(log_irradiance);
  for (double& value : relative) {
    value -= top;
  }
  CameraResponse response;
  response.tables_ = std::make_shared<const Tables>(std::move(relative));
  return response;
}

CameraResponse CameraResponse::fromFile(const std::string& path) {
  std::ifstream stream(path);
  if (!stream) {
    throw std::runtime_error(path + ": cannot be read, expected a camera response file");
  }
  std::string text(kMaxFileBytes + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (text.size() > kMaxFileBytes) {
    throw std::runtime_error(path + ": larger than 1 MB, expected 256 numbers");
  }
  std::istringstream file(text);
  std::vector<double> values;
  std::string line;
  for (int line_number = 1; std::getline(file, line); ++line_number) {
    const std::string place = path + ":" + std::to_string(line_number) + ": ";
    std::istringstream words(line.substr(0, line.find('#')));
    std::string word;
    while (words >> word) {
      const std::optional<double> value = parseNumber(word);
      if (!value) {
        throw std::runtime_error(place + "'" + word + "' is not a number");
      }
      values.push_back(*value);
      if (values.size() > kTableSize) {
        throw std::runtime_error(place + "more than 256 values, expected one for each 8-bit DN");
      }
      if (firstFault(values) < values.size()) {
        throw std::runtime_error(place + faultText(values, values.size() - 1));
      }
    }
  }
  try {
    return fromTable(values);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(path + ": " + error.what());
  }
}

double CameraResponse::exposure(double dn) const {
  const double clamped = std::clamp(dn, 0.0, kMaxDn8);
  return isLinear() ? clamped + offset_dn_ : std::exp(interpolate(tables_->log_exposure, clamped));
}

double CameraResponse::digitalNumber(double exposure) const {
  if (isLinear()) {
    return std::clamp(exposure - offset_dn_, 0.0, kMaxDn8);
  }
  const std::vector<double>& values = tables_->log_exposure;
  const double log_exposure = std::log(exposure);
  if (!(log_exposure > values.front())) {
    return 0.0;
  }
  const auto above = std::upper_bound(values.begin(), values.end(), log_exposure);
  if (above == values.end()) {
    return kMaxDn8;
  }
  const auto below = above - 1;
  return static_cast<double>(below - values.begin()) + (log_exposure - *below) / (*above - *below);
}

void CameraResponse::applyGain(const ImageView& in, const float* gain,
                               const MutableImageView& out) const {
  const auto width = static_cast<std::size_t>(in.size.width);
  for (int y = 0; y < in.size.height; ++y) {
    const std::uint8_t* from = in.row(y);
    std::uint8_t* to = out.row(y);
    const float* row_gain = gain + static_cast<std::size_t>(y) * width;
    if (samplesPerPixel(in.format) == 1) {
      applySamples(in.format, from, row_gain, width, to);
    } else {
      applyColour(in.format, from, row_gain, width, to);
    }
  }
}

void CameraResponse::applySamples(PixelFormat format, const std::uint8_t* in, const float* gain,
                                  std::size_t count, std::uint8_t* out) const {
  if (bytesPerSample(format) == 2) {
    apply16(in, gain, count, out);
  } else {
    apply8(in, gain, count, out);
  }
}

void CameraResponse::apply8(const std::uint8_t* in, const float* gain, std::size_t count,
                            std::uint8_t* out) const {
  if (isLinear()) {
    applyLinear<std::uint8_t>(in, gain, count, static_cast<float>(offset_dn_), out);
  } else {
    applyTable<std::uint8_t>(tables_->levels8, in, gain, count, out);
  }
}

void CameraResponse::apply16(const std::uint8_t* in, const float* gain, std::size_t count,
                             std::uint8_t* out) const {
  if (isLinear()) {
    const auto offset = static_cast<float>(offset_dn_ * kDn16PerDn8);
    applyLinear<std::uint16_t>(in, gain, count, offset, out);
  } else {
    applyTable<std::uint16_t>(tables_->levels16, in, gain, count, out);
  }
}

void CameraResponse::applyColour(PixelFormat format, const std::uint8_t* in, const float* gain,
                                 std::size_t width, std::uint8_t* out) const {
  // Several samples per gain do not vectorise; one gain for each sample does. That of alpha is 1,
  // which leaves a level as it is.
  constexpr std::size_t kMostSamples = 4;
  constexpr std::size_t kBlockPixels = 128;
  const auto colours = static_cast<std::size_t>(channels(format));
  const auto samples = static_cast<std::size_t>(samplesPerPixel(format));
  const auto bytes = static_cast<std::size_t>(bytesPerPixel(format));
  std::array<float, kBlockPixels * kMostSamples> sample_gain{};
  sample_gain.fill(1.0F);
  for (std::size_t begin = 0; begin < width; begin += kBlockPixels) {
    const std::size_t count = std::min(kBlockPixels, width - begin);
    for (std::size_t i = 0; i < count; ++i) {
      std::fill_n(&sample_gain[i * samples], colours, gain[begin + i]);
    }
    applySamples(format, in + begin * bytes, sample_gain.data(), count * samples,
                 out + begin * bytes);
  }
}

}  // namespace fast_edi
