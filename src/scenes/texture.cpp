#include "scenes/texture.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "scenes/texture_brushes.hpp"

namespace fast_edi {
namespace {

void fillPolygon(cv::Mat3f& canvas, const std::vector<cv::Point2d>& corners, const Colour& colour) {
  std::vector<cv::Point> points;
  for (const cv::Point2d& corner : corners) {
    points.emplace_back(static_cast<int>(std::lround(corner.x)),
                        static_cast<int>(std::lround(corner.y)));
  }
  cv::fillPoly(canvas, std::vector<std::vector<cv::Point>>{points}, colour);
}

cv::Point2d polar(const cv::Point2d& centre, double radius, double angle) {
  return centre + radius * cv::Point2d(std::cos(angle), std::sin(angle));
}

void fillDisc(cv::Mat3f& canvas, const cv::Point2d& centre, double radius, const Colour& colour) {
  cv::circle(canvas, cv::Point(cv::saturate_cast<int>(centre.x), cv::saturate_cast<int>(centre.y)),
             std::max(1, static_cast<int>(std::lround(radius))), colour, cv::FILLED);
}

// Stickers of the poster. Every one fits into a disc of the given radius.

void drawSiemensStar(cv::Mat3f& canvas, const cv::Point2d& centre, double radius,
                     RandomEngine& random) {
  constexpr int kSpokes = 9;
  fillDisc(canvas, centre, radius, Colour::all(0.62));
  const double turn = uniform(random, 0.0, CV_PI);
  for (int spoke = 0; spoke < kSpokes; ++spoke) {
    const double angle = turn + 2.0 * CV_PI * spoke / kSpokes;
    std::vector<cv::Point2d> wedge{centre};
    for (int i = 0; i <= 8; ++i) {
      wedge.push_back(polar(centre, 0.94 * radius, angle + CV_PI / kSpokes * i / 8.0));
    }
    fillPolygon(canvas, wedge, Colour::all(0.2));
  }
}

void drawRings(cv::Mat3f& canvas, const cv::Point2d& centre, double radius, RandomEngine& random) {
  const Colour dark = tinted(random, 0.2, 0.3);
  const Colour bright = tinted(random, 0.62, 0.15);
  constexpr int kRings = 5;
  for (int ring = 0; ring < kRings; ++ring) {
    fillDisc(canvas, centre, radius * (kRings - ring) / kRings, ring % 2 == 0 ? dark : bright);
  }
}

/// A ball lit from the upper left: shading without edges inside, one edge around.
void drawBall(cv::Mat3f& canvas, const cv::Point2d& centre, double radius, RandomEngine& random) {
  const Colour colour = tinted(random, 0.75, 0.35);
  const cv::Rect box =
      cv::Rect(cv::Point(static_cast<int>(centre.x - radius), static_cast<int>(centre.y - radius)),
               cv::Point(static_cast<int>(centre.x + radius) + 2,
                         static_cast<int>(centre.y + radius) + 2)) &
      cv::Rect(cv::Point(), canvas.size());
  for (int y = box.y; y < box.br().y; ++y) {
    for (int x = box.x; x < box.br().x; ++x) {
      const double u = (x - centre.x) / radius;
      const double v = (y - centre.y) / radius;
      const double r2 = u * u + v * v;
      if (r2 > 1.0) continue;
      // Lambert's law with the light at (-1, -1, 1.4) and some ambient light.
      const double facing = std::max(0.0, (-u - v + 1.4 * std::sqrt(1.0 - r2)) / 1.99);
      const double light = 0.22 + 0.78 * facing;
      canvas(y, x) =
          cv::Vec3f(static_cast<float>(colour[0] * light), static_cast<float>(colour[1] * light),
                    static_cast<float>(colour[2] * light));
    }
  }
}

void drawPolygonSticker(cv::Mat3f& canvas, const cv::Point2d& centre, double radius,
                        RandomEngine& random) {
  const int sides = uniformInt(random, 3, 6);
  const double turn = uniform(random, 0.0, 2.0 * CV_PI);
  const bool dark = uniformInt(random, 0, 1) == 0;
  const auto corners = [&](double size) {
    std::vector<cv::Point2d> points;
    for (int i = 0; i < sides; ++i) {
      points.push_back(polar(centre, size, turn + 2.0 * CV_PI * i / sides));
    }
    return points;
  };
  fillPolygon(canvas, corners(radius), tinted(random, dark ? 0.18 : 0.7, 0.3));
  fillPolygon(canvas, corners(0.6 * radius), tinted(random, dark ? 0.5 : 0.3, 0.3));
}

void drawLetter(cv::Mat3f& canvas, const cv::Point2d& centre, double radius, RandomEngine& random) {
  static constexpr char kLetters[] = "ABDEFKMRSX23579";
  constexpr int kLetterCount = static_cast<int>(sizeof(kLetters)) - 1;
  const std::string text(1, kLetters[uniformInt(random, 0, kLetterCount - 1)]);
  const bool inverse = uniformInt(random, 0, 1) == 0;
  const double side = 1.3 * radius;
  const double turn = uniform(random, -0.15, 0.15) + CV_PI / 4.0;
  std::vector<cv::Point2d> card;
  for (int i = 0; i < 4; ++i) {
    card.push_back(polar(centre, side / std::sqrt(2.0), turn + CV_PI / 2.0 * i));
  }
  fillPolygon(canvas, card, tinted(random, inverse ? 0.22 : 0.68, 0.2));
  const int thickness = std::max(1, static_cast<int>(std::lround(0.16 * radius)));
  int baseline = 0;
  const cv::Size unit = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 1.0, 1, &baseline);
  const double font_scale = 0.85 * radius / unit.height;
  const cv::Size extent =
      cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, font_scale, thickness, &baseline);
  cv::putText(canvas, text,
              cv::Point(static_cast<int>(centre.x) - extent.width / 2,
                        static_cast<int>(centre.y) + extent.height / 2),
              cv::FONT_HERSHEY_SIMPLEX, font_scale, Colour::all(inverse ? 0.7 : 0.18), thickness);
}

