/// \file
/// Camera response function (CRF): digital number (DN) <-> exposure, both ways by table or formula,
/// never by a search per pixel.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/base/image.hpp"

namespace fast_edi {

/// Maps the digital numbers of a frame to exposure (linear in irradiance x time, arbitrary scale)
/// and back.
///
/// - linear (default): exposure = DN + offset; the DAVIS APS is linear within 0.05 log units for
///   DN 43..239 and behaves like ln(DN + d), d about 4..6, below.
/// - table: 256 monotonically increasing natural-log irradiances, one for each 8-bit DN; 16-bit
///   frames interpolate between them (DN16 / 257).
///
/// Applying a gain g (= 1 / E, see DoubleIntegral): DN' = crf(g * crf^-1(DN)), rounded to nearest
/// and clamped to the format's range. A gain of exactly 1 returns DN itself.
///
/// Saturation. A saturated DN says only that the exposure was at least crf^-1(DN). It is taken at
/// that value, so the result is a lower bound as well: a gain above 1 leaves it saturated, a gain
/// below 1 darkens it like its neighbours that just do not saturate. (Leaving saturated pixels
/// alone would keep the trails of moving lights and draw an edge where DN reaches the maximum.)
class CameraResponse {
 public:
  /// Largest ln(exposure(255) / exposure(0)) of a table: 26 decades, ten times any sensor's range.
  static constexpr double kMaxLogSpan = 60.0;

  /// Linear response. \throws std::invalid_argument unless 0 <= offset_dn <= 255
  static CameraResponse linear(double offset_dn = 0.0);

  /// \param log_irradiance 256 finite, strictly increasing values [natural log] that span at most
  ///        kMaxLogSpan.
  /// \throws std::invalid_argument naming the first value that breaks the rule
  static CameraResponse fromTable(const std::vector<double>& log_irradiance);

  /// Reads a text file of 256 numbers, white space or newline separated, '#' comments.
  /// \throws std::runtime_error naming file, line and rule
  static CameraResponse fromFile(const std::string& path);

  /// Tables are the same when one is a copy of the other.
  friend bool operator==(const CameraResponse& a, const CameraResponse& b) {
    return a.offset_dn_ == b.offset_dn_ && a.tables_ == b.tables_;
  }

  bool isLinear() const { return tables_ == nullptr; }
  double offsetDn() const { return offset_dn_; }

  /// Exposure for a (possibly fractional) 8-bit DN, clamped to [0, 255]. A table gives it relative
  /// to its largest value.
  double exposure(double dn) const;
  /// Fractional 8-bit DN for an exposure, clamped to [0, 255]: the inverse of exposure().
  double digitalNumber(double exposure) const;

  /// Writes crf(gain * crf^-1(in)) for every pixel and channel; copies alpha. Memory padding behind
  /// the rows of \p out is left alone; \p out may be \p in. \param gain width x height factors,
  /// row-major, each finite and > 0 (a value that is not gives
  ///        some DN, never undefined behaviour)
  /// \pre in and out have the same size and format
  void applyGain(const ImageView& in, const float* gain, const MutableImageView& out) const;

 private:
  struct Tables;

  CameraResponse() = default;

  void apply8(const std::uint8_t* in, const float* gain, std::size_t count,
              std::uint8_t* out) const;
  void apply16(const std::uint8_t* in, const float* gain, std::size_t count,
               std::uint8_t* out) const;
  void applySamples(PixelFormat format, const std::uint8_t* in, const float* gain,
                    std::size_t count, std::uint8_t* out) const;
  void applyColour(PixelFormat format, const std::uint8_t* in, const float* gain, std::size_t width,
                   std::uint8_t* out) const;

  double offset_dn_ = 0.0;
  std::shared_ptr<const Tables> tables_;  ///< null when linear; never changes, hence shared
};

}  // namespace fast_edi
