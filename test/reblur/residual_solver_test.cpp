#include "reblur/residual_solver.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace fast_edi {
namespace {

constexpr SensorSize kSize{37, 32};
constexpr std::size_t kWidth = kSize.width;
constexpr float kNoise_dn = 1.5F;
constexpr float kOffset_dn = 4.0F;

/// The same in double precision: the operator as a matrix, sums as they are written in the header.
class Reference {
 public:
  Reference(const ResidualSolver::Input& input, MovingBlur& blur) : layout_(blur.layout()) {
    const std::size_t count = layout_.sceneFloats();
    std::vector<float> unit(count, 0.0F);
    std::vector<float> image(layout_.imageFloats());
    matrix_.resize(kSize.pixelCount());
    for (std::size_t i = 0; i < count; ++i) {
      unit[i] = 1.0F;
      blur.apply(unit.data(), image.data());
      unit[i] = 0.0F;
      for (std::size_t pixel = 0; pixel < matrix_.size(); ++pixel) {
        const float value = image[pixel / kWidth * layout_.stride() + pixel % kWidth];
        if (value != 0.0F) matrix_[pixel].push_back({i, static_cast<double>(value)});
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = nearestPixel(i);
      given.push_back(static_cast<double>(input.latent_dn[at]));
      const double events = std::min(1.0, static_cast<double>(input.mean_counts[at]));
      const double free = 2.0 + 0.1 * events * (given.back() + kOffset_dn);
      anchor_.push_back(1.0 / (free * free));
    }
    const std::vector<double> seen = times(given);
    for (std::size_t pixel = 0; pixel < matrix_.size(); ++pixel) {
      const auto blurry = static_cast<double>(input.blurry_dn[pixel]);
      const bool saturated = blurry >= 254.0;
      before.push_back(saturated ? 0.0 : blurry - seen[pixel]);
      const double noise = kNoise_dn;
      const double share = before.back() / (6.0 * noise);
      precision_.push_back(saturated ? 0.0 : 1.0 / (noise * noise * (1.0 + share * share)));
    }
  }

  /// Conjugate gradients.
  std::vector<double> solve(int steps) const {
    std::vector<double> correction(given.size());
    std::vector<double> weighted = before;
    for (std::size_t i = 0; i < weighted.size(); ++i) weighted[i] *= precision_[i];
    std::vector<double> gradient = transposedTimes(weighted);
    std::vector<double> direction = gradient;
    for (int step = 0; step < steps; ++step) {
      const std::vector<double> product = normal(direction);
      const double squares = dot(gradient, gradient);
      const double length = squares / dot(direction, product);
      for (std::size_t i = 0; i < correction.size(); ++i) {
        correction[i] += length * direction[i];
        gradient[i] -= length * product[i];
      }
      const double factor = dot(gradient, gradient) / squares;
      for (std::size_t i = 0; i < correction.size(); ++i) {
        direction[i] = gradient[i] + factor * direction[i];
      }
    }
    return correction;
  }

  /// B - A (L0 + d).
  std::vector<double> residual(const std::vector<double>& correction) const {
    std::vector<double> left = before;
    const std::vector<double> seen = times(correction);
    for (std::size_t i = 0; i < left.size(); ++i) left[i] -= precision_[i] > 0.0 ? seen[i] : 0.0;
    return left;
  }

  /// What the solution minimises.
  double objective(const std::vector<double>& correction) const {
    const std::vector<double> left = residual(correction);
    double sum = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) sum += precision_[i] * left[i] * left[i];
    for (std::size_t i = 0; i < correction.size(); ++i) {
      sum += anchor_[i] * correction[i] * correction[i];
    }
    forNeighbours([&](std::size_t p, std::size_t q, double weight) {
      sum += weight * std::pow(correction[p] - correction[q], 2);
    });
    return sum;
  }

  std::vector<double> given;
  std::vector<double> before;

 private:
  struct Entry {
    std::size_t at;
    double value;
  };

  static double dot(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

  std::size_t nearestPixel(std::size_t i) const {
    const auto inside = [&](std::size_t at, std::size_t length) {
      return std::clamp(at, layout_.margin(), layout_.margin() + length - 1) - layout_.margin();
    };
    const std::size_t x = inside(i % layout_.sceneStride(), kWidth);
    const std::size_t y = inside(i / layout_.sceneStride(), kSize.height);
    return y * kWidth + x;
  }

  /// Corrections of the first and last row are 0.
  bool isFixed(std::size_t i) const {
    const std::size_t row = i / layout_.sceneStride();
    return row == 0 || row + 1 == layout_.sceneRows();
  }

  template <typename Visit>
  void forNeighbours(Visit visit) const {
    const std::size_t stride = layout_.sceneStride();
    const auto weight = [&](std::size_t p, std::size_t q) {
      return 0.2 / (1.0 + std::pow((given[p] - given[q]) / 3.0, 2));
    };
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (i % stride + 1 < stride) visit(i, i + 1, weight(i, i + 1));
      if (i + stride < given.size()) visit(i, i + stride, weight(i, i + stride));
    }
  }