/// Six patches from dark to bright in equal steps of the log.
void drawGreyRamp(cv::Mat3f& canvas, const cv::Point2d& centre, double radius,
                  RandomEngine& random) {
  constexpr int kPatches = 6;
  constexpr double kDarkest = 0.14;
  constexpr double kRange = 5.0;
  const double turn = uniform(random, -0.4, 0.4);
  const cv::Point2d along = polar({}, 1.8 * radius / kPatches, turn);
  const cv::Point2d down = polar({}, 0.7 * radius, turn + CV_PI / 2.0);
  const cv::Point2d corner = centre - 0.5 * kPatches * along - 0.5 * down;
  for (int i = 0; i < kPatches; ++i) {
    const cv::Point2d at = corner + along * i;
    fillPolygon(canvas, {at, at + along, at + along + down, at + down},
                Colour::all(kDarkest * std::pow(kRange, i / (kPatches - 1.0))));
  }
}

bool nearTag(const cv::Point2d& plane_px, double radius_px, const std::vector<PlacedTag>& tags) {
  return std::any_of(tags.begin(), tags.end(), [&](const PlacedTag& tag) {
    return cv::norm(tag.centre - plane_px) <
           radius_px + 0.5 * std::sqrt(2.0) * kTagPaperFactor * tag.side_px;
  });
}

/// Bricks whose contrast stays below a usual contrast threshold: structure for the eye that costs
/// hardly any events.
void drawBricks(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  constexpr double kBrickWidthPx = 44.0;
  constexpr double kBrickHeightPx = 17.0;
  constexpr double kJointPx = 2.0;
  const Colour joint(0.52, 0.49, 0.46);
  canvas.setTo(joint);
  const int rows = static_cast<int>(canvas.rows / scale / kBrickHeightPx) + 1;
  const int columns = static_cast<int>(canvas.cols / scale / kBrickWidthPx) + 2;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const double x = (column - (row % 2 == 0 ? 0.5 : 1.0)) * kBrickWidthPx;
      const double y = row * kBrickHeightPx;
      const double shading = uniform(random, 1.04, 1.17);
      cv::rectangle(
          canvas,
          cv::Rect2d((x + kJointPx) * scale, y * scale, (kBrickWidthPx - kJointPx) * scale,
                     (kBrickHeightPx - kJointPx) * scale),
          joint * shading, cv::FILLED);
    }
  }
}

struct Sticker {
  using Draw = void (*)(cv::Mat3f&, const cv::Point2d&, double, RandomEngine&);
  Draw draw;
  cv::Point2d centre_px;
  double radius_px;
  RandomEngine random;
};

std::vector<Sticker> placeStickers(cv::Size size_px, double density,
                                   const std::vector<PlacedTag>& tags, RandomEngine& random) {
  static constexpr Sticker::Draw kKinds[] = {drawLetter, drawBall,        drawPolygonSticker,
                                             drawRings,  drawSiemensStar, drawGreyRamp};
  constexpr int kKindCount = static_cast<int>(sizeof(kKinds) / sizeof(kKinds[0]));
  constexpr double kPitchPx = 46.0;
  constexpr double kClearancePx = 4.0;
  const int columns = static_cast<int>(size_px.width / kPitchPx);
  const int rows = static_cast<int>(size_px.height / kPitchPx);
  std::vector<Sticker> stickers;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      // Every place has random numbers of its own, so that it does not depend on its neighbours.
      RandomEngine place(random());
      // One by one, here and below: compilers choose the order in which arguments are evaluated.
      const double shift_y = uniform(place, -5.0, 5.0);
      const double shift_x = uniform(place, -5.0, 5.0);
      const cv::Point2d centre((column + 0.5 - 0.5 * columns) * kPitchPx + shift_x,
                               (row + 0.5 - 0.5 * rows) * kPitchPx + shift_y);
      const double radius = uniform(place, 12.0, 20.0);
      const int kind = uniformInt(place, 0, kKindCount - 1);
      if (uniform(place, 0.0, 1.0) > density || nearTag(centre, radius + kClearancePx, tags)) {
        continue;
      }
      stickers.push_back({kKinds[kind], centre, radius, place});
    }
  }
  return stickers;
}

