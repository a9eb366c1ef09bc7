#include "fast_edi/tags/tag_detector.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <tuple>

#include <apriltag/apriltag.h>

#include "tags/searched_pixels.hpp"

// Those of libapriltag before 3.2 (Debian 11, Ubuntu 20.04) do not say that they are C.
extern "C" {
#include <apriltag/tag16h5.h>
#include <apriltag/tag25h9.h>
#include <apriltag/tag36h11.h>
#include <apriltag/tagCircle21h7.h>
#include <apriltag/tagCircle49h12.h>
#include <apriltag/tagCustom48h12.h>
#include <apriltag/tagStandard41h12.h>
#include <apriltag/tagStandard52h13.h>
#if __has_include(<apriltag/tag36h10.h>)
#include <apriltag/tag36h10.h>
#define FAST_EDI_HAVE_TAG36H10
#endif
}

namespace fast_edi {
namespace {

struct FamilyFunctions {
  apriltag_family_t* (*create)();
  void (*destroy)(apriltag_family_t*);
};

/// In the order of kTagFamilies; nullptr where libapriltag is too old.
constexpr std::array<FamilyFunctions, kTagFamilies.size()> kFamilyFunctions = {{
    {tag36h11_create, tag36h11_destroy},
#ifdef FAST_EDI_HAVE_TAG36H10
    {tag36h10_create, tag36h10_destroy},
#else
    {nullptr, nullptr},
#endif
    {tag25h9_create, tag25h9_destroy},
    {tag16h5_create, tag16h5_destroy},
    {tagCircle21h7_create, tagCircle21h7_destroy},
    {tagCircle49h12_create, tagCircle49h12_destroy},
    {tagCustom48h12_create, tagCustom48h12_destroy},
    {tagStandard41h12_create, tagStandard41h12_destroy},
    {tagStandard52h13_create, tagStandard52h13_destroy},
}};

using FamilyPointer = std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)>;

struct DestroyDetector {
  void operator()(apriltag_detector_t* detector) const { apriltag_detector_destroy(detector); }
};
struct DestroyDetections {
  void operator()(zarray_t* detections) const { apriltag_detections_destroy(detections); }
};

/// libapriltag 3.2 brought the family 36h10 back, and had the fault of small frames mended.
#ifdef FAST_EDI_HAVE_TAG36H10
constexpr bool kNeedsManyPixels = false;
#else
constexpr bool kNeedsManyPixels = true;
#endif

constexpr int kMaxCorrectedBits = 2;
/// libapriltag finds quads in tiles of this side; fewer than a few of them hold no tag.
constexpr int kSmallestSidePx = 16;
/// libapriltag puts the centre of the top left pixel at (0.5, 0.5).
const cv::Point2d kPixelCentre(0.5, 0.5);

FamilyPointer createFamily(const std::string& name) {
  std::string known;
  for (std::size_t i = 0; i < kTagFamilies.size(); ++i) {
    if (name == kTagFamilies[i]) {
      if (kFamilyFunctions[i].create == nullptr) {
        throw std::invalid_argument("family: " + name +
                                    " needs libapriltag 3.2 or newer, this build has an older one");
      }
      FamilyPointer family(kFamilyFunctions[i].create(), kFamilyFunctions[i].destroy);
      if (!family) {
        throw std::runtime_error("libapriltag could not create the family " + name);
      }
      return family;
    }
    known += (known.empty() ? "" : ", ") + std::string(kTagFamilies[i]);
  }
  throw std::invalid_argument("family: found \"" + name + "\", expected one of: " + known);
}

/// Memory of libapriltag's table of codes with up to \p bits errors: three entries of 16 bytes for
/// each of them.
double tableBytes(const apriltag_family_t& family, int bits) {
  constexpr double kBytesPerWord = 3.0 * 16.0;
  const double n = family.nbits;
  double words = 1.0;
  words += bits >= 1 ? n : 0.0;
  words += bits >= 2 ? n * (n - 1.0) / 2.0 : 0.0;
  return kBytesPerWord * family.ncodes * words;
}

void checkSettings(const TagDetectorSettings& settings, const apriltag_family_t& family) {
  if (settings.corrected_bits < 0 || settings.corrected_bits > kMaxCorrectedBits) {
    throw std::invalid_argument("corrected_bits: found " + std::to_string(settings.corrected_bits) +
                                ", expected 0.." + std::to_string(kMaxCorrectedBits));
  }
  if (!(settings.decimate >= 1.0)) {
    throw std::invalid_argument("decimate: found " + std::to_string(settings.decimate) +
                                ", expected at least 1");
  }
  if (settings.threads < 1) {
    throw std::invalid_argument("threads: found " + std::to_string(settings.threads) +
                                ", expected at least 1");
  }
  const double bytes = tableBytes(family, settings.corrected_bits);
  if (bytes > TagDetector::kMaxTableBytes) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(),
                  "corrected_bits: %d need tables of %.1f GB for family %s, expected at most %.1f "
                  "GB: fewer bits",
                  settings.corrected_bits, bytes * 1e-9, settings.family.c_str(),
                  TagDetector::kMaxTableBytes * 1e-9);
    throw std::invalid_argument(text.data());
  }
}

