// Plane, tags and camera path.
#include "scenes/scene.hpp"

#include <cstdio>
#include <string>

#include <unistd.h>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "fast_edi/tags/tag_detector.hpp"
#include "scenes/april_tags.hpp"
#include "scenes/camera_motion.hpp"
#include "simulation/davis_simulator.hpp"

namespace fast_edi {
namespace {

cv::Matx33d nominalView(SensorSize size) {
  return {1.0, 0.0, -0.5 * (size.width - 1), 0.0, 1.0, -0.5 * (size.height - 1), 0.0, 0.0, 1.0};
}

SceneSettings taggedScene(TextureKind texture, int tags) {
  SceneSettings settings;
  settings.texture = texture;
  settings.tags = tags;
  return settings;
}

class TagSceneTest : public testing::TestWithParam<TextureKind> {};

TEST_P(TagSceneTest, AllTagsAreReadWhereTheyWerePlaced) {
  const Scene scene(taggedScene(GetParam(), 6), kDavis346Size, ColourFilter::kNone, 11);
  cv::Mat1f irradiance;
  scene.render(nominalView(kDavis346Size), 0, irradiance);
  cv::Mat1b image;
  irradiance.convertTo(image, CV_8U, 215.0);
  const std::vector<TagDetection> found = TagDetector().detect(image);
  ASSERT_EQ(found.size(), 6U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const PlacedTag& tag = scene.tags()[i];
    EXPECT_EQ(found[i].id, tag.id);
    EXPECT_EQ(found[i].hamming, 0);
    const cv::Point2d expected = tag.centre + 0.5 * cv::Point2d(345, 259);
    EXPECT_LT(cv::norm(found[i].centre - expected), 0.3);
  }
}

INSTANTIATE_TEST_SUITE_P(Textures, TagSceneTest,
                         testing::Values(TextureKind::kPoster, TextureKind::kNatural,
                                         TextureKind::kFlat, TextureKind::kMosaic,
                                         TextureKind::kPage));

TEST(SceneTest, TexturesDifferInTheirContrast) {
  const auto contrast = [](TextureKind kind) {
    const Scene scene(taggedScene(kind, 0), kDavis346Size, ColourFilter::kNone, 3);
    cv::Mat1f irradiance;
    scene.render(nominalView(kDavis346Size), 0, irradiance);
    cv::Mat1f log;
    cv::log(irradiance, log);
    cv::Scalar mean;
    cv::Scalar deviation;
    cv::meanStdDev(log, mean, deviation);
    return deviation[0];
  };
  EXPECT_LT(contrast(TextureKind::kFlat), 0.1);
  EXPECT_GT(contrast(TextureKind::kPoster), 0.2);
  EXPECT_GT(contrast(TextureKind::kNatural), 0.5);
  EXPECT_GT(contrast(TextureKind::kMosaic), 0.5);
  EXPECT_GT(contrast(TextureKind::kPage), 0.3);
}

TEST(SceneTest, IlluminationScalesIrradiance) {
  SceneSettings settings = taggedScene(TextureKind::kNatural, 0);
  cv::Mat1f bright;
  Scene(settings, kDavis240cSize, ColourFilter::kNone, 3)
      .render(nominalView(kDavis240cSize), 0, bright);
  settings.illumination = 0.1;
  cv::Mat1f dim;
  Scene(settings, kDavis240cSize, ColourFilter::kNone, 3)
      .render(nominalView(kDavis240cSize), 0, dim);
  EXPECT_LT(cv::norm(bright * 0.1, dim, cv::NORM_INF), 1e-5);
  EXPECT_GE(*std::min_element(bright.begin(), bright.end()), 0.0199F);
}

TEST(SceneTest, RenderingMovesWithTheCameraByFractionsOfAPixel) {
  const Scene scene(taggedScene(TextureKind::kNatural, 0), kDavis240cSize, ColourFilter::kNone, 3);
  const auto at = [&](double shift) {
    cv::Matx33d view = nominalView(kDavis240cSize);
    view(0, 2) += shift;
    cv::Mat1f irradiance;
    scene.render(view, 0, irradiance);
    return irradiance;
  };
  const cv::Mat1f before = at(0.0);
  EXPECT_LT(cv::norm(before.colRange(1, 240), at(1.0).colRange(0, 239), cv::NORM_INF), 1e-5);
  // Half a pixel lies between its neighbours: linear interpolation is right within the small
  // curvature that the optics' blur leaves.
  const cv::Mat1f between = 0.5 * (before + at(1.0));
  EXPECT_LT(cv::norm(between, at(0.5), cv::NORM_L1) / static_cast<double>(between.total()), 0.01);
}

TEST(SceneTest, PictureOfTheUsersOwnFillsTheView) {
  const std::string path =
      testing::TempDir() + "fast_edi_texture_" + std::to_string(getpid()) + ".png";
  cv::Mat3b picture(90, 120, cv::Vec3b(188, 188, 188));
  picture.colRange(60, 120).setTo(cv::Scalar(0, 0, 0));
  ASSERT_TRUE(cv::imwrite(path, picture));
  SceneSettings settings;
  settings.texture_file = path;
  const Scene scene(settings, kDavis240cSize, ColourFilter::kNone, 1);
  std::remove(path.c_str());
  cv::Mat1f irradiance;
  scene.render(nominalView(kDavis240cSize), 0, irradiance);
  // sRGB 188 is a linear 0.503; black is lifted to the smallest reflectance.
  EXPECT_NEAR(irradiance(90, 60), 0.503, 0.002);
  EXPECT_NEAR(irradiance(90, 180), 0.02, 1e-4);
}

TEST(AprilTagsTest, CellsAreThoseOfTheFamily) {
  const cv::Mat1b cells = tagCells(0);
  ASSERT_EQ(cells.size(), cv::Size(10, 10));
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(cells(0, i), 255);
    EXPECT_EQ(cells(i, 9), 255);
  }
  for (int i = 1; i < 9; ++i) {
    EXPECT_EQ(cells(1, i), 0);
    EXPECT_EQ(cells(i, 8), 0);
  }
  // Id 0 as apriltag_to_image() of libapriltag 3.2 draws it.
  const cv::Mat1b inside = (cv::Mat1b(6, 6) << 1, 1, 0, 1, 0, 1,  //
                            0, 1, 1, 1, 0, 1,                     //
                            0, 1, 1, 0, 0, 0,                     //
                            1, 0, 1, 0, 0, 0,                     //
                            0, 1, 0, 1, 1, 0,                     //
                            0, 0, 0, 1, 0, 0);
  EXPECT_EQ(cv::countNonZero(cells(cv::Rect(2, 2, 6, 6)) != 255 * inside), 0);
  EXPECT_THROW(tagCells(-1), std::invalid_argument);
  EXPECT_THROW(tagCells(100'000), std::invalid_argument);
}

TEST(AprilTagsTest, TagsDoNotOverlapAndLieInView) {
  RandomEngine random = makeRandomEngine(5, RandomStream::kTags);
  const std::vector<PlacedTag> tags = placeTags(9, 40.0, kDavis346Size, random);
  ASSERT_EQ(tags.size(), 9U);
  for (std::size_t i = 0; i < tags.size(); ++i) {
    for (const cv::Point2d& corner : tags[i].corners(kTagPaperFactor)) {
      EXPECT_LT(std::abs(corner.x), 173.0);
      EXPECT_LT(std::abs(corner.y), 130.0);
    }
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GT(cv::norm(tags[i].centre - tags[j].centre), 40.0 * kTagPaperFactor);
    }
  }
}

TEST(VisibleTagsTest, TagsThatLeaveTheViewAreNotCounted) {
  SimulationSettings settings;
  settings.sensor = SensorSettings::ideal();
  settings.scene.texture = TextureKind::kFlat;
  settings.scene.tags = 6;
  settings.motion.kind = MotionKind::kPan;
  settings.timing.frames = 20;
  const DavisSimulator simulator(settings);
  const TagDetector detector;
  bool some_left = false;
  for (int i = 0; i < 20; ++i) {
    const std::int64_t t_ns = settings.timing.start_ns + i * 50 * kNanosecondsPerMillisecond;
    std::vector<int> found;
    for (const TagDetection& tag : detector.detect(simulator.latentAt(t_ns)))
      found.push_back(tag.id);
    const std::vector<int> visible = simulator.visibleTagsAt(t_ns);
    // A tag whose sheet is cut may still be read, never the other way round.
    EXPECT_THAT(found, testing::IsSupersetOf(visible));
    some_left = some_left || visible.size() < 6;
  }
  EXPECT_TRUE(some_left);
}

TEST(CameraMotionTest, NominalPoseLooksAtThePlaneOneToOne) {
  MotionSettings settings;
  settings.kind = MotionKind::kStill;
  const CameraMotion motion(settings, kDavis346Size, 330.0, 1);
  EXPECT_LT(cv::norm(motion.imageToPlaneAt(123) - nominalView(kDavis346Size)), 1e-9);
  EXPECT_EQ(motion.speedPxPerSecond(0), 0.0);
}

TEST(CameraMotionTest, PresetsHaveTheirSpeeds) {
  const auto rmsSpeed = [](MotionKind kind, double scale) {
    MotionSettings settings;
    settings.kind = kind;
    settings.scale = scale;
    double sum = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const CameraMotion motion(settings, kDavis346Size, 330.0, seed);
      for (int ms = 0; ms < 2000; ms += 5) {
        sum += std::pow(motion.speedPxPerSecond(ms * kNanosecondsPerMillisecond), 2.0);
        ++count;
      }
    }
    return std::sqrt(sum / count);
  };
  EXPECT_NEAR(rmsSpeed(MotionKind::kMild, 1.0), 110.0, 40.0);
  EXPECT_NEAR(rmsSpeed(MotionKind::kPan, 1.0), 350.0, 80.0);
  EXPECT_NEAR(rmsSpeed(MotionKind::kShake, 1.0), 900.0, 150.0);
  EXPECT_NEAR(rmsSpeed(MotionKind::kShake, 0.5) / rmsSpeed(MotionKind::kShake, 1.0), 0.5, 0.02);
}

TEST(CameraMotionTest, StaysOnThePlane) {
  for (const MotionKind kind :
       {MotionKind::kMild, MotionKind::kPan, MotionKind::kSpin, MotionKind::kShake}) {
    MotionSettings settings;
    settings.kind = kind;
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const CameraMotion motion(settings, kDavis346Size, 330.0, seed);
      for (int ms = 0; ms < 3000; ms += 10) {
        const cv::Matx33d h = motion.imageToPlaneAt(ms * kNanosecondsPerMillisecond);
        for (const cv::Vec3d& corner : {cv::Vec3d(0, 0, 1), cv::Vec3d(345, 259, 1)}) {
          const cv::Vec3d p = h * corner;
          EXPECT_LT(std::abs(p[0] / p[2]), 173 + Scene::kMarginPx);
          EXPECT_LT(std::abs(p[1] / p[2]), 130 + Scene::kMarginPx);
        }
      }
    }
  }
}

}  // namespace
}  // namespace fast_edi
