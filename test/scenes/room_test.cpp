// The room: the way through it, the inertial sensor and what the camera sees.
#include "scenes/room.hpp"

#include <cmath>
#include <set>
#include <string>

#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "simulation/davis_simulator.hpp"
#include "simulation/imu_sensor.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

constexpr std::int64_t kSecond = kNanosecondsPerSecond;
constexpr std::int64_t kLength = 60 * kSecond;

SimulationSettings roomSettings() {
  SimulationSettings settings;
  settings.kind = SceneKind::kRoom;
  settings.room.texel_m = 0.02;
  settings.room.poster_px_m = 0.02;
  settings.sensor = SensorSettings::ideal();
  settings.sensor.size = {96, 72};
  settings.scene.density = 0.9;
  settings.timing.frames = 3;
  settings.timing.period_us = 50'000;
  settings.timing.exposure_us = 40'000;
  settings.timing.lead_us = 20'000;
  return settings;
}

double angleBetween(const RigidPose& a, const RigidPose& b) {
  return a.orientation.angularDistance(b.orientation);
}

TEST(RoomTrajectoryTest, StartsAndEndsAtRestInTheSamePose) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const RoomTrajectory trajectory(RoomSettings(), kLength, seed);
    const RigidMotion first = trajectory.motionAt(0);
    const RigidMotion last = trajectory.motionAt(kLength);
    EXPECT_LT((first.pose.position - last.pose.position).norm(), 1e-9);
    EXPECT_LT(angleBetween(first.pose, last.pose), 1e-9);
    for (const RigidMotion& end : {first, last}) {
      EXPECT_LT(end.velocity.norm(), 1e-9);
      EXPECT_LT(end.acceleration.norm(), 1e-9);
      EXPECT_LT(end.angular_velocity.norm(), 1e-9);
    }
  }
}

TEST(RoomTrajectoryTest, WalksMetresStaysAwayFromTheWallsAndShakes) {
  const RoomSettings settings;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const RoomTrajectory trajectory(settings, kLength, seed);
    double way = 0.0;
    double turning = 0.0;
    int samples = 0;
    for (std::int64_t t = 0; t < kLength; t += kSecond / 100) {
      const RigidMotion motion = trajectory.motionAt(t);
      way += motion.velocity.norm() * 0.01;
      turning += motion.angular_velocity.squaredNorm();
      ++samples;
      ASSERT_LT(std::abs(motion.pose.position.x()), 0.5 * settings.length_m - 1.5);
      ASSERT_LT(std::abs(motion.pose.position.y()), 0.5 * settings.width_m - 1.5);
      ASSERT_GT(motion.pose.position.z(), 1.2);
      ASSERT_LT(motion.pose.position.z(), 1.8);
      // No shaking at first: what is left is walking and looking about.
      if (t < 3 * kSecond) {
        ASSERT_LT(motion.angular_velocity.norm(), 1.6);
      }
    }
    EXPECT_GT(way, 15.0);
    // Two axes of 2.2 deg at 4.5 Hz and a third of 60 %.
    EXPECT_NEAR(std::sqrt(turning / samples), 1.7, 0.3);
  }
}

TEST(RoomTrajectoryTest, DerivativesAreThoseOfThePoses) {
  const RoomTrajectory trajectory(RoomSettings(), kLength, 4);
  constexpr std::int64_t kStep = 100 * kNanosecondsPerMicrosecond;
  constexpr double kStepS = 1e-4;
  for (std::int64_t t = kSecond / 3; t < kLength; t += kSecond * 7 / 10) {
    const RigidMotion motion = trajectory.motionAt(t);
    const RigidMotion before = trajectory.motionAt(t - kStep);
    const RigidMotion after = trajectory.motionAt(t + kStep);
    const auto rate = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
      return Eigen::Vector3d((to - from) / (2.0 * kStepS));
    };
    EXPECT_LT((rate(before.pose.position, after.pose.position) - motion.velocity).norm(), 1e-4);
    EXPECT_LT((rate(before.velocity, after.velocity) - motion.acceleration).norm(), 1e-3);
    const Eigen::AngleAxisd turn(before.pose.orientation.conjugate() * after.pose.orientation);
    const Eigen::Vector3d turning = turn.axis() * turn.angle() / (2.0 * kStepS);
    EXPECT_LT((turning - motion.angular_velocity).norm(), 1e-3);
  }
}

