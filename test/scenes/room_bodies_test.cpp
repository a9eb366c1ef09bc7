#include "scenes/room_bodies.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "scenes/texture.hpp"

namespace fast_edi {
namespace {

RoomSettings coarseRoom() {
  RoomSettings room;
  room.texel_m = 0.02;
  room.poster_px_m = 0.02;
  return room;
}

RoomBodies makeCoarse(std::uint64_t seed) {
  return makeRoomBodies(coarseRoom(), SceneSettings(), seed);
}

void expectUnitAxes(const TexturedFace& face) {
  EXPECT_NEAR(face.u.norm(), 1.0, 1e-12);
  EXPECT_NEAR(face.v.norm(), 1.0, 1e-12);
  EXPECT_NEAR(face.u.dot(face.v), 0.0, 1e-12);
}

TEST(RoomBodies, WallsAreSeenFromWithin) {
  const TexturedBody walls = makeCoarse(1).walls;
  EXPECT_EQ(walls.faces.size(), 6u);
  double area_m2 = 0.0;
  for (const TexturedFace& face : walls.faces) {
    expectUnitAxes(face);
    EXPECT_GT(face.normal().dot(walls.centre - face.centre), 0.0);
    area_m2 += face.width_m * face.height_m;
  }
  const RoomSettings room = coarseRoom();
  EXPECT_NEAR(area_m2,
              2.0 * (room.length_m * room.width_m + room.width_m * room.height_m +
                     room.height_m * room.length_m),
              1e-9);
}

/// Random numbers are drawn in a fixed order, not in one that the compiler chooses.
TEST(RoomBodies, FurnitureIsTheSameWithEveryCompiler) {
  const RoomBodies bodies = makeCoarse(1);
  ASSERT_EQ(bodies.furniture.size(), 8u);
  const Eigen::Vector3d box(-3.007060971355656, -0.56310370922340114, 0.52336565744702535);
  EXPECT_LT((bodies.furniture[4].centre - box).norm(), 1e-12) << "at a wall along y";
  const Eigen::Vector3d other(-0.6059642739774983, -2.3010008897932765, 0.32410234811578553);
  EXPECT_LT((bodies.furniture[5].centre - other).norm(), 1e-12) << "at a wall along x";
}

TEST(RoomBodies, FurnitureStandsOnTheFloorWithinTheWalls) {
  const RoomSettings room = coarseRoom();
  const RoomBodies bodies = makeCoarse(1);
  EXPECT_EQ(bodies.furniture.size(), 8u);
  for (const TexturedBody& body : bodies.furniture) {
    const double height_m = body.faces.at(0).height_m;
    EXPECT_NEAR(body.centre.z(), 0.5 * height_m, 1e-12);
    EXPECT_EQ(body.faces.size(), height_m < room.height_m ? 5u : 4u) << "with a top, unless hidden";
    for (const TexturedFace& face : body.faces) {
      expectUnitAxes(face);
      EXPECT_GT(face.normal().dot(face.centre - body.centre), 0.0);
      EXPECT_LT(std::abs(face.centre.x()), 0.5 * room.length_m);
      EXPECT_LT(std::abs(face.centre.y()), 0.5 * room.width_m);
    }
  }
}

TEST(RoomBodies, TexturesCoverTheirFacesWithinTheBoundsOfReflectance) {
  const RoomSettings room = coarseRoom();
  for (const TexturedFace& face : makeCoarse(1).walls.faces) {
    ASSERT_EQ(face.levels.size(), static_cast<std::size_t>(kTextureLevels));
    EXPECT_GE(face.levels[0].texels.cols * room.texel_m, face.width_m);
    EXPECT_GE(face.levels[0].texels.rows * room.texel_m, face.height_m);
    for (const TextureLevel& level : face.levels) {
      double darkest = 0.0;
      double brightest = 0.0;
      cv::minMaxLoc(level.texels, &darkest, &brightest);
      EXPECT_GE(darkest, kMinReflectance - 1e-4F);
      EXPECT_LE(brightest, kMaxReflectance + 1e-4F);
    }
  }
}

TEST(RoomBodies, SeedsDecideOnFurnitureAndTextures) {
  const RoomBodies first = makeCoarse(1);
  const RoomBodies again = makeCoarse(1);
  const RoomBodies other = makeCoarse(2);
  const auto texels = [](const RoomBodies& bodies) {
    return bodies.walls.faces[0].levels[0].texels;
  };
  EXPECT_EQ(first.furniture[0].centre, again.furniture[0].centre);
  EXPECT_NE(first.furniture[0].centre, other.furniture[0].centre);
  EXPECT_EQ(cv::norm(texels(first), texels(again), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(texels(first), texels(other), cv::NORM_INF), 0.1);
}

}  // namespace
}  // namespace fast_edi