/// Soft shadows to the lower right of what sticks to the wall.
void drawShadows(cv::Mat3f& canvas, double scale, const std::vector<Sticker>& stickers,
                 const std::vector<PlacedTag>& tags) {
  constexpr double kDarkest = 0.4;
  constexpr double kSoftnessPx = 2.5;
  const cv::Point2d offset(2.5, 3.0);
  // One mask element for each px is fine enough for something soft.
  const cv::Size size_px(static_cast<int>(canvas.cols / scale),
                         static_cast<int>(canvas.rows / scale));
  const cv::Point2d origin = 0.5 * cv::Point2d(size_px.width, size_px.height) + offset;
  cv::Mat1f mask = cv::Mat1f::zeros(size_px);
  for (const Sticker& sticker : stickers) {
    cv::circle(mask, origin + sticker.centre_px, cvRound(0.85 * sticker.radius_px), 1.0,
               cv::FILLED);
  }
  for (const PlacedTag& tag : tags) {
    std::vector<cv::Point> points;
    for (const cv::Point2d& corner : tag.corners(kTagPaperFactor)) {
      points.push_back(origin + corner);
    }
    cv::fillConvexPoly(mask, points, 1.0);
  }
  cv::GaussianBlur(mask, mask, cv::Size(), kSoftnessPx);
  cv::Mat1f shadow;
  cv::resize(mask, shadow, canvas.size(), 0.0, 0.0, cv::INTER_LINEAR);
  shade(shadow, -kDarkest, canvas);
}

/// Light that falls off from the upper left to the lower right of the view.
void drawLightFalloff(cv::Mat3f& canvas, double scale) {
  const cv::Point2d lamp =
      0.5 * cv::Point2d(canvas.cols, canvas.rows) - cv::Point2d(70.0, 60.0) * scale;
  constexpr double kReachPx = 330.0;
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const double u = (x - lamp.x) / (kReachPx * scale);
      const double v = (y - lamp.y) / (kReachPx * scale);
      canvas(y, x) *= static_cast<float>(1.15 / (1.0 + u * u + v * v));
    }
  }
}

void drawPoster(cv::Mat3f& canvas, double scale, double density, const std::vector<PlacedTag>& tags,
                RandomEngine& random) {
  drawBricks(canvas, scale, random);
  shade(fractalNoise(canvas.size(), 160.0 * scale, 25.0 * scale, random), 0.05, canvas);
  const cv::Size size_px(static_cast<int>(canvas.cols / scale),
                         static_cast<int>(canvas.rows / scale));
  std::vector<Sticker> stickers = placeStickers(size_px, density, tags, random);
  drawShadows(canvas, scale, stickers, tags);
  const cv::Point2d origin = 0.5 * cv::Point2d(canvas.cols, canvas.rows);
  for (Sticker& sticker : stickers) {
    sticker.draw(canvas, origin + sticker.centre_px * scale, sticker.radius_px * scale,
                 sticker.random);
  }
  drawLightFalloff(canvas, scale);
}