TEST(ImuSensorTest, FeelsWhatHoldsItUp) {
  const RoomTrajectory trajectory(RoomSettings(), kLength, 5);
  const ImuSample sample = idealImuSample(trajectory.motionAt(0), 0);
  // Level at the start: up is -y of the optical frame.
  EXPECT_LT((sample.linear_acceleration - Eigen::Vector3d(0.0, -9.81, 0.0)).norm(), 1e-9);
  EXPECT_LT(sample.angular_velocity.norm(), 1e-9);
}

ImuSettings perfectImu() {
  ImuSettings settings;
  settings.accelerometer_noise = settings.gyroscope_noise = 0.0;
  settings.accelerometer_walk = settings.gyroscope_walk = 0.0;
  settings.accelerometer_bias = settings.gyroscope_bias = 0.0;
  return settings;
}

TEST(ImuSensorTest, PerfectReadingsIntegrateToTheTrajectory) {
  const RoomTrajectory trajectory(RoomSettings(), kLength, 6);
  ImuSettings settings = perfectImu();
  settings.rate_hz = 2000.0;  // the rule below errs with the square of the period
  ImuSensor sensor(settings, 0, 6);
  std::vector<ImuSample> samples;
  constexpr std::int64_t kEnd = 20 * kSecond;
  sensor.advance(kEnd, trajectory, samples);
  ASSERT_EQ(samples.size(), 20U * 2000U + 1U);
  const RigidMotion start = trajectory.motionAt(0);
  Eigen::Vector3d position = start.pose.position;
  Eigen::Vector3d velocity = start.velocity;
  Eigen::Quaterniond orientation = start.pose.orientation;
  const Eigen::Vector3d gravity(0.0, 0.0, -9.81);
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = static_cast<double>(samples[i].t_ns - samples[i - 1].t_ns) / kSecond;
    const Eigen::Vector3d turn =
        0.5 * dt * (samples[i - 1].angular_velocity + samples[i].angular_velocity);
    const Eigen::Quaterniond next =
        orientation * Eigen::Quaterniond(Eigen::AngleAxisd(
                          turn.norm(), turn.norm() > 0.0 ? Eigen::Vector3d(turn.normalized())
                                                         : Eigen::Vector3d::UnitX()));
    const Eigen::Vector3d acceleration = 0.5 * (orientation * samples[i - 1].linear_acceleration +
                                                next * samples[i].linear_acceleration) +
                                         gravity;
    position += velocity * dt + 0.5 * dt * dt * acceleration;
    velocity += dt * acceleration;
    orientation = next;
  }
  const RigidMotion end = trajectory.motionAt(kEnd);
  EXPECT_LT((position - end.pose.position).norm(), 0.05);
  EXPECT_LT((velocity - end.velocity).norm(), 0.01);
  EXPECT_LT(orientation.angularDistance(end.pose.orientation), 1e-3);
}

