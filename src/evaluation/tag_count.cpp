#include "fast_edi/evaluation/tag_count.hpp"

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include "fast_edi/evaluation/image_metrics.hpp"

namespace fast_edi {
namespace {

struct DestroyFamily {
  void operator()(apriltag_family_t* family) const { tag36h11_destroy(family); }
};
struct DestroyDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct DestroyDetections {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};

TagDetection toTagDetection(const apriltag_detection_t& found) {
  TagDetection tag;
  tag.id = found.id;
  tag.hamming = found.hamming;
  tag.decision_margin = found.decision_margin;
  tag.center = {found.c[0], found.c[1]};
  for (std::size_t corner = 0; corner < tag.corners.size(); ++corner) {
    tag.corners[corner] = {found.p[corner][0], found.p[corner][1]};
  }
  return tag;
}

}  // namespace

class TagDetector::Impl {
 public:
  Impl() : family_(tag36h11_create()), detector_(apriltag_detector_create()) {
    if (!family_ || !detector_) {
      throw std::runtime_error("libapriltag could not create a detector for family 36h11");
    }
    apriltag_detector_add_family(detector_.get(), family_.get());
    detector_->nthreads = 1;
    detector_->quad_decimate = 1.0F;
  }

  std::vector<TagDetection> detect(const cv::Mat& image) {
    // The library takes a non-const buffer but only reads it.
    image_u8_t view = {image.cols, image.rows, static_cast<int>(image.step[0]),
                       const_cast<std::uint8_t*>(image.data)};
    const std::unique_ptr<zarray_t, DestroyDetections> found(
        apriltag_detector_detect(detector_.get(), &view));
    std::vector<TagDetection> tags;
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(found.get(), i, &detection);
      tags.push_back(toTagDetection(*detection));
    }
    std::sort(tags.begin(), tags.end(), [](const TagDetection& a, const TagDetection& b) {
      return std::tie(a.id, a.center.x, a.center.y) < std::tie(b.id, b.center.x, b.center.y);
    });
    return tags;
  }

 private:
  // The detector refers to the family: destroyed first.
  std::unique_ptr<apriltag_family_t, DestroyFamily> family_;
  std::unique_ptr<apriltag_detector_t, DestroyDetector> detector_;
};

TagDetector::TagDetector() : impl_(std::make_unique<Impl>()) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const cv::Mat& image) const {
  requireMono8(image, "tag detection");
  return impl_->detect(image);
}

}  // namespace fast_edi
