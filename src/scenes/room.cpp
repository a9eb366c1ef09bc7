#include "scenes/room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <boost/random/uniform_real_distribution.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/texture.hpp"

namespace fast_edi {
namespace {

/// Luminance of linear RGB (ITU-R BT.709).
const cv::Matx13d kLuminance(0.2126, 0.7152, 0.0722);
/// A pixel is given the level at which it covers this many texels on a side.
constexpr double kTexelsPerPixel = 2.0;
constexpr int kLevels = 6;
/// Stickers on furniture are smaller than those on walls.
constexpr double kFurnitureScale = 0.5;
/// A face closer to being seen edge-on than this shows nothing [m].
constexpr double kEdgeOnM = 1e-4;
/// Inverse depth of what lies before the camera is held above this [1/m].
constexpr float kSmallestInverseDepth = 1e-3F;
/// A uniform blur of this width has unit standard deviation.
const double kUniformWidth = std::sqrt(12.0);

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

struct Room::View {
  /// One of those functions.
  struct Linear {
    double x;
    double y;
    double one;
    float slope() const { return static_cast<float>(x); }
  };

  /// A level as the sampling loop reads it.
  struct Samples {
    const float* texels;
    std::ptrdiff_t stride;
    float u_scale;
    float v_scale;
    float last_u;  ///< just before the last texel, so that its right and lower neighbours exist
    float last_v;
  };

  std::array<Samples, kLevels> levels;
  Linear u;  ///< texel of the finest level times w
  Linear v;
  Linear w;    ///< inverse depth [1/m]
  float area;  ///< of a pixel at inverse depth 1, in levels' finest texels per side, squared
  std::array<Linear, 4> edges;  ///< distance into the face from each side [edge widths]
};

struct Room::Row {
  explicit Row(std::size_t width)
      : light(width), cover(width), u(width), v(width), level(width), inside(width) {}
  std::vector<float> light;  ///< of the body's faces, by their cover
  std::vector<float> cover;  ///< part of the pixel that the body fills
  int begin = 0;             ///< pixels that were touched
  int end = 0;
  // Of one face.
  std::vector<float> u;
  std::vector<float> v;
  std::vector<float> level;
  std::vector<float> inside;
};

Room::Room(const RoomSettings& settings, const SceneSettings& scene, SensorSize view,
           double focal_length_px, std::uint64_t seed)
    : settings_(settings),
      size_(view),
      focal_length_px_(focal_length_px),
      edge_width_px_(std::max(1.0, kUniformWidth * scene.optics_sigma_px)) {
  RandomEngine random = makeRandomEngine(seed, RandomStream::kRoom);
  addWalls(scene, random);
  addFurniture(scene, random);
}

void Room::addWalls(const SceneSettings& scene, RandomEngine& random) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double length = settings_.length_m;
  const double width = settings_.width_m;
  const double height = settings_.height_m;
  walls_.centre = 0.5 * height * z;
  const auto add = [&](const Eigen::Vector3d& outwards, const Eigen::Vector3d& u, double width_m,
                       double height_m) {
    // Seen from within: u to the right, v down, the normal inwards.
    const Eigen::Vector3d reach =
        outwards.cwiseProduct(0.5 * Eigen::Vector3d(length, width, height));
    addFace(scene, settings_.poster_px_m, random,
            {walls_.centre + reach, u, outwards.cross(u), width_m, height_m, {}}, walls_);
  };
  add(x, -y, width, height);
  add(-x, y, width, height);
  add(y, x, length, height);
  add(-y, -x, length, height);
  add(z, x, length, width);
  add(-z, x, length, width);
}

void Room::addFurniture(const SceneSettings& scene, RandomEngine& random) {
  const auto uniform = [&random](double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(random);
  };
  const auto add = [&](double x, double y, double side_m, double height_m, bool to_ceiling) {
    const double turn = uniform(-0.5, 0.5);
    const Eigen::Vector3d along(std::cos(turn), std::sin(turn), 0.0);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    Body body;
    body.centre = {x + uniform(-0.15, 0.15), y + uniform(-0.15, 0.15), 0.5 * height_m};
    const double px_m = kFurnitureScale * settings_.poster_px_m;
    for (const Eigen::Vector3d& outwards :
         {along, Eigen::Vector3d(-along), Eigen::Vector3d(up.cross(along)),
          Eigen::Vector3d(along.cross(up))}) {
      // u to the right of who looks at it, v down, the normal outwards.
      const Eigen::Vector3d u = up.cross(outwards);
      addFace(scene, px_m, random,
              {body.centre + 0.5 * side_m * outwards, u, -up, side_m, height_m, {}}, body);
    }
    if (!to_ceiling) {
      addFace(scene, px_m, random,
              {body.centre + 0.5 * height_m * up, along, along.cross(up), side_m, side_m, {}},
              body);
    }
    furniture_.push_back(std::move(body));
  };
  // Pillars near the corners, boxes at the walls: none hides another from within the lap.
  const double corner_x = 0.5 * settings_.length_m - 0.75;
  const double corner_y = 0.5 * settings_.width_m - 0.75;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      add(sx * corner_x, sy * corner_y, uniform(0.3, 0.45), settings_.height_m, true);
    }
  }
  const double wall_x = 0.5 * settings_.length_m - 0.55;
  const double wall_y = 0.5 * settings_.width_m - 0.55;
  for (const double sign : {-1.0, 1.0}) {
    add(sign * wall_x, uniform(-0.5, 0.5), uniform(0.4, 0.6), uniform(0.5, 1.1), false);
    add(uniform(-0.7, 0.7), sign * wall_y, uniform(0.4, 0.6), uniform(0.5, 1.1), false);
  }
}