TEST(ImuSensorTest, NoiseAndBiasesHaveTheStatedStrength) {
  // A camera that rests: nothing but noise and gravity.
  RoomSettings still;
  still.wander = 0.0;
  still.shake_rms_deg = 0.0;
  still.lap_s = 1e4;
  const RoomTrajectory trajectory(still, kLength, 1);
  const auto deviation = [](const std::vector<double>& values) {
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    double variance = 0.0;
    for (const double value : values) {
      variance += (value - mean) * (value - mean) / static_cast<double>(values.size() - 1);
    }
    return std::sqrt(variance);
  };
  ImuSettings settings = perfectImu();
  settings.accelerometer_noise = 4e-3;
  settings.gyroscope_noise = 2e-4;
  std::vector<ImuSample> samples;
  ImuSensor(settings, 0, 1).advance(20 * kSecond, trajectory, samples);
  std::vector<double> turning;
  std::vector<double> force;
  for (const ImuSample& sample : samples) {
    turning.push_back(sample.angular_velocity.x());
    force.push_back(sample.linear_acceleration.z());
  }
  // Density x sqrt(400 Hz); 8000 samples: standard error 0.8 %.
  EXPECT_NEAR(deviation(turning), 4e-3, 0.04 * 4e-3);
  EXPECT_NEAR(deviation(force), 0.08, 0.04 * 0.08);

  settings = perfectImu();
  settings.accelerometer_walk = 0.02;
  settings.gyroscope_walk = 0.01;
  samples.clear();
  ImuSensor(settings, 0, 1).advance(20 * kSecond, trajectory, samples);
  turning.clear();
  force.clear();
  for (std::size_t i = 1; i < samples.size(); ++i) {
    turning.push_back(samples[i].angular_velocity.x() - samples[i - 1].angular_velocity.x());
    force.push_back(samples[i].linear_acceleration.z() - samples[i - 1].linear_acceleration.z());
  }
  // Density / sqrt(400 Hz).
  EXPECT_NEAR(deviation(turning), 5e-4, 0.04 * 5e-4);
  EXPECT_NEAR(deviation(force), 1e-3, 0.04 * 1e-3);

  settings = perfectImu();
  settings.accelerometer_bias = 0.05;
  settings.gyroscope_bias = 5e-3;
  turning.clear();
  force.clear();
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    samples.clear();
    ImuSensor(settings, 0, seed).advance(0, trajectory, samples);
    ASSERT_EQ(samples.size(), 1U);
    turning.push_back(samples[0].angular_velocity.x());
    force.push_back(samples[0].linear_acceleration.x());
  }
  EXPECT_NEAR(deviation(turning), 5e-3, 0.2 * 5e-3);
  EXPECT_NEAR(deviation(force), 0.05, 0.2 * 0.05);
}

TEST(RoomTest, EveryPixelShowsASurfaceAtAnyTime) {
  SimulationSettings settings = roomSettings();
  const Room room(settings.room, settings.scene, settings.sensor.size, 67.2, 7);
  const RoomTrajectory trajectory(settings.room, kLength, 7);
  cv::Mat1f irradiance;
  for (std::int64_t t = 0; t < kLength; t += kSecond / 3) {
    room.render(trajectory.poseAt(t), irradiance);
    double darkest = 0.0;
    double brightest = 0.0;
    ASSERT_TRUE(cv::checkRange(irradiance));
    cv::minMaxLoc(irradiance, &darkest, &brightest);
    ASSERT_GT(darkest, 0.019);
    ASSERT_LT(brightest, 1.001);
  }
}

TEST(RoomTest, IrradianceChangesSmoothlyWithThePose) {
  SimulationSettings settings = roomSettings();
  const Room room(settings.room, settings.scene, settings.sensor.size, 67.2, 8);
  const RoomTrajectory trajectory(settings.room, kLength, 8);
  cv::Mat1f before;
  cv::Mat1f after;
  for (std::int64_t t = kSecond; t < kLength; t += kSecond) {
    RigidPose pose = trajectory.poseAt(t);
    room.render(pose, before);
    // 0.02 px: edges of full contrast, two pixels wide, change by 1 % of it, textures by as much
    // again; an edge that jumps would change by its whole contrast.
    pose.orientation = pose.orientation *
                       Eigen::Quaterniond(Eigen::AngleAxisd(0.02 / 67.2, Eigen::Vector3d::UnitY()));
    room.render(pose, after);
    EXPECT_LT(cv::norm(before, after, cv::NORM_INF), 0.04) << "at " << t;
  }
}

