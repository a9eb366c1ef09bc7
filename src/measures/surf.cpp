#include "measures/surf.hpp"

#ifdef FAST_EDI_HAVE_DLIB
#include <dlib/array2d.h>
#include <dlib/image_keypoint.h>
#endif

#include "measures/capability.hpp"

namespace fast_edi {

#ifdef FAST_EDI_HAVE_DLIB

namespace {

constexpr int kSurfLength = 64;
constexpr double kSquarePerScale = 20.0;  // side of SURF's square at scale 1 [px]
// dlib's get_surf_points() samples every second pixel and wants a response of 30: some 20 points in
// a frame of 346x260, too few for a count to mean anything.
constexpr long kOctaves = 4;
constexpr long kIntervals = 6;
constexpr long kInitialStepPx = 1;
constexpr double kDetectionThreshold = 5.0;
constexpr double kBorderPerScale = 32.0;  // what dlib demands around a point, sampling included

dlib::array2d<unsigned char> toDlib(const cv::Mat& image) {
  dlib::array2d<unsigned char> copy(image.rows, image.cols);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      copy[y][x] = image.at<unsigned char>(y, x);
    }
  }
  return copy;
}

template <typename Descriptor>
void appendFeature(const dlib::vector<double, 2>& at, const Descriptor& descriptor,
                   ImageFeatures& features) {
  cv::Mat1f row(1, kSurfLength);
  for (int i = 0; i < kSurfLength; ++i) {
    row(0, i) = static_cast<float>(descriptor(i));
  }
  features.points.emplace_back(static_cast<float>(at.x()), static_cast<float>(at.y()));
  features.descriptors.push_back(row);
}

}  // namespace

ImageFeatures findSurf(const cv::Mat& image) {
  dlib::integral_image integral;
  integral.load(toDlib(image));
  dlib::hessian_pyramid pyramid;
  pyramid.build_pyramid(integral, kOctaves, kIntervals, kInitialStepPx);
  std::vector<dlib::interest_point> points;
  dlib::get_interest_points(pyramid, kDetectionThreshold, points);
  std::vector<SurfPlace> places;
  for (const dlib::interest_point& point : points) {
    places.push_back({{point.center.x(), point.center.y()}, kSquarePerScale * point.scale});
  }
  return describeSurf(image, places);
}

ImageFeatures describeSurf(const cv::Mat& image, const std::vector<SurfPlace>& places) {
  dlib::integral_image integral;
  integral.load(toDlib(image));
  ImageFeatures features;
  for (const SurfPlace& place : places) {
    const double scale = place.diameter / kSquarePerScale;
    const auto border = static_cast<unsigned long>(kBorderPerScale * scale);
    const dlib::vector<double, 2> centre(place.centre.x, place.centre.y);
    if (!dlib::get_rect(integral).contains(dlib::centered_rect(centre, border, border))) {
      continue;
    }
    const double angle = dlib::compute_dominant_angle(integral, centre, scale);
    dlib::matrix<double, kSurfLength, 1> descriptor;
    dlib::compute_surf_descriptor(integral, centre, scale, angle, descriptor);
    appendFeature(centre, descriptor, features);
  }
  return features;
}

#else

ImageFeatures findSurf(const cv::Mat&) {
  require(OptionalLibrary::kDlib, "SURF");
  return {};
}

ImageFeatures describeSurf(const cv::Mat&, const std::vector<SurfPlace>&) {
  require(OptionalLibrary::kDlib, "SURF");
  return {};
}

#endif

}  // namespace fast_edi
