/// \file
/// Spectra of periodic images, and differences that are periodic as they are.
///
/// Images and spectra have the same size; forward() has no factor, inverse() divides by the number
/// of pixels.
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

using Spectrum = cv::Mat2f;  ///< real and imaginary part

Spectrum forwardTransform(const cv::Mat1f& image);
cv::Mat1f inverseTransform(const Spectrum& spectrum);

/// Spectrum of the convolution with \p kernel, whose centre is the origin.
/// \pre odd sides, not larger than \p size
Spectrum transferFunction(const cv::Mat1f& kernel, cv::Size size);

/// conj(a) b
Spectrum conjugateProduct(const Spectrum& a, const Spectrum& b);
/// |a|^2
cv::Mat1f powerOf(const Spectrum& a);

/// Differences to the right and the lower neighbour; the last ones are those to the first.
struct Gradient {
  cv::Mat1f x;
  cv::Mat1f y;
};
Gradient gradientOf(const cv::Mat1f& image);
/// The adjoint of gradientOf(): <gradientOf(image), gradient> = <image, adjointGradient(gradient)>.
cv::Mat1f adjointGradient(const Gradient& gradient);
/// |F(d/dx)|^2 + |F(d/dy)|^2 of gradientOf().
cv::Mat1f gradientPower(cv::Size size);

}  // namespace fast_edi
