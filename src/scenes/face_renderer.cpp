#include "scenes/face_renderer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace fast_edi {
namespace {

/// A face closer to being seen edge-on than this shows nothing [m].
constexpr double kEdgeOnM = 1e-4;
/// Inverse depth of what lies before the camera is held above this [1/m].
constexpr float kSmallestInverseDepth = 1e-3F;

/// Base-2 logarithm, linear between powers of two: continuous, exact at them.
/// \pre value > 0
float quickLog2(float value) {
  constexpr std::int32_t kOne = 127 << 23;
  constexpr float kPerUnit = 1.0F / (1 << 23);
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return static_cast<float>(bits - kOne) * kPerUnit;
}

}  // namespace

std::vector<FaceView> FaceRenderer::viewsOf(const TexturedBody& body, const RigidPose& pose) const {
  const Eigen::Matrix3d rotation = pose.orientation.toRotationMatrix();
  // Of a vector in the world: its scalar product with the ray of pixel (x, y).
  const auto along_ray = [&](const Eigen::Vector3d& vector) {
    const Eigen::Vector3d seen = rotation.transpose() * vector / camera_.focal_length_px;
    return Eigen::Vector3d(seen.x(), seen.y(),
                           seen.z() * camera_.focal_length_px -
                               0.5 * (camera_.size.width - 1) * seen.x() -
                               0.5 * (camera_.size.height - 1) * seen.y());
  };
  const auto linear = [](const Eigen::Vector3d& vector) {
    return LinearFunction{vector.x(), vector.y(), vector.z()};
  };
  std::vector<FaceView> views;
  for (const TexturedFace& face : body.faces) {
    const Eigen::Vector3d normal = face.normal();
    const Eigen::Vector3d offset = pose.position - face.centre;
    const double distance = normal.dot(offset);
    if (distance < kEdgeOnM) continue;
    // The ray from the camera meets the plane at depth 1 / w, there at (u / w, v / w) from the
    // face's centre.
    const Eigen::Vector3d w = -along_ray(normal) / distance;
    const Eigen::Vector3d u = along_ray(face.u) + offset.dot(face.u) * w;
    const Eigen::Vector3d v = along_ray(face.v) + offset.dot(face.v) * w;
    FaceView view{};
    for (std::size_t i = 0; i < view.levels.size(); ++i) {
      const TextureLevel& level = face.levels[i];
      view.levels[i] = {level.texels[0],
                        static_cast<std::ptrdiff_t>(level.texels.step1()),
                        level.u_scale,
                        level.v_scale,
                        static_cast<float>(level.texels.cols) - 1.001F,
                        static_cast<float>(level.texels.rows) - 1.001F};
    }
    const std::array<Eigen::Vector3d, 4> edges{
        0.5 * face.width_m * w + u, 0.5 * face.width_m * w - u, 0.5 * face.height_m * w + v,
        0.5 * face.height_m * w - v};
    bool in_view = true;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const double slope = std::max(edges[i].head<2>().norm(), 1e-12);
      const Eigen::Vector3d scaled = edges[i] / (slope * edge_width_px_);
      view.edges[i] = linear(scaled);
      // Largest at one of the image's corners.
      const double largest = std::max(0.0, scaled.x()) * (camera_.size.width - 1) +
                             std::max(0.0, scaled.y()) * (camera_.size.height - 1) + scaled.z();
      in_view = in_view && largest > -0.5;
    }
    if (!in_view) continue;
    const cv::Mat1f& finest = face.levels[0].texels;
    const double texels_per_m = 1.0 / texel_m_;
    const Eigen::Vector3d u_texel = texels_per_m * u + 0.5 * finest.cols * w;
    const Eigen::Vector3d v_texel = texels_per_m * v + 0.5 * finest.rows * w;
    Eigen::Matrix3d homography;
    homography << u_texel.transpose(), v_texel.transpose(), w.transpose();
    view.u = linear(u_texel);
    view.v = linear(v_texel);
    view.w = linear(w);
    view.area = static_cast<float>(std::abs(homography.determinant()) /
                                   (kLevelTexelsPerPixel * kLevelTexelsPerPixel));
    views.push_back(view);
  }
  return views;
}

