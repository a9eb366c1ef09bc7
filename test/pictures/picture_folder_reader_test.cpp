#include "fast_edi/pictures/picture_folder_reader.hpp"

#include <gmock/gmock.h>
#include <zip.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <tuple>

#include <opencv2/imgcodecs.hpp>

#include "fast_edi/pictures/open_pictures.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr SensorSize kSize{24, 16};
constexpr int kFrames = 3;
constexpr int kEvents = 1200;
constexpr std::int64_t kPeriod_ns = 40 * kNanosecondsPerMillisecond;
constexpr std::int64_t kExposure_ns = 10 * kNanosecondsPerMillisecond;

using EventRow = std::tuple<std::int64_t, int, int, bool>;
using FrameRow = std::tuple<std::int64_t, bool, std::int64_t, std::vector<std::uint8_t>>;

struct Content {
  std::vector<EventRow> events;
  std::vector<FrameRow> frames;
  std::vector<RecordingDamage> damage;
  bool knows_exposures = false;
};

Content readAll(const std::string& path, bool archive = false) {
  const std::unique_ptr<Recording> reader =
      archive ? openPictureArchive(path) : openPictureFolder(path);
  Content content;
  RecordingItem item;
  std::int64_t before_ns = 0;
  while (reader->next(item)) {
    EXPECT_GE(item.record_ns, before_ns);
    before_ns = item.record_ns;
    if (const auto* events = std::get_if<RecordedEvents>(&item.content)) {
      EXPECT_GT(events->count, 0u);
      for (std::size_t i = 0; i < events->count; ++i) {
        const Event& event = events->data[i];
        content.events.emplace_back(event.t_ns, event.x, event.y, event.on);
      }
    } else if (const auto* frame = std::get_if<RecordedFrame>(&item.content)) {
      content.frames.emplace_back(
          frame->stamp_ns, frame->exposure.has_value(),
          frame->exposure ? frame->exposure->length() : 0,
          std::vector<std::uint8_t>(frame->pixels, frame->pixels + frame->bytes));
    }
  }
  content.damage = reader->damage();
  content.knows_exposures = reader->knowsExposures();
  return content;
}

/// Events of the whole recording, and one behind the last frame's exposure.
Event eventAt(int i) {
  return {static_cast<std::uint16_t>(i % kSize.width),
          static_cast<std::uint16_t>(i / 7 % kSize.height),
          i * (kFrames * kPeriod_ns / kEvents / 1000 * 1000), i % 3 == 0};
}

std::int64_t startOf(int frame) {
  return frame * kPeriod_ns + 20 * kNanosecondsPerMillisecond;
}

class PictureFolder : public ::testing::Test {
 protected:
  std::string file(const std::string& name) const { return directory_.file(name); }
  std::string folder() const { return file("."); }

  void writePictures(const std::string& under) {
    std::filesystem::create_directories(file(under));
    for (int i = 0; i < kFrames; ++i) {
      cv::Mat pixels(kSize.height, kSize.width, CV_8UC1);
      cv::randu(pixels, 0, 255);
      cv::imwrite(file(under + "/" + std::to_string(i + 9) + ".png"), pixels);  // 9, 10, 11
      pixels_.emplace_back(pixels.datastart, pixels.dataend);
    }
  }

  void writeEvents(const std::string& name, const std::string& head,
                   const std::function<void(std::ostream&, const Event&)>& line) {
    std::ofstream file(this->file(name));
    file << head;
    for (int i = 0; i < kEvents; ++i) {
      line(file, eventAt(i));
      file << "\n";
    }
  }

  void expectEverything(const Content& content, bool exposures) {
    ASSERT_THAT(content.events, SizeIs(kEvents));
    for (int i = 0; i < kEvents; ++i) {
      const Event event = eventAt(i);
      ASSERT_EQ(content.events[static_cast<std::size_t>(i)],
                EventRow(event.t_ns, event.x, event.y, event.on))
          << i;
    }
    ASSERT_THAT(content.frames, SizeIs(kFrames));
    for (int i = 0; i < kFrames; ++i) {
      EXPECT_EQ(content.frames[static_cast<std::size_t>(i)],
                FrameRow(startOf(i) + kExposure_ns / 2, exposures, exposures ? kExposure_ns : 0,
                         pixels_[static_cast<std::size_t>(i)]));
    }
    EXPECT_EQ(content.knows_exposures, exposures);
    EXPECT_THAT(content.damage, SizeIs(0));
  }