void Room::addFace(const SceneSettings& scene, double poster_px_m, RandomEngine& random, Face face,
                   Body& body) const {
  // A texel more than the face on each side.
  const auto cover = [&](double side_m) {
    return static_cast<int>(std::ceil((side_m + 2.0 * settings_.texel_m) / poster_px_m)) + 1;
  };
  const cv::Size size_px(cover(face.width_m), cover(face.height_m));
  const double scale = poster_px_m / settings_.texel_m;
  RandomEngine face_random(random());
  const cv::Mat3f canvas =
      scene.texture_file.empty()
          ? drawTexture(scene.texture, size_px, scale, scene.density, {}, face_random)
          : loadTexture(scene.texture_file, size_px, {size_px.width, size_px.height}, scale);
  cv::Mat1f finest;
  cv::transform(canvas, finest, kLuminance);
  cv::min(finest, kMaxReflectance, finest);
  cv::max(finest, kMinReflectance, finest);
  finest *= scene.illumination;
  for (int level = 0; level < kLevels; ++level) {
    const double shrink = 1.0 / (1 << level);
    const cv::Size size(std::max(2, cvRound(finest.cols * shrink)),
                        std::max(2, cvRound(finest.rows * shrink)));
    Level next;
    cv::resize(finest, next.texels, size, 0.0, 0.0, cv::INTER_AREA);
    if (scene.optics_sigma_px > 0.0) {
      cv::GaussianBlur(next.texels, next.texels, cv::Size(),
                       scene.optics_sigma_px * kTexelsPerPixel);
    }
    next.u_scale = static_cast<float>(size.width) / static_cast<float>(finest.cols);
    next.v_scale = static_cast<float>(size.height) / static_cast<float>(finest.rows);
    face.levels.push_back(next);
  }
  body.faces.push_back(std::move(face));
}

Eigen::Vector3d Room::rayOf(const cv::Point2d& pixel) const {
  return {(pixel.x - 0.5 * (size_.width - 1)) / focal_length_px_,
          (pixel.y - 0.5 * (size_.height - 1)) / focal_length_px_, 1.0};
}

cv::Point2d Room::project(const Eigen::Vector3d& point) const {
  return {focal_length_px_ * point.x() / point.z() + 0.5 * (size_.width - 1),
          focal_length_px_ * point.y() / point.z() + 0.5 * (size_.height - 1)};
}

double Room::depthAt(const RigidPose& pose, const cv::Point2d& pixel) const {
  const Eigen::Vector3d ray = pose.orientation * rayOf(pixel);
  double nearest = std::numeric_limits<double>::infinity();
  const auto meet = [&](const Face& face) {
    const Eigen::Vector3d normal = face.v.cross(face.u);
    const double approach = normal.dot(ray);
    if (approach >= 0.0) return;
    const double depth = normal.dot(face.centre - pose.position) / approach;
    const Eigen::Vector3d at = pose.position + depth * ray - face.centre;
    if (depth > 0.0 && std::abs(at.dot(face.u)) <= 0.5 * face.width_m &&
        std::abs(at.dot(face.v)) <= 0.5 * face.height_m) {
      nearest = std::min(nearest, depth);
    }
  };
  for (const Face& face : walls_.faces) meet(face);
  for (const Body& body : furniture_) {
    for (const Face& face : body.faces) meet(face);
  }
  return nearest;
}