  std::vector<double> times(const std::vector<double>& scene) const {
    std::vector<double> image(matrix_.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
      for (const Entry& entry : matrix_[i]) image[i] += entry.value * scene[entry.at];
    }
    return image;
  }
  std::vector<double> transposedTimes(const std::vector<double>& image) const {
    std::vector<double> scene(given.size());
    for (std::size_t i = 0; i < image.size(); ++i) {
      for (const Entry& entry : matrix_[i]) scene[entry.at] += entry.value * image[i];
    }
    for (std::size_t i = 0; i < scene.size(); ++i) {
      if (isFixed(i)) scene[i] = 0.0;
    }
    return scene;
  }
  std::vector<double> normal(const std::vector<double>& scene) const {
    std::vector<double> image = times(scene);
    for (std::size_t i = 0; i < image.size(); ++i) image[i] *= precision_[i];
    std::vector<double> product = transposedTimes(image);
    for (std::size_t i = 0; i < scene.size(); ++i) product[i] += anchor_[i] * scene[i];
    forNeighbours([&](std::size_t p, std::size_t q, double weight) {
      product[p] += weight * (scene[p] - scene[q]);
      product[q] += weight * (scene[q] - scene[p]);
    });
    for (std::size_t i = 0; i < product.size(); ++i) {
      if (isFixed(i)) product[i] = 0.0;
    }
    return product;
  }

  SceneLayout layout_;
  std::vector<std::vector<Entry>> matrix_;  ///< of A, by pixels of the image
  std::vector<double> anchor_;
  std::vector<double> precision_;
};

/// A frame with texture that the given latent image lacks.
class ResidualSolverTest : public ::testing::Test {
 protected:
  ResidualSolverTest() {
    setMotion({2.6F, -1.3F, 0.2F, 0.4F, 0.1F, -0.1F});
    std::mt19937 random(8);
    std::normal_distribution<float> noise(0.0F, kNoise_dn);
    for (std::size_t i = 0; i < kSize.pixelCount(); ++i) {
      const auto x = static_cast<float>(i % kWidth);
      const std::size_t row = i / kWidth;
      const auto y = static_cast<float>(row);
      const float edge = x > 18.0F ? 60.0F : 0.0F;
      const float slope = 0.4F * y;  // no row is the one above
      latent_.push_back(90.0F + edge + slope);
      blurry_.push_back(90.0F + edge + slope + 9.0F * std::sin(0.6F * x + 0.3F * y) +
                        noise(random));
      counts_.push_back(std::abs(x - 18.0F) < 4.0F ? 3.0F : 0.0F);
    }
    blurry_[5 * kWidth + 30] = 255.0F;
  }

  void setMotion(const ImageMotion::Parts& velocity) {
    ImageMotion motion(kSize);
    motion.velocity = velocity;
    motion.curvature = {0.5F, 0.3F, 0.0F, 0.1F, 0.0F, 0.0F};
    blur_.set(motion, SceneLayout(kSize, 5.0F), 4);
  }
  ResidualSolver::Input input() const {
    return {blurry_.data(), latent_.data(), counts_.data(), kNoise_dn, kOffset_dn};
  }
  std::vector<double> correction() const {
    std::vector<double> difference;
    for (std::size_t i = 0; i < solver_.given().size(); ++i) {
      difference.push_back(static_cast<double>(solver_.solution()[i] - solver_.given()[i]));
    }
    return difference;
  }
  float ofImage(const std::vector<float>& plane, std::size_t pixel) const {
    return plane[pixel / kWidth * blur_.layout().stride() + pixel % kWidth];
  }

  std::vector<float> latent_;
  std::vector<float> blurry_;
  std::vector<float> counts_;
  MovingBlur blur_;
  ResidualSolver solver_;
};

TEST_F(ResidualSolverTest, TakesFourStepsOfConjugateGradients) {
  solver_.solve(input(), blur_);
  const Reference reference(input(), blur_);
  const std::vector<double> expected = reference.solve(4);
  const std::vector<double> found = correction();
  double largest = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(found[i], expected[i], 1e-4) << i;
    largest = std::max(largest, std::abs(expected[i]));
  }
  EXPECT_GT(largest, 3.0);
  const std::vector<double> none(found.size());
  EXPECT_LT(reference.objective(found), 0.8 * reference.objective(none));
  EXPECT_GT(reference.objective(found), reference.objective(reference.solve(60)));
}

/// Up to the border of the margin, beyond which displacements are cut off.
TEST_F(ResidualSolverTest, TakesTheSameStepsWhereTheImageMovesAsFarAsTheMargin) {
  setMotion({7.0F, -8.0F, 0.5F, 0.0F, 0.0F, 0.0F});
  solver_.solve(input(), blur_);
  const std::vector<double> expected = Reference(input(), blur_).solve(4);
  const std::vector<double> found = correction();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(found[i], expected[i], 1e-4) << i;
  }
}

TEST_F(ResidualSolverTest, MeasuresTheResidualsBeforeAndAfter) {
  solver_.solve(input(), blur_);
  const Reference reference(input(), blur_);
  const std::vector<double> after = reference.residual(correction());
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_NEAR(static_cast<double>(ofImage(solver_.residualBefore(), i)), reference.before[i],
                1e-3);
    ASSERT_NEAR(static_cast<double>(ofImage(solver_.residualAfter(), i)), after[i], 1e-3);
  }
  EXPECT_EQ(ofImage(solver_.residualAfter(), 5 * kWidth + 30), 0.0F) << "saturated";
}

TEST_F(ResidualSolverTest, ChangesNothingWhereNothingIsLeftToExplain) {
  solver_.solve(input(), blur_);
  std::vector<float> reblurred(blur_.layout().imageFloats());
  blur_.apply(solver_.given().data(), reblurred.data());
  for (std::size_t i = 0; i < blurry_.size(); ++i) blurry_[i] = ofImage(reblurred, i);
  solver_.solve(input(), blur_);
  EXPECT_EQ(solver_.solution(), solver_.given());
}

}  // namespace
}  // namespace fast_edi