  void writeIjrr() {
    writePictures("images");
    std::ofstream list(file("images.txt"));
    list.precision(9);
    for (int i = 0; i < kFrames; ++i) {
      list << std::fixed << static_cast<double>(startOf(i) + kExposure_ns / 2) * 1e-9 << " images/"
           << i + 9 << ".png\n";
    }
    writeEvents("events.txt", "", [](std::ostream& out, const Event& event) {
      out.precision(9);
      out << std::fixed << static_cast<double>(event.t_ns) * 1e-9 << " " << event.x << " "
          << event.y << " " << (event.on ? 1 : 0);
    });
  }

  void writeEvdi(const std::function<void(std::ostream&, const Event&)>& line, std::int64_t unit_ns,
                 const std::string& head = "") {
    writePictures("Blur");
    std::ofstream starts(file("Exposure_start.txt"));
    std::ofstream ends(file("Exposure_end.txt"));
    for (int i = 0; i < kFrames; ++i) {
      starts << startOf(i) / unit_ns << "\n";
      ends << (startOf(i) + kExposure_ns) / unit_ns << "\n";
    }
    writeEvents("Events.txt", head, line);
  }

  /// All files as an archive.
  std::string pack() const {
    const std::string archive = archives_.file("packed.zip");
    int code = 0;
    zip_t* packed = zip_open(archive.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    EXPECT_NE(packed, nullptr);
    const std::filesystem::path root = file("");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
      if (entry.is_regular_file()) {
        const std::string name = entry.path().lexically_relative(root).string();
        EXPECT_GE(zip_file_add(packed, name.c_str(),
                               zip_source_file(packed, entry.path().c_str(), 0, -1), 0),
                  0);
      }
    }
    EXPECT_EQ(zip_close(packed), 0);
    return archive;
  }

  const TemporaryDirectory directory_;
  const TemporaryDirectory archives_;
  std::vector<std::vector<std::uint8_t>> pixels_;
};

TEST_F(PictureFolder, OfIjrr) {
  writeIjrr();
  expectEverything(readAll(folder()), false);
}

TEST_F(PictureFolder, OfEvdi) {
  writeEvdi(
      [](std::ostream& out, const Event& event) {
        out << event.t_ns << " " << event.x << " " << event.y << " " << (event.on ? 1 : -1);
      },
      1);
  expectEverything(readAll(folder()), true);
}

TEST_F(PictureFolder, AsAnArchiveGivesTheSame) {
  writeIjrr();
  const std::string archive = pack();
  EXPECT_EQ(formatOf(archive), RecordingFormat::kZip);
  EXPECT_EQ(openRecordingOrPictures(archive)->format(), "pictures and text, zip");
  expectEverything(readAll(archive, true), false);
}

TEST_F(PictureFolder, OfEvdiAsAnArchiveGivesTheSame) {
  writeEvdi(
      [](std::ostream& out, const Event& event) {
        out << event.t_ns << " " << event.x << " " << event.y << " " << (event.on ? 1 : -1);
      },
      1);
  expectEverything(readAll(pack(), true), true);
}

TEST_F(PictureFolder, ArchiveOfOtherThingsIsRefused) {
  std::ofstream(file("notes.txt")) << "nothing";
  const std::string archive = pack();
  try {
    openRecordingOrPictures(archive);
    ADD_FAILURE() << "not refused";
  } catch (const RecordingError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is a zip archive, but no recording: expected images.txt"));
  }
}

TEST_F(PictureFolder, WithNamedColumns) {
  writePictures("p");
  std::ofstream list(file("frames.csv"));
  list << "index,file,exposure_start_us,exposure_end_us\n";
  for (int i = 0; i < kFrames; ++i) {
    list << i << ",p/" << i + 9 << ".png," << startOf(i) / 1000 << ","
         << (startOf(i) + kExposure_ns) / 1000 << "\n";
  }
  list.close();
  writeEvents("events.csv", "polarity,y,x,timestamp_us\n",
              [](std::ostream& out, const Event& event) {
                out << event.on << "," << event.y << "," << event.x << "," << event.t_ns / 1000;
              });
  expectEverything(readAll(folder()), true);
}