TEST(RoomTest, PointsOfTheWallsAreSeenWhereThePoseSays) {
  // Every face carries a bright spot in its middle.
  const TemporaryDirectory directory;
  cv::Mat1b picture(600, 600, static_cast<uchar>(60));
  cv::circle(picture, {300 * 16 - 8, 300 * 16 - 8}, 10 * 16, 255, cv::FILLED, cv::LINE_AA, 4);
  SimulationSettings settings = roomSettings();
  settings.scene.texture_file = directory.file("spot.png");
  ASSERT_TRUE(cv::imwrite(settings.scene.texture_file, picture));
  settings.sensor.size = {160, 120};
  settings.timing.frames = 1200;
  const DavisSimulator simulator(settings);
  const RoomSettings& room = settings.room;
  const double middle = 0.5 * room.height_m;
  const std::vector<Eigen::Vector3d> points{{0.5 * room.length_m, 0.0, middle},
                                            {-0.5 * room.length_m, 0.0, middle},
                                            {0.0, 0.5 * room.width_m, middle},
                                            {0.0, -0.5 * room.width_m, middle}};
  const double focal_px = 0.7 * 160;
  std::set<std::size_t> seen;
  for (std::int64_t t = 0; t < kLength; t += kSecond) {
    const RigidPose pose = simulator.trajectory()->poseAt(t);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d point = pose.orientation.conjugate() * (points[i] - pose.position);
      if (point.z() < 0.5) continue;
      const cv::Point2d expected(focal_px * point.x() / point.z() + 79.5,
                                 focal_px * point.y() / point.z() + 59.5);
      constexpr int kReach = 8;
      const cv::Rect box(cvRound(expected.x) - kReach, cvRound(expected.y) - kReach, 2 * kReach + 1,
                         2 * kReach + 1);
      if ((box & cv::Rect(0, 0, 160, 120)) != box) continue;
      const cv::Mat1f view = simulator.irradianceAt(settings.timing.start_ns + t)(box);
      // The spot stands out from the grey, which is 0.045 in linear light.
      cv::Mat1f spot;
      cv::max(view - 0.2F, 0.0, spot);
      const cv::Moments moments = cv::moments(spot);
      ASSERT_GT(moments.m00, 1.0) << "wall " << i << " at " << t;
      const cv::Point2d found(moments.m10 / moments.m00 + box.x, moments.m01 / moments.m00 + box.y);
      EXPECT_LT(cv::norm(found - expected), 0.3) << "wall " << i << " at " << t;
      seen.insert(i);
    }
  }
  EXPECT_EQ(seen.size(), points.size());
}

TEST(RoomSimulatorTest, FramesHaveThePoseOfTheirMiddleAndReadingsCoverTheRecording) {
  const SimulationSettings settings = roomSettings();
  DavisSimulator simulator(settings);
  SimulatedInterval interval;
  std::vector<ImuSample> samples;
  while (simulator.next(interval)) {
    const ExposureInterval& exposure = interval.frame.exposure;
    ASSERT_TRUE(interval.frame.pose.has_value());
    const RigidPose expected = simulator.trajectory()->poseAt(exposure.at(ExposureInstant::kMid) -
                                                              settings.timing.start_ns);
    EXPECT_LT((interval.frame.pose->position - expected.position).norm(), 1e-12);
    samples.insert(samples.end(), interval.imu.begin(), interval.imu.end());
  }
  // 190 ms at 400 Hz, both ends included.
  ASSERT_EQ(samples.size(), 77U);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    EXPECT_EQ(samples[i].t_ns, settings.timing.start_ns + static_cast<std::int64_t>(i) * 2'500'000);
  }
  EXPECT_EQ(samples.back().t_ns, interval.end_ns);
}

