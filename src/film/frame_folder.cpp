#include "film/frame_folder.hpp"

#include <cstdio>
#include <filesystem>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

constexpr char kListName[] = "frames.csv";
constexpr int kAsItIs = -1;

struct PngPixels {
  int type = 0;
  int conversion = kAsItIs;  ///< to OpenCV's order, a code of cv::cvtColor
};

std::optional<PngPixels> pngPixels(const std::string& encoding) {
  if (encoding == "mono16" ||
      (encoding.rfind("bayer_", 0) == 0 && encoding.find("16") != std::string::npos)) {
    return PngPixels{CV_16UC1};
  }
  if (encoding == "mono8" || encoding == "8UC1" || encoding.rfind("bayer_", 0) == 0) {
    return PngPixels{CV_8UC1};
  }
  if (encoding == "bgr8") {
    return PngPixels{CV_8UC3};
  }
  if (encoding == "rgb8") {
    return PngPixels{CV_8UC3, cv::COLOR_RGB2BGR};
  }
  if (encoding == "bgra8") {
    return PngPixels{CV_8UC4};
  }
  if (encoding == "rgba8") {
    return PngPixels{CV_8UC4, cv::COLOR_RGBA2BGRA};
  }
  if (encoding == "bgr16") {
    return PngPixels{CV_16UC3};
  }
  if (encoding == "rgb16") {
    return PngPixels{CV_16UC3, cv::COLOR_RGB2BGR};
  }
  return std::nullopt;
}

/// The image's pixels, in memory of their own where they must be aligned or converted.
cv::Mat pixelsOf(const sensor_msgs::Image& image, const PngPixels& png) {
  const auto width = static_cast<int>(image.width);
  const auto height = static_cast<int>(image.height);
  cv::Mat pixels(height, width, png.type);
  const std::size_t row_bytes = pixels.elemSize() * static_cast<std::size_t>(width);
  for (int y = 0; y < height; ++y) {
    const std::uint8_t* row = image.data.data() + static_cast<std::size_t>(y) * image.step;
    std::copy(row, row + row_bytes, pixels.ptr(y));
  }
  if (png.conversion != kAsItIs) {
    cv::cvtColor(pixels, pixels, png.conversion);
  }
  return pixels;
}

}  // namespace

FrameFolder::FrameFolder(const std::string& path, bool overwrite) : path_(path) {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) {
    throw RecordingError("cannot make the folder " + path_ + ": " + error.message());
  }
  const fs::path list = fs::path(path_) / kListName;
  if (!overwrite && !fs::is_empty(path_)) {
    throw RecordingError("cannot write to " + path_ +
                         ": the folder is not empty (--force writes into it)");
  }
  list_.open(list, std::ios::trunc);
  list_ << "index,file,stamp_ns,exposure_start_ns,exposure_end_ns\n";
  if (!list_.flush()) {
    throw RecordingError("cannot write " + list.string());
  }
}

bool FrameFolder::add(const sensor_msgs::Image& image,
                      const std::optional<ExposureInterval>& exposure) {
  const std::optional<PngPixels> png = pngPixels(image.encoding);
  const std::size_t pixel_bytes = png ? static_cast<std::size_t>(CV_ELEM_SIZE(png->type)) : 0;
  if (!png || image.width == 0 || image.height == 0 || image.step < image.width * pixel_bytes ||
      image.data.size() < std::size_t{image.step} * image.height) {
    ++left_out_;
    return false;
  }
  char name[32];
  std::snprintf(name, sizeof(name), "%06llu.png", static_cast<unsigned long long>(frames_));
  const std::string file = (fs::path(path_) / name).string();
  if (!cv::imwrite(file, pixelsOf(image, *png))) {
    throw RecordingError("cannot write " + file);
  }
  list_ << frames_++ << "," << name << "," << image.header.stamp.toNSec() << ",";
  if (exposure) {
    list_ << exposure->start_ns << "," << exposure->end_ns;
  } else {
    list_ << ",";
  }
  list_ << "\n";
  return true;
}

void FrameFolder::close() {
  list_.close();
  if (!list_) {
    throw RecordingError("cannot write " + (fs::path(path_) / kListName).string());
  }
}

}  // namespace fast_edi