void FaceRenderer::drawRow(const FaceView& view, int y, BodyRow& row) const {
  // The pixels between the four edges.
  double first = 0.0;
  double last = camera_.size.width - 1;
  for (const LinearFunction& edge : view.edges) {
    // x such that the distance is above -0.5.
    const double rest = edge.y * y + edge.one + 0.5;
    if (edge.x > 0.0) {
      first = std::max(first, -rest / edge.x);
    } else if (edge.x < 0.0) {
      last = std::min(last, -rest / edge.x);
    } else if (rest <= 0.0) {
      return;
    }
  }
  if (!(first <= last)) return;
  const int begin = static_cast<int>(std::ceil(first));
  const int end = static_cast<int>(std::floor(last)) + 1;
  if (begin >= end) return;

  const int count = end - begin;
  float* u = row.u.data();
  float* v = row.v.data();
  float* level = row.level.data();
  float* inside = row.inside.data();
  const double row_y = y;
  const auto start = [&](const LinearFunction& f) {
    return static_cast<float>(f.x * begin + f.y * row_y + f.one);
  };
  const std::array<float, 4> edge{start(view.edges[0]), start(view.edges[1]), start(view.edges[2]),
                                  start(view.edges[3])};
  const std::array<float, 4> slope{view.edges[0].slope(), view.edges[1].slope(),
                                   view.edges[2].slope(), view.edges[3].slope()};
  const float u0 = start(view.u);
  const float v0 = start(view.v);
  const float w0 = start(view.w);
  const float du = view.u.slope();
  const float dv = view.v.slope();
  const float dw = view.w.slope();
  const float area = view.area;
  const auto coarsest = static_cast<float>(kTextureLevels - 1);
  for (int i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i);
    const float w = std::max(w0 + dw * x, kSmallestInverseDepth);
    const float depth = 1.0F / w;
    u[i] = (u0 + du * x) * depth;
    v[i] = (v0 + dv * x) * depth;
    // Texels in a pixel are the homography's Jacobian; levels go with its square root.
    const float exact = 0.5F * quickLog2(area * depth * depth * depth);
    level[i] = std::min(std::max(exact, 0.0F), coarsest);
    const float a = std::min(edge[0] + slope[0] * x, edge[1] + slope[1] * x);
    const float b = std::min(edge[2] + slope[2] * x, edge[3] + slope[3] * x);
    inside[i] = std::min(std::max(std::min(a, b) + 0.5F, 0.0F), 1.0F);
  }

  const auto sample = [](const FaceView::Samples& at, float u_finest, float v_finest) {
    const float tu = std::min(std::max(u_finest * at.u_scale - 0.5F, 0.0F), at.last_u);
    const float tv = std::min(std::max(v_finest * at.v_scale - 0.5F, 0.0F), at.last_v);
    const int column = static_cast<int>(tu);
    const int line = static_cast<int>(tv);
    const float right = tu - static_cast<float>(column);
    const float below = tv - static_cast<float>(line);
    const float* upper = at.texels + line * at.stride + column;
    const float* lower = upper + at.stride;
    const float top = upper[0] + right * (upper[1] - upper[0]);
    const float bottom = lower[0] + right * (lower[1] - lower[0]);
    return top + below * (bottom - top);
  };
  float* light = row.light.data() + begin;
  float* cover = row.cover.data() + begin;
  for (int i = 0; i < count; ++i) {
    const int fine = std::min(static_cast<int>(level[i]), kTextureLevels - 2);
    const float part = level[i] - static_cast<float>(fine);
    const FaceView::Samples* at = view.levels.data() + fine;
    const float near = sample(at[0], u[i], v[i]);
    const float far = part > 0.0F ? sample(at[1], u[i], v[i]) : near;
    light[i] += inside[i] * (near + part * (far - near));
    cover[i] += inside[i];
  }
  row.begin = std::min(row.begin, begin);
  row.end = std::max(row.end, end);
}

}  // namespace fast_edi
