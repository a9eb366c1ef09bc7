/// Files that h5py wrote in the layouts of public data sets (test/data/recordings/write_hdf5.py),
/// and hostile ones.
#include "fast_edi/hdf5/hdf5_reader.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include <hdf5.h>

#include "fast_edi/pictures/open_pictures.hpp"
#include "fast_edi/recording/aedat4_reader.hpp"
#include "fast_edi/recording/open_recording.hpp"
#include "fast_edi/recording/recording_error.hpp"
#include "hdf5/hdf5_library.hpp"
#include "recording/recording_content.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::readAll;
using testing::RecordingContent;
using ::testing::SizeIs;

const std::string kData = std::string(FAST_EDI_SOURCE_DIR) + "/test/data/recordings/";

std::string dataFile(const std::string& name) {
  return kData + "hdf5/" + name;
}

/// What all files were made of.
RecordingContent original() {
  Aedat4Reader reader(kData + "vendor_none.aedat4");
  return readAll(reader);
}

std::string refusal(const std::string& path) {
  try {
    openHdf5(path);
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "not refused";
}

struct Layout {
  const char* file;
  bool frames;
  bool exposures;
  bool from_zero;  ///< times are those of the original from a whole millisecond on
};

class Hdf5Layouts : public ::testing::TestWithParam<Layout> {};
INSTANTIATE_TEST_SUITE_P(Layouts, Hdf5Layouts,
                         ::testing::Values(Layout{"dsec.h5", false, false, false},
                                           Layout{"event_utils.h5", true, true, false},
                                           Layout{"mvsec.hdf5", true, false, false},
                                           Layout{"v2e.h5", false, false, true},
                                           Layout{"e2calib.h5", false, false, false}),
                         [](const auto& layout) {
                           const std::string name = layout.param.file;
                           return name.substr(0, name.find('.'));
                         });

TEST_P(Hdf5Layouts, GiveTheOriginal) {
  const Layout& layout = GetParam();
  const std::string path = dataFile(layout.file);
  EXPECT_EQ(formatOf(path), RecordingFormat::kHdf5);
  EXPECT_EQ(openRecording(path), nullptr) << "whose library has no HDF5";
  const std::unique_ptr<Recording> reader = openRecordingOrPictures(path);
  EXPECT_EQ(reader->format(), "HDF5");
  EXPECT_EQ(reader->knowsExposures(), layout.exposures);
  const RecordingContent content = readAll(*reader);
  RecordingContent expected = original();
  if (layout.from_zero) {
    const std::int64_t first_ns = std::get<0>(expected.events.front()) / 1'000'000 * 1'000'000;
    for (auto& event : expected.events) {
      std::get<0>(event) -= first_ns;
    }
  }
  EXPECT_EQ(content.events, expected.events);
  EXPECT_THAT(content.damage, IsEmpty());
  EXPECT_EQ(reader->position(), reader->length());
  ASSERT_THAT(content.frames, SizeIs(layout.frames ? 3 : 0));
  for (std::size_t i = 0; i < content.frames.size(); ++i) {
    EXPECT_EQ(content.frames[i].stamp_ns, expected.frames[i].stamp_ns);
    EXPECT_EQ(content.frames[i].size, expected.frames[i].size);
    EXPECT_EQ(content.frames[i].encoding, "mono8");
    EXPECT_EQ(content.frames[i].exposure,
              layout.exposures ? expected.frames[i].exposure : std::nullopt);
  }
  if (layout.frames) {
    EXPECT_EQ(content.pixels, expected.pixels);
  }
}

TEST(Hdf5Reader, SizeOfASensorThatNothingTellsIsThatOfTheSmallestThatHoldsTheEvents) {
  EXPECT_EQ(openHdf5(dataFile("dsec.h5"))->streams()[0].size, (SensorSize{128, 128}));
  EXPECT_EQ(openHdf5(dataFile("event_utils.h5"))->streams()[1].size, (SensorSize{48, 40}));
}

TEST(Hdf5Reader, NamesAMissingFilterAndHowToInstallIt) {
  silenceHdf5();
  if (H5Zfilter_avail(32001) > 0) {
    // With the plugin it is a recording like any other.
    const RecordingContent content = readAll(*openHdf5(dataFile("blosc.h5")));
    EXPECT_EQ(content.events, original().events);
    return;
  }
  EXPECT_THAT(
      refusal(dataFile("blosc.h5")),
      AllOf(HasSubstr("blosc.h5, events/t: "), HasSubstr("(blosc, number 32001)"),
            HasSubstr("install hdf5-filter-plugin-blosc-serial"), HasSubstr("HDF5_PLUGIN_PATH")));
}

TEST(Hdf5Reader, PrintsNothing) {
  ::testing::internal::CaptureStderr();
  openHdf5(dataFile("dsec.h5"));
  refusal(kData + "vendor_none.aedat4");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

class Hdf5Made : public ::testing::Test {
 protected:
  Hdf5Made() : file_(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose) {}

  /// \return the dataset
  template <typename Number>
  Hdf5Handle add(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                 const std::vector<Number>& values) {
    const Hdf5Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_create_intermediate_group(links.id(), 1);
    const Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                           H5Sclose);
    Hdf5Handle set(
        H5Dcreate2(file_.id(), name.c_str(), type, space.id(), links.id(), creation_, H5P_DEFAULT),
        H5Dclose);
    EXPECT_TRUE(set) << hdf5Fault();
    if (!values.empty()) {
      EXPECT_GE(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
    }
    return set;
  }

  void addEvents(const std::vector<std::int64_t>& times) {
    const hsize_t count = times.size();
    std::vector<std::uint16_t> places(times.size());
    std::vector<std::uint8_t> on(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) {
      places[i] = static_cast<std::uint16_t>(i % 8);
      on[i] = i % 2 == 0 ? 1 : 0;
    }
    add("events/t", H5T_NATIVE_INT64, {count}, times);
    add("events/x", H5T_NATIVE_UINT16, {count}, places);
    add("events/y", H5T_NATIVE_UINT16, {count}, places);
    add("events/p", H5T_NATIVE_UINT8, {count}, on);
  }

  void addImage(const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
                const std::vector<std::uint16_t>& values, double stamp) {
    const Hdf5Handle image = add(name, type, shape, values);
    setNumber(image, "timestamp", stamp);
  }

  static void setNumber(const Hdf5Handle& object, const char* name, double value) {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Hdf5Handle attribute(
        H5Acreate2(object.id(), name, H5T_NATIVE_DOUBLE, space.id(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose);
    EXPECT_GE(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &value), 0);
  }

  void finish() { file_ = Hdf5Handle(); }
  std::unique_ptr<Recording> open() {
    finish();
    return openHdf5(path_);
  }
  std::string refused() {
    finish();
    return refusal(path_);
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("made.h5");
  Hdf5Handle file_;
  hid_t creation_ = H5P_DEFAULT;
};

TEST_F(Hdf5Made, WithoutEventsAndFramesIsRefused) {
  add<std::uint8_t>("events/x", H5T_NATIVE_UINT8, {3}, {1, 2, 3});
  EXPECT_THAT(refused(), AllOf(HasSubstr("made.h5 has neither events nor frames"),
                               HasSubstr("events/xs, ys, ts and ps (event_utils)")));
}

TEST_F(Hdf5Made, WithColumnsOfDifferentLengthsIsRefused) {
  addEvents({1, 2, 3});
  H5Ldelete(file_.id(), "events/y", H5P_DEFAULT);
  add<std::uint8_t>("events/y", H5T_NATIVE_UINT8, {2}, {1, 2});
  EXPECT_THAT(refused(), AllOf(HasSubstr("made.h5, events/y: expected one column"),
                               HasSubstr("events/t has, 3; found 2")));
}

TEST_F(Hdf5Made, WithTextForNumbersIsRefused) {
  addEvents({1, 2, 3});
  H5Ldelete(file_.id(), "events/p", H5P_DEFAULT);
  add<char>("events/p", H5T_C_S1, {3}, {'a', 'b', 'c'});
  EXPECT_THAT(refused(), HasSubstr("made.h5, events/p: expected numbers"));
}

TEST_F(Hdf5Made, WithNanosecondsIsToldByItsFrames) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 100; ++i) {
    times.push_back(std::int64_t{i} * 1'000'000);
  }
  addEvents(times);
  addImage("images/a", H5T_NATIVE_UINT16, {8, 8}, std::vector<std::uint16_t>(64, 7), 0.02);
  addImage("images/b", H5T_NATIVE_UINT16, {8, 8}, std::vector<std::uint16_t>(64, 8), 0.08);
  const RecordingContent content = readAll(*open());
  ASSERT_THAT(content.events, SizeIs(100));
  EXPECT_EQ(std::get<0>(content.events.back()), 99'000'000);
  ASSERT_THAT(content.frames, SizeIs(2));
  EXPECT_EQ(content.frames[1].stamp_ns, 80'000'000);
  EXPECT_EQ(content.frames[1].encoding, "mono16");
}

TEST_F(Hdf5Made, FramesInColourAndOfAStackAreReadInTheOrderOfTheirTimes) {
  std::vector<std::uint8_t> pixels(std::size_t{2} * 2 * 4 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = static_cast<std::uint8_t>(i);
  }
  add("davis/left/image_raw", H5T_NATIVE_UINT8, {2, 2, 4, 3}, pixels);
  add<double>("davis/left/image_raw_ts", H5T_NATIVE_DOUBLE, {2}, {5.0, 4.0});
  const RecordingContent content = readAll(*open());
  ASSERT_THAT(content.frames, SizeIs(2));
  EXPECT_EQ(content.frames[0].stamp_ns, 4 * kNanosecondsPerSecond);
  EXPECT_EQ(content.frames[0].encoding, "bgr8");
  EXPECT_EQ(content.frames[0].size, (SensorSize{4, 2}));
  EXPECT_EQ(content.pixels, std::vector<std::uint8_t>(pixels.begin(), pixels.begin() + 24));
}

TEST_F(Hdf5Made, WhatIsWrongWithAFrameOrAnEventIsNoted) {
  addEvents({1, -5, 3});
  addImage("images/a", H5T_NATIVE_UINT16, {8, 8}, std::vector<std::uint16_t>(64, 7), 0.02);
  addImage("images/b", H5T_NATIVE_UINT16, {8, 2, 8}, std::vector<std::uint16_t>(128, 7), 0.03);
  addImage("images/c", H5T_NATIVE_UINT16, {8, 8}, std::vector<std::uint16_t>(64, 7), -1.0);
  add<std::uint16_t>("images/d", H5T_NATIVE_UINT16, {8, 8}, std::vector<std::uint16_t>(64, 7));
  const RecordingContent content = readAll(*open());
  EXPECT_THAT(content.events, SizeIs(2));
  EXPECT_THAT(content.frames, SizeIs(1));
  std::string all;
  for (const RecordingDamage& place : content.damage) {
    all += place.what + "\n";
  }
  EXPECT_THAT(all, HasSubstr("images/b: expected pixels of 8 or 16 bits"));
  EXPECT_THAT(all, HasSubstr("images/c has no usable time"));
  EXPECT_THAT(all, HasSubstr("images/d has no attribute timestamp"));
  EXPECT_THAT(all, HasSubstr("among events 0 to 2, 1 have a time before 1970"));
}

TEST_F(Hdf5Made, WithMoreNumbersThanItsFileCanHoldIsRefused) {
  addEvents({1, 2, 3});
  H5Ldelete(file_.id(), "events/t", H5P_DEFAULT);
  add<std::int64_t>("events/t", H5T_NATIVE_INT64, {hsize_t{1} << 40}, {});
  EXPECT_THAT(refused(), AllOf(HasSubstr("events/t: it states 1099511627776 numbers, expected at"),
                               HasSubstr("in a file of")));
}

TEST_F(Hdf5Made, WithDataOrLinksInOtherFilesIsRefused) {
  const std::string secret = directory_.file("secret");
  std::ofstream(secret) << std::string(64, 'x');
  const Hdf5Handle external(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_external(external.id(), secret.c_str(), 0, 24);
  addEvents({1, 2, 3});
  H5Ldelete(file_.id(), "events/t", H5P_DEFAULT);
  creation_ = external.id();
  add<std::int64_t>("events/t", H5T_NATIVE_INT64, {3}, {});
  creation_ = H5P_DEFAULT;
  EXPECT_THAT(refused(), HasSubstr("events/t: its data lie in other files"));
}

TEST_F(Hdf5Made, LinksIntoOtherFilesAreNotFollowed) {
  addEvents({1, 2, 3});
  finish();
  const std::string other = directory_.file("other.h5");
  file_ = Hdf5Handle(H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  H5Lcreate_external(path_.c_str(), "events", file_.id(), "events", H5P_DEFAULT, H5P_DEFAULT);
  finish();
  EXPECT_THAT(refusal(other), HasSubstr("has neither events nor frames"));
}

/// Chunks of zlib's that hold far more than they should.
TEST_F(Hdf5Made, BombIsRefused) {
  constexpr hsize_t kCount = 2'000'000;
  const Hdf5Handle deflated(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  const hsize_t chunk = kCount;
  H5Pset_chunk(deflated.id(), 1, &chunk);
  H5Pset_deflate(deflated.id(), 9);
  addEvents(std::vector<std::int64_t>(kCount, 1));
  H5Ldelete(file_.id(), "events/p", H5P_DEFAULT);
  creation_ = deflated.id();
  const std::vector<std::uint8_t> zeros(std::size_t{64} << 20);
  {
    // Made by HDF5 itself as a chunk of its own, and put where a small one belongs.
    const hsize_t large = zeros.size();
    const Hdf5Handle whole(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_chunk(whole.id(), 1, &large);
    H5Pset_deflate(whole.id(), 1);
    creation_ = whole.id();
    const Hdf5Handle source = add("bomb", H5T_NATIVE_UINT8, {large}, zeros);
    H5Dflush(source.id());
    const hsize_t first = 0;
    hsize_t stored = 0;
    ASSERT_GE(H5Dget_chunk_storage_size(source.id(), &first, &stored), 0);
    std::vector<std::uint8_t> bytes(stored);
    std::uint32_t filters = 0;
    ASSERT_GE(H5Dread_chunk(source.id(), H5P_DEFAULT, &first, &filters, bytes.data()), 0);
    creation_ = deflated.id();
    const Hdf5Handle target = add<std::uint8_t>("events/p", H5T_NATIVE_UINT8, {kCount}, {});
    ASSERT_GE(H5Dwrite_chunk(target.id(), H5P_DEFAULT, 0, &first, bytes.size(), bytes.data()), 0);
    EXPECT_GT(bytes.size(), 200'000u);
  }
  creation_ = H5P_DEFAULT;
  const RecordingContent content = readAll(*open());
  EXPECT_THAT(content.events, IsEmpty());
  EXPECT_THAT(content.damage, Not(IsEmpty()));
  EXPECT_THAT(
      content.damage,
      Each(Field(&RecordingDamage::what,
                 HasSubstr("events/p: the chunk at 0 is damaged: expected 2000000 bytes"))));
}

/// Without filters; HDF5 itself reads such a chunk beyond its end.
TEST_F(Hdf5Made, ChunksOfOddSizesAreRefused) {
  addEvents({1, 2, 3, 4});
  H5Ldelete(file_.id(), "events/p", H5P_DEFAULT);
  {
    const Hdf5Handle chunked(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    const hsize_t chunk = 2;
    H5Pset_chunk(chunked.id(), 1, &chunk);
    creation_ = chunked.id();
    const Hdf5Handle target = add<std::uint8_t>("events/p", H5T_NATIVE_UINT8, {4}, {});
    const hsize_t first = 0;
    const std::vector<std::uint8_t> bytes = {1, 1, 1};
    ASSERT_GE(H5Dwrite_chunk(target.id(), H5P_DEFAULT, 0, &first, bytes.size(), bytes.data()), 0);
  }
  creation_ = H5P_DEFAULT;
  EXPECT_THAT(refused(),
              HasSubstr("made.h5, events/p: it has 3 bytes, expected whole chunks of 2"));
}

std::vector<char> bytesOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void writeBytes(const std::string& path, const std::vector<char>& bytes, std::size_t count) {
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(count));
}

TEST(Hdf5Damage, OfCompressedEventsIsNamedAndTheOthersAreRead) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("damaged.h5");
  std::vector<char> bytes = bytesOf(dataFile("e2calib.h5"));
  {
    const Hdf5Handle file(H5Fopen(dataFile("e2calib.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT),
                          H5Fclose);
    const Hdf5Handle column(H5Dopen2(file.id(), "x", H5P_DEFAULT), H5Dclose);
    const hsize_t first = 0;
    hsize_t size = 0;
    ASSERT_GE(H5Dget_chunk_storage_size(column.id(), &first, &size), 0);
    std::vector<char> chunk(size);
    std::uint32_t filters = 0;
    ASSERT_GE(H5Dread_chunk(column.id(), H5P_DEFAULT, &first, &filters, chunk.data()), 0);
    const auto place = std::search(bytes.begin(), bytes.end(), chunk.begin(), chunk.end());
    ASSERT_NE(place, bytes.end());
    char& middle = *(place + static_cast<std::ptrdiff_t>(size / 2));
    middle = static_cast<char>(~middle);
  }
  writeBytes(path, bytes, bytes.size());
  const RecordingContent content = readAll(*openHdf5(path));
  EXPECT_THAT(content.events, IsEmpty());
  ASSERT_THAT(content.damage, SizeIs(1));
  EXPECT_THAT(content.damage[0].what,
              HasSubstr("events 0 to 2435 cannot be read, of x: the chunk at 0 is damaged"));
}

TEST(Hdf5Damage, OfAnyByteOfColumnsIsSurvived) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("damaged.h5");
  std::vector<char> bytes = bytesOf(dataFile("dsec.h5"));
  constexpr std::size_t kStep = 97;
  std::size_t refused = 0;
  for (std::size_t place = 0; place < bytes.size(); place += kStep) {
    bytes[place] = static_cast<char>(~bytes[place]);
    writeBytes(path, bytes, bytes.size());
    bytes[place] = static_cast<char>(~bytes[place]);
    try {
      readAll(*openHdf5(path));
    } catch (const RecordingError& error) {
      EXPECT_THAT(error.what(), HasSubstr(path));
      ++refused;
    }
  }
  EXPECT_GT(refused, 0u);
}

TEST(Hdf5Damage, OfAFileThatIsCutIsNamed) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("damaged.h5");
  for (const char* name : {"dsec.h5", "event_utils.h5", "mvsec.hdf5", "v2e.h5"}) {
    const std::vector<char> bytes = bytesOf(dataFile(name));
    for (const std::size_t size : {std::size_t{0}, std::size_t{8}, bytes.size() / 2}) {
      writeBytes(path, bytes, size);
      EXPECT_THAT(refusal(path), HasSubstr("damaged.h5 cannot be opened as HDF5"));
    }
  }
}

}  // namespace
}  // namespace fast_edi
