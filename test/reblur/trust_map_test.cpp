#include "reblur/trust_map.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fast_edi/events/event_counts.hpp"
#include "support/event_generators.hpp"
#include "support/field.hpp"

namespace fast_edi {
namespace {

constexpr SensorSize kSize{99, 83};  // odd; and cells of 4 x 4 half pixels do not divide it
constexpr SensorSize kHalf{49, 41};
constexpr float kNoise_dn = 1.5F;
constexpr float kOffset_dn = 4.0F;
constexpr float kContrast = 0.25F;
constexpr std::int64_t kMs = kNanosecondsPerMillisecond;
constexpr ExposureInterval kWindow{10 * kMs, 30 * kMs};

std::size_t indexOf(int x, int y, int width) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
         static_cast<std::size_t>(x);
}

/// Of half the resolution.
using Plane = testing::DoubleImage;

template <typename Value>
Plane planeOf(Value value) {
  return testing::fieldOf<double>(kHalf, value);
}

Plane boxMeans(const Plane& plane, int radius) {
  return planeOf([&](int x, int y) {
    double sum = 0.0;
    int count = 0;
    for (int v = std::max(0, y - radius); v <= std::min(kHalf.height - 1, y + radius); ++v) {
      for (int u = std::max(0, x - radius); u <= std::min(kHalf.width - 1, x + radius); ++u) {
        sum += plane.at(u, v);
        ++count;
      }
    }
    return sum / count;
  });
}

double rise(double value, double from, double to) {
  return std::clamp((value - from) / (to - from), 0.0, 1.0);
}

/// A scene that moves, its events, and a correction of it.
class TrustMapTest : public ::testing::Test {
 protected:
  static constexpr double kVelocity_px = 4.4;

  TrustMapTest() : motion_(kSize) { setMotion(0.0F); }

  /// \param turn by so much, and zoomed
  void setMotion(float turn) {
    motion_.velocity = {static_cast<float>(kVelocity_px), 0.0F, turn, turn, 0.0F, 0.0F};
    motion_.curvature = {0.0F, 0.0F, turn, 0.0F, 0.0F, 0.0F};
    blur_.set(motion_, SceneLayout(kSize, 5.0F + 2.0F * turn), 5);
  }

  static double level(double x, double y) {
    return 100.0 + 65.0 * std::sin(0.35 * x) + 20.0 * std::cos(0.4 * y + 0.1 * x) +
           4.0 * std::sin(0.9 * x + 0.5 * y);
  }

  /// \param still a square without events, though the motion says that there must be some
  void measure(bool still) {
    std::vector<Event> events;
    std::vector<double> reference(kSize.pixelCount());
    constexpr int kSteps = 60;
    for (int step = 0; step <= kSteps; ++step) {
      const double tau = 2.0 * step / kSteps - 1.0;
      std::size_t i = 0;
      for (int y = 0; y < kSize.height; ++y) {
        for (int x = 0; x < kSize.width; ++x, ++i) {
          if (still && isInSquare(x, y)) continue;
          const double log = std::log(level(x + kVelocity_px * tau, y) + kOffset_dn + 3.0);
          if (step == 0) reference[i] = log;
          while (std::abs(log - reference[i]) >= kContrast) {
            Event event;
            event.x = static_cast<std::uint16_t>(x);
            event.y = static_cast<std::uint16_t>(y);
            event.on = log > reference[i];
            event.t_ns = kWindow.start_ns + step * (kWindow.length() - 1) / kSteps;
            reference[i] += event.on ? kContrast : -kContrast;
            events.push_back(event);
          }
        }
      }
    }
    PixelEventLists lists(kSize, {});
    lists.append(testing::wireView(testing::toWire(events)));
    EventCounts counts(kSize);
    counts.count(lists, kWindow);
    LaterQuarters quarters(kSize);
    quarters.count(lists, kWindow);
    changes_.measure(lists, kWindow, counts.data(), quarters, {{kContrast, kContrast}, {0, 0.0}});

    std::mt19937 random(4);
    std::normal_distribution<double> noise(0.0, static_cast<double>(kNoise_dn));
    std::vector<float> latent;
    std::vector<float> blurry;
    std::vector<float> mean_counts;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        double light = 0.0;
        for (int step = 0; step < kSteps; ++step) {
          light += level(x + kVelocity_px * ((2.0 * step + 1.0) / kSteps - 1.0), y) / kSteps;
        }
        const bool is_still = still && isInSquare(x, y);
        blurry.push_back(
            static_cast<float>((is_still ? level(x, y) : light) + noisier_ * noise(random)));
        latent.push_back(static_cast<float>(level(x, y) - missing_ * std::sin(0.9 * x + 0.5 * y)));
        mean_counts.push_back(1.0F);
      }
    }
    solver_.solve({blurry.data(), latent.data(), mean_counts.data(), kNoise_dn, kOffset_dn}, blur_);
    trust_.measure({motion_, changes_, event_share_, visible_, kNoise_dn, kOffset_dn},
                   blur_.layout(), solver_);
  }

  static bool isInSquare(int x, int y) { return x >= 30 && x < 62 && y >= 24 && y < 56; }

  float trustAt(int x, int y) const { return trust_.trust()[indexOf(x, y, kSize.width)]; }

  double missing_ = 3.0;  ///< amplitude of a wave that the latent image lacks
  double noisier_ = 1.0;  ///< than the noise that is told
  float event_share_ = 1.0F;
  float visible_ = kContrast;  ///< changes above it are compared
  ImageMotion motion_;
  MovingBlur blur_;
  EventChanges changes_;
  ResidualSolver solver_;
  TrustMap trust_;
};

