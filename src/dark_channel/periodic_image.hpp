/// \file
/// An image continued beyond its edges so that its period has no seam: otherwise deconvolution by
/// Fourier transforms rings from the edges.
#pragma once

#include <opencv2/core.hpp>

namespace fast_edi {

/// \param margin smallest number of pixels between the image and its next period [px]
/// \return \p image in the upper left corner; what lies beyond runs smoothly from its last rows and
///         columns to the first ones. The sides are those for which a Fourier transform is fast.
cv::Mat1f periodicImage(const cv::Mat1f& image, int margin);

}  // namespace fast_edi