cv::Point2d toPoint(const double (&at)[2]) {
  return cv::Point2d(at[0], at[1]) - kPixelCentre;
}

TagDetection toTagDetection(const apriltag_detection_t& found) {
  TagDetection tag;
  tag.id = found.id;
  tag.hamming = found.hamming;
  tag.decision_margin = found.decision_margin;
  tag.centre = toPoint(found.c);
  for (std::size_t corner = 0; corner < tag.corners.size(); ++corner) {
    tag.corners[corner] = toPoint(found.p[corner]);
  }
  return tag;
}

}  // namespace

class TagDetector::Impl {
 public:
  explicit Impl(const TagDetectorSettings& settings)
      : family_(createFamily(settings.family)), detector_(nullptr), threads_(settings.threads) {
    checkSettings(settings, *family_);
    detector_.reset(apriltag_detector_create());
    if (!detector_) {
      throw std::runtime_error("libapriltag could not create a detector");
    }
    apriltag_detector_add_family_bits(detector_.get(), family_.get(), settings.corrected_bits);
    if (family_->impl == nullptr) {
      throw std::runtime_error("libapriltag has no memory for the tables of family " +
                               settings.family);
    }
    detector_->nthreads = settings.threads;
    detector_->quad_decimate = static_cast<float>(settings.decimate);
  }

  std::vector<TagDetection> detect(const cv::Mat& image) {
    std::vector<TagDetection> tags;
    const double smallest = kSmallestSidePx * static_cast<double>(detector_->quad_decimate);
    if (image.cols < smallest || image.rows < smallest) {
      return tags;
    }
    cv::Mat searched = image;
    if (kNeedsManyPixels) {
      const double decimate = static_cast<double>(detector_->quad_decimate);
      searched = withEnoughRows(image, decimate);
      detector_->nthreads = threadsWithEnoughPixels(searched.size(), decimate, threads_);
    }
    // The library takes a non-const buffer but only reads it.
    image_u8_t view = {searched.cols, searched.rows, static_cast<int>(searched.step[0]),
                       const_cast<std::uint8_t*>(searched.data)};
    const std::unique_ptr<zarray_t, DestroyDetections> found(
        apriltag_detector_detect(detector_.get(), &view));
    for (int i = 0; i < zarray_size(found.get()); ++i) {
      apriltag_detection_t* detection = nullptr;
      zarray_get(found.get(), i, static_cast<void*>(&detection));
      tags.push_back(toTagDetection(*detection));
    }
    std::sort(tags.begin(), tags.end(), [](const TagDetection& a, const TagDetection& b) {
      return std::tie(a.id, a.centre.x, a.centre.y) < std::tie(b.id, b.centre.x, b.centre.y);
    });
    return tags;
  }

 private:
  // The detector refers to the family: destroyed first.
  FamilyPointer family_;
  std::unique_ptr<apriltag_detector_t, DestroyDetector> detector_;
  int threads_;
};

TagDetector::TagDetector(const TagDetectorSettings& settings)
    : impl_(std::make_unique<Impl>(settings)) {}
TagDetector::~TagDetector() = default;
TagDetector::TagDetector(TagDetector&&) noexcept = default;
TagDetector& TagDetector::operator=(TagDetector&&) noexcept = default;

std::vector<TagDetection> TagDetector::detect(const cv::Mat& image) const {
  if (image.empty() || image.type() != CV_8UC1) {
    throw std::invalid_argument("tag detection: expected an image of one channel of 8 bits");
  }
  return impl_->detect(image);
}

}  // namespace fast_edi