/// As the header says it, in double precision.
class Reference {
 public:
  Reference(const ImageMotion& motion, const EventChanges& changes, float event_share,
            float visible, const SceneLayout& layout, const ResidualSolver& solved)
      : event_share_(static_cast<double>(event_share)),
        visible_(static_cast<double>(visible)),
        layout_(layout) {
    const auto squares = [&](const std::vector<float>& residual) {
      return boxMeans(planeOf([&](int x, int y) {
                        return meanOf(x, y, [&](int u, int v) {
                          const auto at = static_cast<std::size_t>(v) * layout.stride() +
                                          static_cast<std::size_t>(u);
                          return std::pow(static_cast<double>(residual[at]), 2);
                        });
                      }),
                      3);
    };
    const Plane before = squares(solved.residualBefore());
    const Plane after = squares(solved.residualAfter());
    Plane does{kHalf};
    Plane could{kHalf};
    compare(motion, changes, solved.solution(), does, could);
    const Plane near = boxMeans(does, 1);
    const Plane around = shareAround(does, could);
    trusted_ =
        boxMeans(planeOf([&](int x, int y) {
                   const double variance = std::pow(static_cast<double>(kNoise_dn), 2);
                   const double explained = rise(1.0 - after.at(x, y) / before.at(x, y), 0.1, 0.4);
                   const double quiet = 1.0 - rise(after.at(x, y) / variance, 1.3, 2.0);
                   return std::max(explained, quiet) * (1.0 - rise(near.at(x, y), 0.1, 0.3)) *
                          (1.0 - rise(around.at(x, y), 0.1, 0.2));
                 }),
                 1);
  }

  /// At full resolution.
  double trust(int x, int y) const {
    const auto share = [](int at, int cell) { return at / 2 == cell ? 0.75 : 0.25; };
    double sum = 0.0;
    for (const int v : {y / 2, y % 2 == 0 ? y / 2 - 1 : y / 2 + 1}) {
      for (const int u : {x / 2, x % 2 == 0 ? x / 2 - 1 : x / 2 + 1}) {
        sum += share(y, v) * share(x, u) * trusted_.at(u, v);
      }
    }
    return sum < 0.02 ? 0.0 : sum;
  }

 private:
  template <typename Value>
  static double meanOf(int x, int y, Value value) {
    return 0.25 * (value(2 * x, 2 * y) + value(2 * x + 1, 2 * y) + value(2 * x, 2 * y + 1) +
                   value(2 * x + 1, 2 * y + 1));
  }

  double logAt(const std::vector<float>& scene, int x, int y) const {
    const double level = meanOf(x, y, [&](int u, int v) {
      const auto margin = static_cast<int>(layout_.margin());
      const int column = std::clamp(u + margin, 0, static_cast<int>(layout_.sceneStride()) - 1);
      const int row = std::clamp(v + margin, 0, static_cast<int>(layout_.sceneRows()) - 1);
      return static_cast<double>(scene[static_cast<std::size_t>(row) * layout_.sceneStride() +
                                       static_cast<std::size_t>(column)]);
    });
    return std::log(std::max(0.0, level) + kOffset_dn + 3.0);
  }

  void compare(const ImageMotion& motion, const EventChanges& changes,
               const std::vector<float>& scene, Plane& does, Plane& could) const {
    for (std::size_t k = 0; k < EventChanges::kInstants; ++k) {
      for (int y = 0; y < kHalf.height; ++y) {
        for (int x = 0; x < kHalf.width; ++x) {
          const double said = meanOf(x, y, [&](int u, int v) {
            return static_cast<double>(changes.at(k)[indexOf(u, v, kSize.width)]) / event_share_;
          });
          // One displacement serves blocks of these pixels.
          const auto block = static_cast<float>(x / 8 * 8) + 3.5F;
          const auto rows = static_cast<float>(y / 4 * 4) + 1.5F;
          const Displacement u =
              motion.displacement(2.0F * block + 0.5F, 2.0F * rows + 0.5F, EventChanges::kTau[k]);
          const double to_x = x + 0.5 * static_cast<double>(u.x);
          const double to_y = y + 0.5 * static_cast<double>(u.y);
          const int left = static_cast<int>(std::floor(to_x));
          const int top = static_cast<int>(std::floor(to_y));
          const double a = logAt(scene, left, top);
          const double b = logAt(scene, left + 1, top);
          const double c = logAt(scene, left, top + 1);
          const double d = logAt(scene, left + 1, top + 1);
          const double fx = to_x - left;
          const double fy = to_y - top;
          const double predicted = (1.0 - fy) * ((1.0 - fx) * a + fx * b) +
                                   fy * ((1.0 - fx) * c + fx * d) - logAt(scene, x, y);
          const double around =
              std::abs(b - a) + std::abs(c - a) + std::abs(d - c) + std::abs(d - b);
          const double larger = std::max(std::abs(predicted), std::abs(said));
          if (larger > visible_) {
            could.at(x, y) = 1.0;
            if (std::abs(predicted - said) > visible_ + 0.3 * larger + 0.25 * around) {
              does.at(x, y) = 1.0;
            }
          }
        }
      }
    }
  }