std::vector<Room::View> Room::viewsOf(const Body& body, const RigidPose& pose) const {
  const Eigen::Matrix3d rotation = pose.orientation.toRotationMatrix();
  // Of a vector in the world: its scalar product with the ray of pixel (x, y).
  const auto along_ray = [&](const Eigen::Vector3d& vector) {
    const Eigen::Vector3d seen = rotation.transpose() * vector / focal_length_px_;
    return Eigen::Vector3d(seen.x(), seen.y(),
                           seen.z() * focal_length_px_ - 0.5 * (size_.width - 1) * seen.x() -
                               0.5 * (size_.height - 1) * seen.y());
  };
  const auto linear = [](const Eigen::Vector3d& vector) {
    return View::Linear{vector.x(), vector.y(), vector.z()};
  };
  std::vector<View> views;
  for (const Face& face : body.faces) {
    const Eigen::Vector3d normal = face.v.cross(face.u);
    const Eigen::Vector3d offset = pose.position - face.centre;
    const double distance = normal.dot(offset);
    if (distance < kEdgeOnM) continue;
    // The ray from the camera meets the plane at depth 1 / w, there at (u / w, v / w) from the
    // face's centre.
    const Eigen::Vector3d w = -along_ray(normal) / distance;
    const Eigen::Vector3d u = along_ray(face.u) + offset.dot(face.u) * w;
    const Eigen::Vector3d v = along_ray(face.v) + offset.dot(face.v) * w;
    View view{};
    for (std::size_t i = 0; i < view.levels.size(); ++i) {
      const Level& level = face.levels[i];
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
      const double largest = std::max(0.0, scaled.x()) * (size_.width - 1) +
                             std::max(0.0, scaled.y()) * (size_.height - 1) + scaled.z();
      in_view = in_view && largest > -0.5;
    }
    if (!in_view) continue;
    const cv::Mat1f& finest = face.levels[0].texels;
    const double texels_per_m = 1.0 / settings_.texel_m;
    const Eigen::Vector3d u_texel = texels_per_m * u + 0.5 * finest.cols * w;
    const Eigen::Vector3d v_texel = texels_per_m * v + 0.5 * finest.rows * w;
    Eigen::Matrix3d homography;
    homography << u_texel.transpose(), v_texel.transpose(), w.transpose();
    view.u = linear(u_texel);
    view.v = linear(v_texel);
    view.w = linear(w);
    view.area = static_cast<float>(std::abs(homography.determinant()) /
                                   (kTexelsPerPixel * kTexelsPerPixel));
    views.push_back(view);
  }
  return views;
}

void Room::drawRow(const View& view, int y, Row& row) const {
  // The pixels between the four edges.
  double first = 0.0;
  double last = size_.width - 1;
  for (const View::Linear& edge : view.edges) {
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
  const auto start = [&](const View::Linear& f) {
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
  const auto coarsest = static_cast<float>(kLevels - 1);
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

  const auto sample = [](const View::Samples& at, float u_finest, float v_finest) {
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
    const int fine = std::min(static_cast<int>(level[i]), kLevels - 2);
    const float part = level[i] - static_cast<float>(fine);
    const View::Samples* at = view.levels.data() + fine;
    const float near = sample(at[0], u[i], v[i]);
    const float far = part > 0.0F ? sample(at[1], u[i], v[i]) : near;
    light[i] += inside[i] * (near + part * (far - near));
    cover[i] += inside[i];
  }
  row.begin = std::min(row.begin, begin);
  row.end = std::max(row.end, end);
}

void Room::render(const RigidPose& pose, cv::Mat1f& irradiance) const {
  irradiance.create(size_.height, size_.width);
  std::vector<const Body*> by_distance;
  for (const Body& body : furniture_) by_distance.push_back(&body);
  const auto distance = [&pose](const Body& body) {
    return (body.centre - pose.position).head<2>().norm();
  };
  std::sort(by_distance.begin(), by_distance.end(),
            [&](const Body* a, const Body* b) { return distance(*a) > distance(*b); });
  const std::vector<View> walls = viewsOf(walls_, pose);
  std::vector<std::vector<View>> furniture;
  for (const Body* body : by_distance) {
    furniture.push_back(viewsOf(*body, pose));
    if (furniture.back().empty()) furniture.pop_back();
  }

  Row row(static_cast<std::size_t>(size_.width));
  for (int y = 0; y < size_.height; ++y) {
    float* out = irradiance[y];
    const auto draw = [&](const std::vector<View>& views) {
      row.begin = size_.width;
      row.end = 0;
      for (const View& view : views) drawRow(view, y, row);
    };
    const auto clear = [&row](std::size_t x) {
      row.light[x] = 0.0F;
      row.cover[x] = 0.0F;
    };
    draw(walls);
    // Where two walls meet their covers add up to 1, where three meet to about 1.
    for (int i = 0; i < size_.width; ++i) {
      const auto x = static_cast<std::size_t>(i);
      out[x] = row.light[x] / row.cover[x];
      clear(x);
    }
    for (const std::vector<View>& views : furniture) {
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
