/// \file
/// What textures are drawn with, and the textures that have files of their own.
#pragma once

#include <opencv2/core.hpp>

#include "scenes/random.hpp"

namespace fast_edi {

using Colour = cv::Scalar;

double uniform(RandomEngine& random, double low, double high);
int uniformInt(RandomEngine& random, int low, int high);  ///< both bounds included

/// A colour of given luminance and random, soft hue.
Colour tinted(RandomEngine& random, double luminance, double saturation);

/// 1/f noise: octaves of interpolated random numbers, each half as strong as the next coarser one.
/// \param coarsest size of the coarsest structure [canvas elements]
cv::Mat1f fractalNoise(cv::Size size, double coarsest, double finest, RandomEngine& random);

/// Multiplies all channels by exp(strength * noise).
void shade(const cv::Mat1f& noise, double strength, cv::Mat3f& canvas);

/// Stones of random grey with thin dark joints. \param scale canvas elements per px
void drawMosaic(cv::Mat3f& canvas, double scale, RandomEngine& random);

/// A printed page: lines of letters, headings, ruled boxes. \param scale canvas elements per px
void drawPage(cv::Mat3f& canvas, double scale, RandomEngine& random);

/// 1/f noise of grey. \param scale canvas elements per px
void drawClouds(cv::Mat3f& canvas, double scale, RandomEngine& random);

/// A house front: stone courses, windows in rows. \param scale canvas elements per px
void drawFacade(cv::Mat3f& canvas, double scale, RandomEngine& random);

/// Coarse cloth of crossing threads. \param scale canvas elements per px
void drawWeave(cv::Mat3f& canvas, double scale, RandomEngine& random);

}  // namespace fast_edi
