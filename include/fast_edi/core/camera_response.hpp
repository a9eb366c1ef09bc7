/// \file
/// Camera response function (CRF): digital number (DN) <-> exposure, both ways by table or formula,
/// never by a search per pixel.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "fast_edi/core/image.hpp"

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
class CameraResponse {
 public:
  /// Linear response. \throws std::invalid_argument unless 0 <= offset_dn <= 255
  static CameraResponse linear(double offset_dn = 0.0);

  /// \param log_irradiance 256 finite, strictly increasing values [natural log].
  /// \throws std::invalid_argument naming the first value that breaks the rule
  static CameraResponse fromTable(const std::vector<double>& log_irradiance);

  /// Reads a text file of 256 numbers, white space or newline separated, '#' comments.
  /// \throws std::runtime_error naming file, line and rule
  static CameraResponse fromFile(const std::string& path);

  bool isLinear() const { return linear_; }
  double offsetDn() const { return offset_dn_; }

  /// Exposure for a (possibly fractional) 8-bit DN in [0, 255].
  double exposure(double dn) const;
  /// Fractional 8-bit DN for an exposure, clamped to [0, 255]: the inverse of exposure().
  double digitalNumber(double exposure) const;

  /// Writes crf(gain * crf^-1(in)) for every pixel and channel.
  /// \param gain width x height factors, row-major, each finite and > 0
  /// \pre in and out have the same size and format
  void applyGain(const ImageView& in, const float* gain, const MutableImageView& out) const;

 private:
  CameraResponse() = default;

  bool linear_ = true;
  double offset_dn_ = 0.0;
  std::array<double, 256> log_exposure_{};
  std::vector<float> inverse_;  ///< see camera_response.cpp: DN over quantised log exposure
};

}  // namespace fast_edi
