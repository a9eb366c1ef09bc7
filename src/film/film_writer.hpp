/// \file
/// A film of a recording in slow motion: latent images at a fixed rate of recording time, playing
/// at kPlayRate_hz.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include <sensor_msgs/Image.h>
#include <opencv2/core.hpp>

namespace cv {
class VideoWriter;
}

namespace fast_edi {

/// A film that cannot be written; what() names the file.
class FilmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What became of a film.
struct FilmReport {
  std::uint64_t images = 0;    ///< in the film
  std::uint64_t held = 0;      ///< of these: repeats of the nearest image, for want of a latent one
  std::uint64_t cuts = 0;      ///< jumps of time that were left out
  std::uint64_t left_out = 0;  ///< input images that had another size than the first
};

/// Film image n shows the recording at filmInstant(n). Where there is no latent image of that
/// instant, the nearest image in time is held, be it a latent image or a frame that could not be
/// deblurred. The film begins and ends with the first and the last image given.
class FilmWriter {
 public:
  static constexpr int kPlayRate_hz = 30;
  /// A longer time without any image, or one that goes back, is a cut.
  static constexpr std::int64_t kMaxHold_ns = 10'000'000'000;

  /// Looks whether the file can be written; the codec is opened with the first image.
  /// \param path ends in .mp4, .mov (MPEG-4) or .avi (Motion JPEG)
  /// \param rate_hz images of a second of recording
  /// \param overwrite replace \p path, and what is unfinished beside it (X.active.mp4), if they
  /// exist \throws FilmError for a path that may not be written
  FilmWriter(const std::string& path, int rate_hz, bool overwrite);
  /// Removes an unfinished film.
  ~FilmWriter();
  FilmWriter(const FilmWriter&) = delete;
  FilmWriter& operator=(const FilmWriter&) = delete;

  /// A frame as the pipeline puts it out: shown where nothing nearer comes.
  /// \throws FilmError when the film cannot be written
  void addFrame(const sensor_msgs::Image& image);
  /// A latent image. Images of an exposure come behind its frame, otherwise in order of time.
  /// \throws FilmError when the film cannot be written
  void addLatent(const sensor_msgs::Image& image);

  /// Completes the film, looks whether it can be read back, and gives it its name.
  /// \throws FilmError also when there was no image
  void close();

  const FilmReport& report() const { return report_; }

 private:
  struct Shot {
    std::int64_t t_ns = 0;
    cv::Mat picture;  ///< CV_8UC3
  };

  std::optional<Shot> take(const sensor_msgs::Image& image);
  void flushFrame();
  void show(const Shot& shot);
  void write(const cv::Mat& picture);
  void open(const cv::Size& size);

  const std::string path_;
  const std::string active_path_;
  const int rate_hz_;
  bool unfinished_ = false;  ///< there is a file at active_path_
  std::unique_ptr<cv::VideoWriter> writer_;
  cv::Size size_;
  std::optional<Shot> frame_;  ///< waits for latent images that come before it in time
  std::optional<Shot> last_;
  std::int64_t next_number_ = 0;  ///< of the film image to be written next
  FilmReport report_;
};

}  // namespace fast_edi