  /// Over the cells of 4 x 4 pixels around.
  static Plane shareAround(const Plane& does, const Plane& could) {
    constexpr int kCell = 4, kRadius = 5;
    return planeOf([&](int x, int y) {
      double wrong = 0.0;
      double compared = 0.0;
      double pixels = 0.0;
      for (int v = 0; v < kHalf.height; ++v) {
        for (int u = 0; u < kHalf.width; ++u) {
          if (std::abs(u / kCell - x / kCell) <= kRadius &&
              std::abs(v / kCell - y / kCell) <= kRadius) {
            wrong += does.at(u, v);
            compared += could.at(u, v);
            pixels += 1.0;
          }
        }
      }
      return wrong / std::max(compared, 0.02 * pixels);
    });
  }

  double event_share_;
  double visible_;
  SceneLayout layout_;
  Plane trusted_;
};

TEST_F(TrustMapTest, IsTheOneOfASlowReference) {
  struct Case {
    bool still;
    float event_share;
    float visible;
    float turn;
    double missing;
    double noisier;
  };
  for (const Case& one : {Case{false, 1.0F, kContrast, 0.0F, 3.0, 1.0},
                          {true, 1.0F, kContrast, 0.0F, 3.0, 1.0},
                          {false, 0.7F, kContrast, 0.0F, 3.0, 1.0},
                          {true, 1.0F, kContrast, 0.6F, 3.0, 1.6},
                          {false, 1.0F, 3.0F * kContrast, 0.3F, 0.0, 2.4},
                          {true, 1.0F, 3.0F * kContrast, 0.0F, 3.0, 1.0}}) {
    trust_ = TrustMap();
    setMotion(one.turn);
    missing_ = one.missing;
    noisier_ = one.noisier;
    event_share_ = one.event_share;
    visible_ = one.visible;
    measure(one.still);
    const Reference reference(motion_, changes_, event_share_, visible_, blur_.layout(), solver_);
    int apart = 0;
    int between = 0;
    for (int y = 0; y < 2 * kHalf.height; ++y) {
      for (int x = 0; x < 2 * kHalf.width; ++x) {
        const double expected = reference.trust(x, y);
        apart += std::abs(static_cast<double>(trustAt(x, y)) - expected) > 1e-5 ? 1 : 0;
        between += expected > 0.1 && expected < 0.9 ? 1 : 0;
      }
    }
    // What is on one side of a threshold in one precision may be on the other in another.
    EXPECT_LT(apart, 5);
    EXPECT_GT(between, 40);
  }
}

TEST_F(TrustMapTest, TrustsWhatMovesAsFitted) {
  measure(false);
  double sum = 0.0;
  for (const float trust : trust_.trust()) {
    EXPECT_GE(trust, 0.0F);
    EXPECT_LE(trust, 1.0F);
    EXPECT_TRUE(trust == 0.0F || trust >= 0.02F) << trust;
    sum += static_cast<double>(trust);
  }
  EXPECT_GT(sum / static_cast<double>(kSize.pixelCount()), 0.8);
}

TEST_F(TrustMapTest, TrustsLessWhereEventsAreSaidToBeLostAndAreNot) {
  const auto trusted = [this] {
    measure(false);
    return std::accumulate(trust_.trust().begin(), trust_.trust().end(), 0.0);
  };
  const double all = trusted();
  event_share_ = 0.5F;
  EXPECT_LT(trusted(), 0.5 * all);
}

TEST_F(TrustMapTest, DoesNotTrustWhatStandsStill) {
  measure(true);
  for (int y = 30; y < 50; ++y) {
    for (int x = 36; x < 56; ++x) {
      EXPECT_LT(trustAt(x, y), 0.5F) << x << ", " << y;
    }
  }
  EXPECT_EQ(trustAt(46, 40), 0.0F);
}

TEST_F(TrustMapTest, ClearedItTrustsNothing) {
  measure(false);
  trust_.clear(kSize);
  EXPECT_EQ(trust_.trust(), std::vector<float>(kSize.pixelCount(), 0.0F));
}

}  // namespace
}  // namespace fast_edi
