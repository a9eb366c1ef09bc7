#include "networks/single_image_network.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fast_edi/base/sensor_size.hpp"

namespace fast_edi {
namespace {

constexpr double kWhiteDn = 255.0;
constexpr int kGrey = 1;
constexpr int kColour = 3;

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  if (!(content << file.rdbuf())) {  // also for a folder
    throw std::runtime_error("cannot be read");
  }
  return content.str();
}

std::string shapeText(const cv::Mat& blob) {
  std::string text;
  for (int i = 0; i < blob.dims; ++i) {
    text += (i > 0 ? "x" : "") + std::to_string(blob.size[i]);
  }
  return text;
}

int roundedUp(int value, int multiple) {
  return (value + multiple - 1) / multiple * multiple;
}

/// The mean over the channels of a 1 x channels x height x width blob.
cv::Mat1f meanOverChannels(const cv::Mat& blob) {
  const int channels = blob.size[1];
  cv::Mat1f sum(blob.size[2], blob.size[3], 0.0F);
  for (int i = 0; i < channels; ++i) {
    sum += cv::Mat1f(blob.size[2], blob.size[3], const_cast<float*>(blob.ptr<float>(0, i)));
  }
  return sum / channels;
}

}  // namespace

NetworkRange networkRange(const std::string& text) {
  std::istringstream stream(text);
  stream.imbue(std::locale::classic());
  NetworkRange range;
  char colon = 0;
  if (!(stream >> range.black >> colon >> range.white) || colon != ':' ||
      !(stream >> std::ws).eof() || range.black == range.white) {
    throw std::invalid_argument("expected BLACK:WHITE, two numbers such as 0:1 or -1:1, got \"" +
                                text + "\"");
  }
  return range;
}

SingleImageNetwork::SingleImageNetwork(std::string path, NetworkRange range)
    : path_(std::move(path)), range_(range) {
  try {
    input_ = onnxInput(contentOf(path_));
    if (input_.channels != 0 && input_.channels != kGrey && input_.channels != kColour) {
      throw std::runtime_error("it takes " + std::to_string(input_.channels) +
                               " channels, expected 1 or 3");
    }
    net_ = cv::dnn::readNetFromONNX(path_);
  } catch (const std::exception& error) {  // cv::Exception among them
    throw std::runtime_error(path_ + ": " + error.what());
  }
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
}

cv::Size SingleImageNetwork::paddedSize(cv::Size size) const {
  const cv::Size padded = {
      input_.width > 0 ? input_.width : roundedUp(size.width, kNetworkMultiple_px),
      input_.height > 0 ? input_.height : roundedUp(size.height, kNetworkMultiple_px)};
  if (padded.width < size.width || padded.height < size.height) {
    throw std::runtime_error(path_ + ": it takes images of " +
                             sizeText(padded.width, padded.height) + ", got one of " +
                             sizeText(size.width, size.height));
  }
  return padded;
}

cv::Mat SingleImageNetwork::forward(const cv::Mat& padded) {
  try {
    net_.setInput(cv::dnn::blobFromImage(padded));
    return net_.forward();
  } catch (const cv::Exception& error) {
    throw std::runtime_error(path_ + ": " + error.what());
  }
}

cv::Mat SingleImageNetwork::run(const cv::Mat& image) {
  const cv::Size size = paddedSize(image.size());
  const double span = range_.white - range_.black;
  cv::Mat scaled;
  image.convertTo(scaled, CV_32F, span / kWhiteDn, range_.black);
  cv::Mat padded;
  cv::copyMakeBorder(scaled, padded, 0, size.height - image.rows, 0, size.width - image.cols,
                     cv::BORDER_REFLECT_101);
  if (input_.channels != kGrey) {
    cv::merge(std::vector<cv::Mat>(kColour, padded), padded);
  }
  const cv::Mat output = forward(padded);
  const bool is_image = output.dims == 4 && output.type() == CV_32F && output.size[0] == 1 &&
                        (output.size[1] == kGrey || output.size[1] == kColour);
  if (!is_image || output.size[2] != size.height || output.size[3] != size.width) {
    throw std::runtime_error(path_ + ": its output is " + shapeText(output) + ", expected 1x1x" +
                             std::to_string(size.height) + "x" + std::to_string(size.width) +
                             " or the same with 3 channels");
  }
  const cv::Mat1f grey = meanOverChannels(output);
  if (!cv::checkRange(grey)) {
    throw std::runtime_error(path_ + ": its output has values that are not finite");
  }
  cv::Mat result;
  grey(cv::Rect({0, 0}, image.size()))
      .convertTo(result, CV_8U, kWhiteDn / span, -range_.black * kWhiteDn / span);
  return result;
}

}  // namespace fast_edi
