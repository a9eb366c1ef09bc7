#include "scenes/room_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <boost/random/uniform_real_distribution.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/random.hpp"
#include "scenes/texture.hpp"

namespace fast_edi {
namespace {

/// Luminance of linear RGB (ITU-R BT.709).
const cv::Matx13d kLuminance(0.2126, 0.7152, 0.0722);
/// Stickers on furniture are smaller than those on walls.
constexpr double kFurnitureScale = 0.5;

/// Adds bodies and textures from one sequence of random numbers.
class RoomBuilder {
 public:
  RoomBuilder(const RoomSettings& room, const SceneSettings& scene, std::uint64_t seed)
      : room_(room), scene_(scene), random_(makeRandomEngine(seed, RandomStream::kRoom)) {}

  TexturedBody walls();
  std::vector<TexturedBody> furniture();

 private:
  void addFace(double poster_px_m, TexturedFace face, TexturedBody& body);
  cv::Mat1f drawFace(double width_m, double height_m, double poster_px_m);

  const RoomSettings& room_;
  const SceneSettings& scene_;
  RandomEngine random_;
};

TexturedBody RoomBuilder::walls() {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const double length = room_.length_m;
  const double width = room_.width_m;
  const double height = room_.height_m;
  TexturedBody body;
  body.centre = 0.5 * height * z;
  const auto add = [&](const Eigen::Vector3d& outwards, const Eigen::Vector3d& u, double width_m,
                       double height_m) {
    // Seen from within: u to the right, v down, the normal inwards.
    const Eigen::Vector3d reach =
        outwards.cwiseProduct(0.5 * Eigen::Vector3d(length, width, height));
    addFace(room_.poster_px_m, {body.centre + reach, u, outwards.cross(u), width_m, height_m, {}},
            body);
  };
  add(x, -y, width, height);
  add(-x, y, width, height);
  add(y, x, length, height);
  add(-y, -x, length, height);
  add(z, x, length, width);
  add(-z, x, length, width);
  return body;
}

std::vector<TexturedBody> RoomBuilder::furniture() {
  std::vector<TexturedBody> bodies;
  const auto uniform = [this](double low, double high) {
    return boost::random::uniform_real_distribution<double>(low, high)(random_);
  };
  const auto add = [&](double x, double y, double side_m, double height_m, bool to_ceiling) {
    const double turn = uniform(-0.5, 0.5);
    const Eigen::Vector3d along(std::cos(turn), std::sin(turn), 0.0);
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    TexturedBody body;
    body.centre = {x + uniform(-0.15, 0.15), y + uniform(-0.15, 0.15), 0.5 * height_m};
    const double px_m = kFurnitureScale * room_.poster_px_m;
    for (const Eigen::Vector3d& outwards :
         {along, Eigen::Vector3d(-along), Eigen::Vector3d(up.cross(along)),
          Eigen::Vector3d(along.cross(up))}) {
      // u to the right of who looks at it, v down, the normal outwards.
      const Eigen::Vector3d u = up.cross(outwards);
      addFace(px_m, {body.centre + 0.5 * side_m * outwards, u, -up, side_m, height_m, {}}, body);
    }
    if (!to_ceiling) {
      addFace(px_m, {body.centre + 0.5 * height_m * up, along, along.cross(up), side_m, side_m, {}},
              body);
    }
    bodies.push_back(std::move(body));
  };
  // Pillars near the corners, boxes at the walls: none hides another from within the lap.
  const double corner_x = 0.5 * room_.length_m - 0.75;
  const double corner_y = 0.5 * room_.width_m - 0.75;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      add(sx * corner_x, sy * corner_y, uniform(0.3, 0.45), room_.height_m, true);
    }
  }
  const double wall_x = 0.5 * room_.length_m - 0.55;
  const double wall_y = 0.5 * room_.width_m - 0.55;
  for (const double sign : {-1.0, 1.0}) {
    for (const bool end_wall : {true, false}) {
      // One by one: compilers choose the order in which arguments are evaluated.
      const double height_m = uniform(0.5, 1.1);
      const double side_m = uniform(0.4, 0.6);
      if (end_wall) {
        add(sign * wall_x, uniform(-0.5, 0.5), side_m, height_m, false);
      } else {
        add(uniform(-0.7, 0.7), sign * wall_y, side_m, height_m, false);
      }
    }
  }
  return bodies;
}

/// Adds a face with its texture. \param poster_px_m side of a texture's pixel on the face
void RoomBuilder::addFace(double poster_px_m, TexturedFace face, TexturedBody& body) {
  const cv::Mat1f finest = drawFace(face.width_m, face.height_m, poster_px_m);
  for (int level = 0; level < kTextureLevels; ++level) {
    const double shrink = 1.0 / (1 << level);
    const cv::Size size(std::max(2, cvRound(finest.cols * shrink)),
                        std::max(2, cvRound(finest.rows * shrink)));
    TextureLevel next;
    cv::resize(finest, next.texels, size, 0.0, 0.0, cv::INTER_AREA);
    if (scene_.optics_sigma_px > 0.0) {
      cv::GaussianBlur(next.texels, next.texels, cv::Size(),
                       scene_.optics_sigma_px * kLevelTexelsPerPixel);
    }
    next.u_scale = static_cast<float>(size.width) / static_cast<float>(finest.cols);
    next.v_scale = static_cast<float>(size.height) / static_cast<float>(finest.rows);
    face.levels.push_back(next);
  }
  body.faces.push_back(std::move(face));
}

/// Radiance of a face, with room_.texel_m between texels.
cv::Mat1f RoomBuilder::drawFace(double width_m, double height_m, double poster_px_m) {
  // A texel more than the face on each side.
  const auto cover = [&](double side_m) {
    return static_cast<int>(std::ceil((side_m + 2.0 * room_.texel_m) / poster_px_m)) + 1;
  };
  const cv::Size size_px(cover(width_m), cover(height_m));
  const double scale = poster_px_m / room_.texel_m;
  RandomEngine face_random(random_());
  const cv::Mat3f canvas =
      scene_.texture_file.empty()
          ? drawTexture(scene_.texture, size_px, scale, scene_.density, {}, face_random)
          : loadTexture(scene_.texture_file, size_px, {size_px.width, size_px.height}, scale);
  cv::Mat1f finest;
  cv::transform(canvas, finest, kLuminance);
  cv::min(finest, kMaxReflectance, finest);
  cv::max(finest, kMinReflectance, finest);
  finest *= scene_.illumination;
  return finest;
}

}  // namespace

RoomBodies makeRoomBodies(const RoomSettings& room, const SceneSettings& scene,
                          std::uint64_t seed) {
  RoomBuilder builder(room, scene, seed);
  RoomBodies bodies;
  bodies.walls = builder.walls();
  bodies.furniture = builder.furniture();
  return bodies;
}

}  // namespace fast_edi
