#include "scenes/room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fast_edi {
namespace {

/// A uniform blur of this width has unit standard deviation.
const double kUniformWidth = std::sqrt(12.0);

/// Edges are as soft as the textures.
double edgeWidthPx(const SceneSettings& scene) {
  return std::max(1.0, kUniformWidth * scene.optics_sigma_px);
}

}  // namespace

Room::Room(const RoomSettings& settings, const SceneSettings& scene, SensorSize view,
           double focal_length_px, std::uint64_t seed)
    : camera_{view, focal_length_px},
      bodies_(makeRoomBodies(settings, scene, seed)),
      renderer_(camera_, settings.texel_m, edgeWidthPx(scene)) {}

double Room::depthAt(const RigidPose& pose, const cv::Point2d& pixel) const {
  const Eigen::Vector3d ray = pose.orientation * camera_.rayOf(pixel);
  double nearest = std::numeric_limits<double>::infinity();
  const auto meet = [&](const TexturedFace& face) {
    const Eigen::Vector3d normal = face.normal();
    const double approach = normal.dot(ray);
    if (approach >= 0.0) return;
    const double depth = normal.dot(face.centre - pose.position) / approach;
    const Eigen::Vector3d at = pose.position + depth * ray - face.centre;
    if (depth > 0.0 && std::abs(at.dot(face.u)) <= 0.5 * face.width_m &&
        std::abs(at.dot(face.v)) <= 0.5 * face.height_m) {
      nearest = std::min(nearest, depth);
    }
  };
  for (const TexturedFace& face : bodies_.walls.faces) meet(face);
  for (const TexturedBody& body : bodies_.furniture) {
    for (const TexturedFace& face : body.faces) meet(face);
  }
  return nearest;
}

void Room::render(const RigidPose& pose, cv::Mat1f& irradiance) const {
  irradiance.create(camera_.size.height, camera_.size.width);
  std::vector<const TexturedBody*> by_distance;
  for (const TexturedBody& body : bodies_.furniture) by_distance.push_back(&body);
  const auto distance = [&pose](const TexturedBody& body) {
    return (body.centre - pose.position).head<2>().norm();
  };
  std::sort(
      by_distance.begin(), by_distance.end(),
      [&](const TexturedBody* a, const TexturedBody* b) { return distance(*a) > distance(*b); });
  const std::vector<FaceView> walls = renderer_.viewsOf(bodies_.walls, pose);
  std::vector<std::vector<FaceView>> furniture;
  for (const TexturedBody* body : by_distance) {
    furniture.push_back(renderer_.viewsOf(*body, pose));
    if (furniture.back().empty()) furniture.pop_back();
  }

  BodyRow row(static_cast<std::size_t>(camera_.size.width));
  for (int y = 0; y < camera_.size.height; ++y) {
    float* out = irradiance[y];
    const auto draw = [&](const std::vector<FaceView>& views) {
      row.begin = camera_.size.width;
      row.end = 0;
      for (const FaceView& view : views) renderer_.drawRow(view, y, row);
    };
    const auto clear = [&row](std::size_t x) {
      row.light[x] = 0.0F;
      row.cover[x] = 0.0F;
    };
    draw(walls);
    // Where two walls meet their covers add up to 1, where three meet to about 1.
    for (int i = 0; i < camera_.size.width; ++i) {
      const auto x = static_cast<std::size_t>(i);
      out[x] = row.light[x] / row.cover[x];
      clear(x);
    }
    for (const std::vector<FaceView>& views : furniture) {
      draw(views);
      for (int i = row.begin; i < row.end; ++i) {
        const auto x = static_cast<std::size_t>(i);
        const float cover = row.cover[x];
        out[x] = cover < 1.0F ? row.light[x] + (1.0F - cover) * out[x] : row.light[x] / cover;
        clear(x);
      }
    }
  }
}

}  // namespace fast_edi
