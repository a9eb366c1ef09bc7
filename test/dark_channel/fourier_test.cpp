#include "dark_channel/fourier.hpp"

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

cv::Mat1f noise(cv::Size size, std::uint64_t seed) {
  cv::Mat1f image(size);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0.0, 1.0);
  return image;
}

TEST(Fourier, InverseBringsTheImageBack) {
  for (const cv::Size size : {cv::Size(16, 12), cv::Size(15, 9)}) {
    const cv::Mat1f image = noise(size, 1);
    EXPECT_LT(cv::norm(inverseTransform(forwardTransform(image)), image, cv::NORM_INF), 1e-5);
  }
}

TEST(Fourier, TransferFunctionConvolvesPeriodically) {
  const cv::Mat1f image = noise({12, 10}, 2);
  const cv::Mat1f kernel = noise({5, 3}, 3);
  // conj(conj(F(k))) F(I) would correlate: the product without conjugation convolves.
  Spectrum product;
  cv::mulSpectrums(transferFunction(kernel, image.size()), forwardTransform(image), product, 0);
  const cv::Mat1f convolved = inverseTransform(product);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      float sum = 0.0F;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -2; u <= 2; ++u) {
          sum += kernel(v + 1, u + 2) * image((y - v + 10) % 10, (x - u + 12) % 12);
        }
      }
      EXPECT_NEAR(convolved(y, x), sum, 1e-4);
    }
  }
}

TEST(Fourier, ConjugateProductWithItselfIsThePower) {
  const Spectrum spectrum = forwardTransform(noise({8, 6}, 4));
  const Spectrum product = conjugateProduct(spectrum, spectrum);
  const cv::Mat1f power = powerOf(spectrum);
  for (int y = 0; y < power.rows; ++y) {
    for (int x = 0; x < power.cols; ++x) {
      EXPECT_NEAR(product(y, x)[0], power(y, x), 1e-3);
      EXPECT_NEAR(product(y, x)[1], 0.0, 1e-3);
    }
  }
}

TEST(Fourier, AdjointAndPowerBelongToTheGradient) {
  const cv::Size size(9, 7);
  const cv::Mat1f image = noise(size, 5);
  const Gradient any = {noise(size, 6), noise(size, 7)};
  const Gradient gradient = gradientOf(image);
  EXPECT_NEAR(gradient.x.dot(any.x) + gradient.y.dot(any.y), image.dot(adjointGradient(any)), 1e-4);
  // grad^T grad I in both domains.
  Spectrum spectrum = forwardTransform(image);
  const cv::Mat1f power = gradientPower(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      spectrum(y, x) *= power(y, x);
    }
  }
  EXPECT_LT(cv::norm(inverseTransform(spectrum), adjointGradient(gradient), cv::NORM_INF), 1e-4);
}

}  // namespace
}  // namespace fast_edi
