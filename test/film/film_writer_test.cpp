#include "film/film_writer.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kRate_hz = 100;  // an image each 10 ms
constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

class FilmWriterTest : public ::testing::Test {
 protected:
  /// A flat image, whose grey level tells it from others.
  static sensor_msgs::Image image(std::int64_t t_ms, std::uint8_t grey,
                                  const std::string& encoding = "mono8", int width = 64) {
    sensor_msgs::Image image;
    image.header.stamp.fromNSec(static_cast<std::uint64_t>(kStart_ns + t_ms * kMs));
    image.encoding = encoding;
    image.width = static_cast<std::uint32_t>(width);
    image.height = 48;
    image.step = image.width *
                 static_cast<std::uint32_t>(sensor_msgs::image_encodings::numChannels(encoding));
    if (sensor_msgs::image_encodings::bitDepth(encoding) == 16) {
      image.step *= 2;
    }
    image.data.assign(std::size_t{image.step} * image.height, grey);
    return image;
  }

  /// Grey levels of the film, to the nearest fifty: codecs lose some.
  std::vector<int> readBack(const std::string& name = "film.mp4") {
    std::vector<int> levels;
    cv::VideoCapture film(directory_.file(name));
    EXPECT_TRUE(film.isOpened());
    EXPECT_EQ(film.get(cv::CAP_PROP_FPS), FilmWriter::kPlayRate_hz);
    cv::Mat picture;
    while (film.read(picture)) {
      levels.push_back(cvRound(cv::mean(picture)[0] / 50.0) * 50);
    }
    return levels;
  }

  std::string path(const std::string& name = "film.mp4") const { return directory_.file(name); }

  const TemporaryDirectory directory_;
};

TEST_F(FilmWriterTest, ShowsLatentImagesInOrder) {
  for (const char* name : {"film.mp4", "film.mov", "film.avi"}) {
    FilmWriter writer(path(name), kRate_hz, false);
    writer.addFrame(image(15, 250));  // its latent images are nearer to every film image
    writer.addLatent(image(0, 50));
    writer.addLatent(image(10, 100));
    writer.addLatent(image(20, 150));
    writer.addLatent(image(30, 200));
    writer.close();
    EXPECT_THAT(readBack(name), ElementsAre(50, 100, 150, 200)) << name;
    EXPECT_EQ(writer.report().images, 4u);
    EXPECT_EQ(writer.report().held, 0u);
    EXPECT_EQ(fs::exists(path("film.active.mp4")), false);
  }
}

TEST_F(FilmWriterTest, HoldsTheNearestImageWhereNoneIsLatent) {
  FilmWriter writer(path(), kRate_hz, false);
  writer.addFrame(image(0, 250));
  writer.addLatent(image(0, 50));
  writer.addFrame(image(35, 100));  // was passed through
  writer.addFrame(image(65, 200));
  writer.addLatent(image(60, 150));
  writer.close();
  EXPECT_THAT(readBack(), ElementsAre(50, 50, 100, 100, 100, 150, 150));
  EXPECT_EQ(writer.report().held, 5u);
}

TEST_F(FilmWriterTest, CutsJumpsOfTime) {
  FilmWriter writer(path(), kRate_hz, false);
  writer.addFrame(image(0, 50));
  writer.addFrame(image(20, 100));
  writer.addFrame(image(3'600'000, 150));
  writer.addFrame(image(10, 200));
  writer.close();
  EXPECT_THAT(readBack(), ElementsAre(50, 100, 100, 150, 200));
  EXPECT_EQ(writer.report().cuts, 2u);
}

TEST_F(FilmWriterTest, TakesEveryEncodingAndLeavesOutOtherSizes) {
  FilmWriter writer(path(), kRate_hz, false);
  std::int64_t t_ms = 0;
  for (const char* encoding : {"mono8", "8UC1", "mono16", "rgb8", "bgr8", "bayer_rggb8"}) {
    writer.addLatent(image(t_ms, 100, encoding));
    t_ms += 10;
  }
  writer.addLatent(image(t_ms, 200, "mono8", 32));
  writer.addFrame(image(t_ms, 200, "32FC1", 32));
  writer.close();
  EXPECT_THAT(readBack(), ElementsAre(100, 100, 100, 100, 100, 100));
  EXPECT_GE(writer.report().left_out, 2u);
}

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const FilmError& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(FilmWriterTest, SaysWhyItCannotWrite) {
  const auto open = [this](const std::string& name, bool overwrite) {
    return messageOf([&] { FilmWriter(path(name), kRate_hz, overwrite); });
  };
  EXPECT_THAT(open("film.xyz", false), HasSubstr("ends in \".xyz\", expected .mp4, .mov or .avi"));
  EXPECT_THAT(open("nowhere/film.mp4", false), HasSubstr("No such file or directory"));
  fs::create_directory(path("folder.mp4"));
  EXPECT_THAT(open("folder.mp4", true), HasSubstr("it is a directory"));
  FilmWriter writer(path(), kRate_hz, false);
  EXPECT_THAT(messageOf([&] { writer.close(); }), HasSubstr("no image to show"));
  writer.addFrame(image(0, 50));
  writer.close();
  EXPECT_THAT(open("film.mp4", false), HasSubstr("exists already (--force replaces it)"));
  EXPECT_EQ(open("film.mp4", true), "no error");
  EXPECT_THAT(readBack(), ElementsAre(50)) << "replaced before the new one was complete";
}

TEST_F(FilmWriterTest, KeepsAnUnfinishedFilmOfAnotherProgramUnlessTold) {
  std::ofstream(path("film.active.mp4")) << "another film";
  EXPECT_THAT(messageOf([&] { FilmWriter(path(), kRate_hz, false); }),
              HasSubstr("film.active.mp4: it exists already (--force replaces it)"));
  std::ifstream file(path("film.active.mp4"));
  std::string content;
  std::getline(file, content);
  EXPECT_EQ(content, "another film");
  EXPECT_EQ(messageOf([&] { FilmWriter(path(), kRate_hz, true); }), "no error");
}

TEST_F(FilmWriterTest, LeavesNothingBehindUnlessClosed) {
  {
    FilmWriter writer(path(), kRate_hz, false);
    writer.addFrame(image(0, 50));
  }
  EXPECT_TRUE(fs::is_empty(fs::path(path()).parent_path()));
}

}  // namespace
}  // namespace fast_edi
