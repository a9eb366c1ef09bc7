#include "film/film_writer.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <system_error>

#include <opencv2/videoio.hpp>

#include "fast_edi/latent/latent_instants.hpp"
#include "fast_edi/messages/image_pixels.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

struct Codec {
  int fourcc;
  const char* name;
};

/// What FFmpeg writes with no encoder but its own.
const std::map<std::string, Codec>& codecs() {
  static const std::map<std::string, Codec> known = {
      {".mp4", {cv::VideoWriter::fourcc('m', 'p', '4', 'v'), "MPEG-4 (mp4v)"}},
      {".mov", {cv::VideoWriter::fourcc('m', 'p', '4', 'v'), "MPEG-4 (mp4v)"}},
      {".avi", {cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), "Motion JPEG (MJPG)"}},
  };
  return known;
}

std::string extensionOf(const std::string& path) {
  return fs::path(path).extension().string();
}

/// The container is chosen by the ending, so that has to stay.
std::string activePath(const std::string& path) {
  return fs::path(path).replace_extension(".active" + extensionOf(path)).string();
}

/// Why nothing more can be written to \p path, which OpenCV does not say; empty if something can.
std::string writingFault(const std::string& path) {
  constexpr std::size_t kMoreThanIsLeftOver = 1 << 16;  // the last block of a full disk, say
  errno = 0;
  std::ofstream file(path, std::ios::binary | std::ios::app);
  const std::string block(kMoreThanIsLeftOver, '\0');
  file.write(block.data(), static_cast<std::streamsize>(block.size()));
  file.flush();
  return file ? "" : std::strerror(errno);
}

}  // namespace

FilmWriter::FilmWriter(const std::string& path, int rate_hz, bool overwrite)
    : path_(path), active_path_(activePath(path)), rate_hz_(rate_hz) {
  if (codecs().count(extensionOf(path_)) == 0) {
    throw FilmError("cannot write " + path_ + ": its name ends in \"" + extensionOf(path_) +
                    "\", expected .mp4, .mov or .avi");
  }
  for (const std::string& output : {path_, active_path_}) {
    if (!overwrite && fs::exists(output)) {
      throw FilmError("cannot write " + output + ": it exists already (--force replaces it)");
    }
    if (fs::is_directory(output)) {
      throw FilmError("cannot write " + output + ": it is a directory");
    }
  }
  const std::string fault = writingFault(active_path_);
  if (!fault.empty()) {
    std::error_code ignored;  // it may not even be there
    fs::remove(active_path_, ignored);
    throw FilmError("cannot write " + path_ + ": " + fault);
  }
  unfinished_ = true;
}

FilmWriter::~FilmWriter() {
  writer_.reset();
  if (unfinished_) {
    std::error_code ignored;  // another exception is being thrown already
    fs::remove(active_path_, ignored);
  }
}

void FilmWriter::addFrame(const sensor_msgs::Image& image) {
  flushFrame();
  frame_ = take(image);
}

void FilmWriter::addLatent(const sensor_msgs::Image& image) {
  const std::optional<Shot> shot = take(image);
  if (!shot) {
    return;
  }
  if (frame_ && frame_->t_ns < shot->t_ns) {
    flushFrame();
  } else if (frame_ && frame_->t_ns == shot->t_ns) {
    frame_.reset();  // the same instant
  }
  show(*shot);
}

void FilmWriter::flushFrame() {
  if (frame_) {
    show(*frame_);
    frame_.reset();
  }
}

std::optional<FilmWriter::Shot> FilmWriter::take(const sensor_msgs::Image& image) {
  Shot shot;
  shot.t_ns = static_cast<std::int64_t>(image.header.stamp.toNSec());
  try {
    shot.picture = colourPixels(image);
  } catch (const std::invalid_argument&) {  // an encoding that was only passed through
    ++report_.left_out;
    return std::nullopt;
  }
  if (!writer_) {
    open(shot.picture.size());
  }
  if (shot.picture.size() != size_) {
    ++report_.left_out;
    return std::nullopt;
  }
  return shot;
}

/// Writes all film images before the shot, and its own if it is one.
void FilmWriter::show(const Shot& shot) {
  const bool is_first = !last_;
  const bool is_cut = last_ && (shot.t_ns < last_->t_ns || shot.t_ns - last_->t_ns > kMaxHold_ns);
  if (is_first || is_cut) {
    report_.cuts += is_cut ? 1 : 0;
    next_number_ = firstFilmNumber(shot.t_ns, rate_hz_);
  }
  for (; filmInstant(next_number_, rate_hz_) < shot.t_ns; ++next_number_) {
    const std::int64_t t_ns = filmInstant(next_number_, rate_hz_);
    write(t_ns - last_->t_ns < shot.t_ns - t_ns ? last_->picture : shot.picture);
    ++report_.held;
  }
  if (filmInstant(next_number_, rate_hz_) == shot.t_ns) {
    write(shot.picture);
    ++next_number_;
  }
  last_ = shot;
}

void FilmWriter::write(const cv::Mat& picture) {
  try {
    writer_->write(picture);
  } catch (const cv::Exception& error) {
    throw FilmError("cannot write " + path_ + ": " + error.what());
  }
  ++report_.images;
}

void FilmWriter::open(const cv::Size& size) {
  const Codec& codec = codecs().at(extensionOf(path_));
  auto writer = std::make_unique<cv::VideoWriter>();
  if (!writer->open(active_path_, cv::CAP_FFMPEG, codec.fourcc, kPlayRate_hz, size, true)) {
    throw FilmError("cannot write " + path_ + ": OpenCV cannot write " + codec.name + " of " +
                    std::to_string(size.width) + " x " + std::to_string(size.height) +
                    " pixels through FFmpeg; another ending (.mp4, .mov, .avi) chooses another "
                    "codec");
  }
  writer_ = std::move(writer);
  size_ = size;
}

void FilmWriter::close() {
  flushFrame();
  if (!writer_) {
    throw FilmError("cannot write " + path_ + ": there is no image to show");
  }
  writer_->release();
  // The writer does not report a full disk.
  cv::VideoCapture written(active_path_, cv::CAP_FFMPEG);
  const auto images = static_cast<std::uint64_t>(written.get(cv::CAP_PROP_FRAME_COUNT));
  if (!written.isOpened() || images != report_.images) {
    const std::string fault = writingFault(active_path_);
    throw FilmError("cannot write " + path_ + ": " + fault + (fault.empty() ? "" : "; ") +
                    "the film cannot be read back with its " + std::to_string(report_.images) +
                    " images");
  }
  written.release();
  std::error_code error;
  fs::rename(active_path_, path_, error);
  if (error) {
    throw FilmError("cannot rename " + active_path_ + " to " + path_ + ": " + error.message());
  }
  unfinished_ = false;
  writer_.reset();
}

}  // namespace fast_edi