TEST_F(PictureFolder, UnitsAndColumnsAndOriginAreFoundOut) {
  // Coordinates from 1, time last, microseconds here and nanoseconds there.
  writeEvdi(
      [](std::ostream& out, const Event& event) {
        out << event.x + 1 << " " << event.y + 1 << " " << (event.on ? 1 : 0) << " "
            << event.t_ns / 1000 << ".000";
      },
      1);
  expectEverything(readAll(folder()), true);
}

TEST_F(PictureFolder, ColumnsOfRowsBeforeColumnsAreFoundOut) {
  writeEvdi(
      [](std::ostream& out, const Event& event) {
        out << event.t_ns / 1000 << " " << event.y << " " << event.x << " " << event.on;
      },
      1000);
  expectEverything(readAll(folder()), true);
}

TEST_F(PictureFolder, ALineOfNamesDecides) {
  writeEvdi(
      [](std::ostream& out, const Event& event) {
        out << event.x << " " << event.y << " " << event.t_ns << " " << event.on;
      },
      1, "# x y t_ns p\n");
  expectEverything(readAll(folder()), true);
}

TEST_F(PictureFolder, BadLinesAreNamedAndLeftOut) {
  writeIjrr();
  {
    std::ofstream events(file("events.txt"), std::ios::app);
    events << "0.2 1 1\n0.2 24 1 1\n-5 1 1 1\nnonsense\n0.2 1 1 1\n";
  }
  std::filesystem::remove(file("images/10.png"));
  const Content content = readAll(folder());
  EXPECT_THAT(content.events, SizeIs(kEvents + 1));
  EXPECT_THAT(content.frames, SizeIs(kFrames - 1));
  ASSERT_THAT(content.damage, SizeIs(5));
  EXPECT_THAT(content.damage[0].what,
              HasSubstr("of events.txt, line 1201: found \"0.2 1 1\", expected time, x, y and"));
  EXPECT_THAT(content.damage[1].what, HasSubstr("expected a pixel of the 24x16"));
  EXPECT_THAT(content.damage[2].what, HasSubstr("expected a time from 0 to 2^32 s"));
  EXPECT_THAT(content.damage[3].what, HasSubstr("nonsense"));
  EXPECT_GT(content.damage[3].offset, content.damage[2].offset);
  EXPECT_THAT(content.damage[4].what, HasSubstr("10.png"));
}

TEST_F(PictureFolder, SaysWhatIsNotClear) {
  const auto refusal = [this] {
    try {
      readAll(folder());
    } catch (const RecordingError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  writeIjrr();
  std::ofstream(file("events.txt")) << "0 1 1 1\n0 1 1 1\n";
  EXPECT_THAT(refusal(), HasSubstr("events.txt: the unit of time is not clear"));
  std::ofstream(file("events.txt")) << "9 8 7 6\n5 4 3 2\n";
  EXPECT_THAT(refusal(), HasSubstr("events.txt: the order of the columns is not clear"));
  std::ofstream(file("events.txt")) << "";
  EXPECT_THAT(refusal(), HasSubstr("events.txt: no event within the first 0 lines"));
  std::ofstream(file("images.txt")) << "3 4 5\n";
  EXPECT_THAT(refusal(), HasSubstr("images.txt, line 1: found \"3 4 5\", expected a time and"));
  std::ofstream(file("images.txt")) << "3 images/9.png\n";
  EXPECT_THAT(refusal(), HasSubstr("the unit of the frames' times is not clear"));
  std::ofstream(file("images.txt")) << "";
  EXPECT_THAT(refusal(), HasSubstr("no frame is listed"));
}

TEST_F(PictureFolder, WithoutEventsHasFrames) {
  writeIjrr();
  std::filesystem::remove(file("events.txt"));
  const Content content = readAll(folder());
  EXPECT_THAT(content.frames, SizeIs(kFrames));
  EXPECT_THAT(content.events, SizeIs(0));
}

}  // namespace
}  // namespace fast_edi
