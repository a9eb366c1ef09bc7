#include "measures/feature_matches.hpp"

#include <algorithm>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

#include "measures/image_metrics.hpp"
#include "measures/surf.hpp"

namespace fast_edi {
namespace {

constexpr float kRatio = 0.8F;
constexpr double kInlierDistancePx = 1.0;
constexpr double kConfidence = 0.99;
constexpr int kOrbFeatures = 2000;
constexpr float kSamePlacePx = 2.0F;

ImageFeatures describe(const cv::Mat& image, std::vector<cv::KeyPoint> points,
                       cv::Feature2D& descriptor) {
  ImageFeatures features;
  descriptor.compute(image, points, features.descriptors);
  cv::KeyPoint::convert(points, features.points);
  return features;
}

ImageFeatures detectAndDescribe(const cv::Mat& image, cv::Feature2D& method) {
  ImageFeatures features;
  std::vector<cv::KeyPoint> points;
  method.detectAndCompute(image, cv::noArray(), points, features.descriptors);
  cv::KeyPoint::convert(points, features.points);
  return features;
}

std::vector<cv::KeyPoint> detect(const cv::Mat& image, cv::Feature2D& detector) {
  std::vector<cv::KeyPoint> points;
  detector.detect(image, points);
  return points;
}

std::vector<cv::KeyPoint> mserRegions(const cv::Mat& image) {
  return detect(image, *cv::MSER::create());
}

/// Regions lie within each other. Under a descriptor of fixed size those of one centre are the same
/// feature, and the ratio test would throw all of them away.
std::vector<cv::KeyPoint> withoutConcentric(const std::vector<cv::KeyPoint>& regions) {
  std::vector<cv::KeyPoint> kept;
  for (const cv::KeyPoint& region : regions) {
    const bool seen = std::any_of(kept.begin(), kept.end(), [&](const cv::KeyPoint& other) {
      return cv::norm(other.pt - region.pt) < kSamePlacePx;
    });
    if (!seen) {
      kept.push_back(region);
    }
  }
  return kept;
}

std::vector<SurfPlace> mserPlaces(const cv::Mat& image) {
  std::vector<SurfPlace> places;
  for (const cv::KeyPoint& region : mserRegions(image)) {
    places.push_back({region.pt, region.size});
  }
  return places;
}

}  // namespace

const char* toString(FeatureMethod method) {
  switch (method) {
    case FeatureMethod::kSurf:
      return "SURF";
    case FeatureMethod::kFastBrisk:
      return "FAST+BRISK";
    case FeatureMethod::kMserSurf:
      return "MSER+SURF";
    case FeatureMethod::kMserOrb:
      return "MSER+ORB";
    case FeatureMethod::kBrisk:
      return "BRISK";
    case FeatureMethod::kOrb:
      return "ORB";
  }
  return "unknown";
}

bool needsDlib(FeatureMethod method) {
  return method == FeatureMethod::kSurf || method == FeatureMethod::kMserSurf;
}

ImageFeatures findFeatures(const cv::Mat& whole_or_part, FeatureMethod method) {
  requireMono8(whole_or_part, "feature detection");
  // OpenCV's BRISK takes other pixels for neighbours in an image with padding behind its rows.
  const cv::Mat image = whole_or_part.isContinuous() ? whole_or_part : whole_or_part.clone();
  switch (method) {
    case FeatureMethod::kSurf:
      return findSurf(image);
    case FeatureMethod::kFastBrisk:
      return describe(image, detect(image, *cv::FastFeatureDetector::create()),
                      *cv::BRISK::create());
    case FeatureMethod::kMserSurf:
      return describeSurf(image, mserPlaces(image));
    case FeatureMethod::kMserOrb:
      return describe(image, withoutConcentric(mserRegions(image)), *cv::ORB::create());
    case FeatureMethod::kBrisk:
      return detectAndDescribe(image, *cv::BRISK::create());
    case FeatureMethod::kOrb:
      return detectAndDescribe(image, *cv::ORB::create(kOrbFeatures));
  }
  return {};
}

MatchCounts matchFeatures(const ImageFeatures& first, const ImageFeatures& second) {
  constexpr std::size_t kNeighbours = 2;
  MatchCounts counts;
  counts.features_first = static_cast<int>(first.points.size());
  counts.features_second = static_cast<int>(second.points.size());
  if (first.points.empty() || second.points.size() < kNeighbours) {
    return counts;
  }
  const int norm = first.descriptors.type() == CV_32F ? cv::NORM_L2 : cv::NORM_HAMMING;
  std::vector<std::vector<cv::DMatch>> neighbours;
  cv::BFMatcher(norm).knnMatch(first.descriptors, second.descriptors, neighbours,
                               static_cast<int>(kNeighbours));
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  for (const std::vector<cv::DMatch>& pair : neighbours) {
    if (pair.size() == kNeighbours && pair[0].distance < kRatio * pair[1].distance) {
      from.push_back(first.points[static_cast<std::size_t>(pair[0].queryIdx)]);
      to.push_back(second.points[static_cast<std::size_t>(pair[0].trainIdx)]);
    }
  }
  counts.matches = static_cast<int>(from.size());
  if (counts.matches < kMinMatchesForModel) {
    return counts;
  }
  cv::Mat inliers;
  const cv::Mat model =
      cv::findFundamentalMat(from, to, cv::FM_RANSAC, kInlierDistancePx, kConfidence, inliers);
  // Without a model (matches of too few places) OpenCV leaves the mask uninitialised.
  counts.inliers = model.empty() ? 0 : cv::countNonZero(inliers);
  return counts;
}

}  // namespace fast_edi
