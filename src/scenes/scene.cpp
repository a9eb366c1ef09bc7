#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>

#include <boost/random/uniform_real_distribution.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/texture.hpp"

namespace fast_edi {
namespace {

/// Shapes are drawn at this many elements per texel and side, then averaged.
constexpr int kSupersampling = 2;
/// Luminance of linear RGB (ITU-R BT.709).
constexpr double kRed = 0.2126;
constexpr double kGreen = 0.7152;
constexpr double kBlue = 0.0722;
/// Reflectance around which the contrast is scaled.
constexpr double kMidGrey = 0.4;

}  // namespace

Scene::Scene(const SceneSettings& settings, SensorSize view, ColourFilter filter,
             std::uint64_t seed)
    : settings_(settings), view_(view) {
  RandomEngine tag_random = makeRandomEngine(seed, RandomStream::kTags);
  tags_ = placeTags(settings.tags, settings.tag_side_px, view, tag_random);

  const cv::Size size_px(view.width + 2 * kMarginPx, view.height + 2 * kMarginPx);
  constexpr double kScale = kTexelsPerPixel * kSupersampling;
  RandomEngine texture_random = makeRandomEngine(seed, RandomStream::kTexture);
  cv::Mat3f canvas =
      settings.texture_file.empty()
          ? drawTexture(settings.texture, size_px, kScale, settings.density, tags_, texture_random)
          : loadTexture(settings.texture_file, size_px, view, kScale);
  for (const PlacedTag& tag : tags_) drawTag(tag, kScale, canvas);

  cv::Mat3f texels;
  cv::resize(canvas, texels, size_px * kTexelsPerPixel, 0.0, 0.0, cv::INTER_AREA);
  cv::min(texels, cv::Scalar::all(kMaxReflectance), texels);
  cv::max(texels, cv::Scalar::all(kMinReflectance), texels);
  if (settings.contrast != 1.0) {
    // log r -> log m + contrast (log r - log m)
    cv::pow(texels / kMidGrey, settings.contrast, texels);
    texels *= kMidGrey;
    cv::min(texels, cv::Scalar::all(kMaxReflectance), texels);
  }
  drawLamps(seed, texels);
  if (settings.optics_sigma_px > 0.0) {
    cv::GaussianBlur(texels, texels, cv::Size(), settings.optics_sigma_px * kTexelsPerPixel);
  }
  texels *= settings.illumination;

  if (filter == ColourFilter::kNone) {
    cv::transform(texels, planes_[0], cv::Matx13d(kRed, kGreen, kBlue));
  } else {
    cv::split(texels, planes_.data());
    photosites_ = {{{0, 1}, {1, 2}}};  // RGGB
  }
}

void Scene::drawLamps(std::uint64_t seed, cv::Mat3f& texels) const {
  RandomEngine random = makeRandomEngine(seed, RandomStream::kLamps);
  boost::random::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int lamp = 0; lamp < settings_.lamps; ++lamp) {
    const double x = kMarginPx + view_.width * unit(random);
    const double y = kMarginPx + view_.height * unit(random);
    cv::circle(
        texels,
        cv::Point(static_cast<int>(x * kTexelsPerPixel), static_cast<int>(y * kTexelsPerPixel)),
        static_cast<int>(std::lround(settings_.lamp_radius_px * kTexelsPerPixel)),
        cv::Scalar::all(settings_.lamp_radiance / settings_.illumination), cv::FILLED);
  }
}

double Scene::lightAt(std::int64_t t_ns) const {
  if (settings_.flicker_hz <= 0.0) return 1.0;
  // The phase is reduced in integers first: nanoseconds since 1970 exceed the precision of double.
  const double period_ns = kNanosecondsPerSecond / settings_.flicker_hz;
  const std::int64_t whole_seconds = t_ns / kNanosecondsPerSecond;
  const double fraction_ns = static_cast<double>(t_ns % kNanosecondsPerSecond);
  const double cycles = std::fmod(static_cast<double>(whole_seconds) * settings_.flicker_hz, 1.0) +
                        fraction_ns / period_ns;
  return 1.0 + settings_.flicker_depth * std::sin(2.0 * CV_PI * cycles);
}

void Scene::render(const cv::Matx33d& image_to_plane, std::int64_t t_ns,
                   cv::Mat1f& irradiance) const {
  irradiance.create(view_.height, view_.width);
  const int columns = planes_[0].cols;
  const int rows = planes_[0].rows;
  // Plane px to texel index; the plane's origin is the centre of the texel array.
  const cv::Matx33d plane_to_texel(kTexelsPerPixel, 0.0, 0.5 * columns - 0.5,  //
                                   0.0, kTexelsPerPixel, 0.5 * rows - 0.5,     //
                                   0.0, 0.0, 1.0);
  const cv::Matx33d h = plane_to_texel * image_to_plane;
  const auto light = static_cast<float>(lightAt(t_ns));
  // Just below the last texel, so that its right and lower neighbours always exist.
  const double last_u = columns - 1 - 1e-3;
  const double last_v = rows - 1 - 1e-3;

  std::vector<float> u_row(static_cast<std::size_t>(view_.width));
  std::vector<float> v_row(static_cast<std::size_t>(view_.width));
  for (int y = 0; y < view_.height; ++y) {
    for (int x = 0; x < view_.width; ++x) {
      const double w = 1.0 / (h(2, 0) * x + h(2, 1) * y + h(2, 2));
      const double u = (h(0, 0) * x + h(0, 1) * y + h(0, 2)) * w;
      const double v = (h(1, 0) * x + h(1, 1) * y + h(1, 2)) * w;
      u_row[static_cast<std::size_t>(x)] = static_cast<float>(std::clamp(u, 0.0, last_u));
      v_row[static_cast<std::size_t>(x)] = static_cast<float>(std::clamp(v, 0.0, last_v));
    }
    const auto& sites = photosites_[static_cast<std::size_t>(y & 1)];
    const cv::Mat1f& even = planes_[static_cast<std::size_t>(sites[0])];
    const cv::Mat1f& odd = planes_[static_cast<std::size_t>(sites[1])];
    float* out = irradiance[y];
    for (int x = 0; x < view_.width; ++x) {
      const float u = u_row[static_cast<std::size_t>(x)];
      const float v = v_row[static_cast<std::size_t>(x)];
      const int column = static_cast<int>(u);
      const int row = static_cast<int>(v);
      const float right = u - static_cast<float>(column);
      const float below = v - static_cast<float>(row);
      const cv::Mat1f& plane = (x & 1) != 0 ? odd : even;
      const float* upper = plane[row] + column;
      const float* lower = plane[row + 1] + column;
      const float top = upper[0] + right * (upper[1] - upper[0]);
      const float bottom = lower[0] + right * (lower[1] - lower[0]);
      out[x] = light * (top + below * (bottom - top));
    }
  }
}

}  // namespace fast_edi
