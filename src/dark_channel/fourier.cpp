#include "dark_channel/fourier.hpp"

#include <cmath>

namespace fast_edi {

Spectrum forwardTransform(const cv::Mat1f& image) {
  Spectrum spectrum;
  cv::dft(image, spectrum, cv::DFT_COMPLEX_OUTPUT);
  return spectrum;
}

cv::Mat1f inverseTransform(const Spectrum& spectrum) {
  cv::Mat1f image;
  cv::dft(spectrum, image, cv::DFT_INVERSE | cv::DFT_SCALE | cv::DFT_REAL_OUTPUT);
  return image;
}

Spectrum transferFunction(const cv::Mat1f& kernel, cv::Size size) {
  cv::Mat1f image(size, 0.0F);
  for (int y = 0; y < kernel.rows; ++y) {
    for (int x = 0; x < kernel.cols; ++x) {
      image((y - kernel.rows / 2 + size.height) % size.height,
            (x - kernel.cols / 2 + size.width) % size.width) = kernel(y, x);
    }
  }
  return forwardTransform(image);
}

Spectrum conjugateProduct(const Spectrum& a, const Spectrum& b) {
  Spectrum product;
  cv::mulSpectrums(b, a, product, 0, true);
  return product;
}

cv::Mat1f powerOf(const Spectrum& a) {
  cv::Mat1f power(a.size());
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      power(y, x) = a(y, x).dot(a(y, x));
    }
  }
  return power;
}

Gradient gradientOf(const cv::Mat1f& image) {
  Gradient gradient = {cv::Mat1f(image.size()), cv::Mat1f(image.size())};
  for (int y = 0; y < image.rows; ++y) {
    const float* row = image[y];
    const float* below = image[(y + 1) % image.rows];
    float* dx = gradient.x[y];
    float* dy = gradient.y[y];
    for (int x = 0; x + 1 < image.cols; ++x) {
      dx[x] = row[x + 1] - row[x];
    }
    dx[image.cols - 1] = row[0] - row[image.cols - 1];
    for (int x = 0; x < image.cols; ++x) {
      dy[x] = below[x] - row[x];
    }
  }
  return gradient;
}

cv::Mat1f adjointGradient(const Gradient& gradient) {
  const int rows = gradient.x.rows;
  const int columns = gradient.x.cols;
  cv::Mat1f image(rows, columns);
  for (int y = 0; y < rows; ++y) {
    const float* dx = gradient.x[y];
    const float* dy = gradient.y[y];
    const float* above = gradient.y[(y + rows - 1) % rows];
    float* row = image[y];
    row[0] = dx[columns - 1] - dx[0] + above[0] - dy[0];
    for (int x = 1; x < columns; ++x) {
      row[x] = dx[x - 1] - dx[x] + above[x] - dy[x];
    }
  }
  return image;
}

cv::Mat1f gradientPower(cv::Size size) {
  // |exp(2 pi i u / n) - 1|^2
  const auto power = [](int u, int n) { return 2.0 - 2.0 * std::cos(2.0 * CV_PI * u / n); };
  cv::Mat1f sum(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      sum(y, x) = static_cast<float>(power(x, size.width) + power(y, size.height));
    }
  }
  return sum;
}

}  // namespace fast_edi