TEST(RoomSimulatorTest, EventsFollowLogIrradianceWithinOneThreshold) {
  SimulationSettings settings = roomSettings();
  settings.sensor.threshold_mismatch = 0.1;
  DavisSimulator simulator(settings);
  cv::Mat1f initial;
  cv::log(simulator.irradianceAt(settings.timing.start_ns), initial);
  const std::vector<float>& on = simulator.eventSensor().thresholdsOn();
  const std::vector<float>& off = simulator.eventSensor().thresholdsOff();
  std::vector<double> level(initial.begin(), initial.end());
  std::size_t events = 0;
  SimulatedInterval interval;
  while (simulator.next(interval)) {
    for (const Event& event : interval.events) {
      const std::size_t pixel = event.y * static_cast<std::size_t>(initial.cols) + event.x;
      level[pixel] += event.on ? on[pixel] : -static_cast<double>(off[pixel]);
    }
    events += interval.events.size();
    cv::Mat1f now;
    cv::log(simulator.irradianceAt(interval.end_ns), now);
    for (std::size_t pixel = 0; pixel < level.size(); ++pixel) {
      const double difference = now(static_cast<int>(pixel)) - level[pixel];
      ASSERT_LT(difference, on[pixel] + 2e-3);
      ASSERT_GT(difference, -off[pixel] - 2e-3);
    }
  }
  EXPECT_GT(events, 1000U);
}

TEST(RoomSimulatorTest, SeedsDecideOnTexturesWaysAndNoise) {
  SimulationSettings settings = roomSettings();
  settings.sensor = SensorSettings();
  settings.sensor.size = {96, 72};
  const auto run = [&settings](std::uint64_t seed) {
    settings.seed = seed;
    DavisSimulator simulator(settings);
    SimulatedInterval interval;
    EXPECT_TRUE(simulator.next(interval));
    return interval;
  };
  const SimulatedInterval first = run(1);
  const SimulatedInterval again = run(1);
  const SimulatedInterval other = run(2);
  ASSERT_EQ(first.events.size(), again.events.size());
  for (std::size_t i = 0; i < first.events.size(); ++i) {
    ASSERT_EQ(first.events[i].t_ns, again.events[i].t_ns);
  }
  EXPECT_EQ(cv::norm(first.frame.blurry, again.frame.blurry, cv::NORM_INF), 0.0);
  EXPECT_EQ(first.imu.back().linear_acceleration, again.imu.back().linear_acceleration);
  EXPECT_EQ(first.frame.pose->position, again.frame.pose->position);
  EXPECT_GT(cv::norm(first.frame.sharp, other.frame.sharp, cv::NORM_INF), 20.0);
  EXPECT_GT((first.frame.pose->position - other.frame.pose->position).norm(), 0.01);
  EXPECT_NE(first.imu.back().linear_acceleration, other.imu.back().linear_acceleration);
}

TEST(RoomSimulatorTest, WhatBelongsToThePlaneIsRefused) {
  using testing::HasSubstr;
  const auto messageOf = [](auto change) -> std::string {
    SimulationSettings settings = roomSettings();
    change(settings);
    try {
      settings.validate();
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_THAT(messageOf([](auto& s) { s.scene.tags = 1; }), HasSubstr("tags in the room"));
  EXPECT_THAT(messageOf([](auto& s) { s.scene.flicker_hz = 100.0; }), HasSubstr("flicker"));
  EXPECT_THAT(messageOf([](auto& s) { s.sensor.colour_filter = ColourFilter::kBayerRggb; }),
              HasSubstr("colour filter"));
  EXPECT_THAT(messageOf([](auto& s) { s.room.length_m = 1.0; }), HasSubstr("room length"));
  EXPECT_THAT(messageOf([](auto& s) { s.imu.rate_hz = 0.0; }), HasSubstr("IMU rate"));
  EXPECT_THROW(sceneKindFromName("moon"), std::invalid_argument);
}

}  // namespace
}  // namespace fast_edi