void drawNatural(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  canvas.setTo(Colour::all(0.4));
  constexpr double kSmallestPx = 4.0;
  constexpr double kLargestPx = 70.0;
  const double area_px = canvas.total() / (scale * scale);
  // Radii distributed as r^-3 between the bounds: scale invariant (Lee, Mumford & Huang, 2001).
  const double mean_area = 2.0 * CV_PI * std::log(kLargestPx / kSmallestPx) /
                           (1.0 / (kSmallestPx * kSmallestPx) - 1.0 / (kLargestPx * kLargestPx));
  constexpr double kCoverage = 4.0;  // leaves 2 % of the ground uncovered
  const int leaves = static_cast<int>(kCoverage * area_px / mean_area);
  for (int i = 0; i < leaves; ++i) {
    const double u = uniform(random, 0.0, 1.0);
    const double a = 1.0 / (kSmallestPx * kSmallestPx);
    const double b = 1.0 / (kLargestPx * kLargestPx);
    const double radius = scale / std::sqrt(a + u * (b - a));
    const double y = uniform(random, 0.0, canvas.rows);
    const double x = uniform(random, 0.0, canvas.cols);
    const cv::Point2d centre(x, y);
    const Colour colour =
        tinted(random, std::exp(uniform(random, std::log(0.08), std::log(0.75))), 0.3);
    const double turn = uniform(random, 0.0, CV_PI);
    const double flatness = uniform(random, 0.5, 1.0);
    if (uniformInt(random, 0, 1) == 0) {
      cv::ellipse(canvas,
                  cv::RotatedRect(centre,
                                  cv::Size2f(static_cast<float>(2.0 * radius),
                                             static_cast<float>(2.0 * radius * flatness)),
                                  static_cast<float>(turn * 180.0 / CV_PI)),
                  colour, cv::FILLED);
    } else {
      const cv::Point2d along = polar({}, radius, turn);
      const cv::Point2d across = polar({}, radius * flatness, turn + CV_PI / 2.0);
      fillPolygon(canvas,
                  {centre - along - across, centre + along - across, centre + along + across,
                   centre - along + across},
                  colour);
    }
  }
  shade(fractalNoise(canvas.size(), 120.0 * scale, 2.0 * scale, random), 0.12, canvas);
}

void drawFlat(cv::Mat3f& canvas, double scale, RandomEngine& random) {
  canvas.setTo(Colour(0.5, 0.48, 0.46));
  shade(fractalNoise(canvas.size(), 120.0 * scale, 30.0 * scale, random), 0.03, canvas);
}

/// sRGB (IEC 61966-2-1) to linear reflectance.
float linearFromSrgb(int value) {
  const double srgb = value / 255.0;
  return static_cast<float>(srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4));
}

}  // namespace

cv::Mat3f drawTexture(TextureKind kind, cv::Size size_px, double scale, double density,
                      const std::vector<PlacedTag>& tags, RandomEngine& random) {
  cv::Mat3f canvas(static_cast<int>(size_px.height * scale),
                   static_cast<int>(size_px.width * scale));
  switch (kind) {
    case TextureKind::kPoster:
      drawPoster(canvas, scale, density, tags, random);
      break;
    case TextureKind::kNatural:
      drawNatural(canvas, scale, random);
      break;
    case TextureKind::kFlat:
      drawFlat(canvas, scale, random);
      break;
    case TextureKind::kMosaic:
      drawMosaic(canvas, scale, random);
      break;
    case TextureKind::kPage:
      drawPage(canvas, scale, random);
      break;
    case TextureKind::kClouds:
      drawClouds(canvas, scale, random);
      break;
    case TextureKind::kFacade:
      drawFacade(canvas, scale, random);
      break;
    case TextureKind::kWeave:
      drawWeave(canvas, scale, random);
      break;
  }
  return canvas;
}

cv::Mat3f loadTexture(const std::string& path, cv::Size size_px, SensorSize view, double scale) {
  const cv::Mat3b picture = cv::imread(path, cv::IMREAD_COLOR);
  if (picture.empty()) {
    throw std::runtime_error(path + ": expected a picture that OpenCV can read");
  }
  const cv::Size canvas_size(static_cast<int>(size_px.width * scale),
                             static_cast<int>(size_px.height * scale));
  const cv::Size view_size(static_cast<int>(view.width * scale),
                           static_cast<int>(view.height * scale));
  const double factor = std::max(static_cast<double>(view_size.width) / picture.cols,
                                 static_cast<double>(view_size.height) / picture.rows);
  cv::Mat3b scaled;
  cv::resize(picture, scaled,
             cv::Size(std::max(view_size.width, cvRound(picture.cols * factor)),
                      std::max(view_size.height, cvRound(picture.rows * factor))),
             0.0, 0.0, factor < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC);
  const cv::Rect crop((scaled.cols - view_size.width) / 2, (scaled.rows - view_size.height) / 2,
                      view_size.width, view_size.height);
  const int left = (canvas_size.width - view_size.width) / 2;
  const int top = (canvas_size.height - view_size.height) / 2;
  cv::Mat3b bordered;
  cv::copyMakeBorder(scaled(crop), bordered, top, canvas_size.height - view_size.height - top, left,
                     canvas_size.width - view_size.width - left, cv::BORDER_REFLECT);
  std::array<float, 256> linear{};
  for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = linearFromSrgb(static_cast<int>(i));
  cv::Mat3f canvas(canvas_size);
  for (int y = 0; y < canvas.rows; ++y) {
    for (int x = 0; x < canvas.cols; ++x) {
      const cv::Vec3b bgr = bordered(y, x);
      canvas(y, x) = cv::Vec3f(linear[bgr[2]], linear[bgr[1]], linear[bgr[0]]);
    }
  }
  return canvas;
}

}  // namespace fast_edi
