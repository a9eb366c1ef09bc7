#include "zip/zip_archive.hpp"

#include <gmock/gmock.h>
#include <zip.h>

#include <cstdint>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fast_edi/recording/recording_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

std::string contentOf(ByteStream& stream) {
  std::string content;
  std::vector<std::uint8_t> block(1000);
  while (const std::size_t count = stream.read(block.data(), block.size())) {
    content.append(block.begin(), block.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return content;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const RecordingError& error) {
    return error.what();
  }
  return "not refused";
}

class ZipArchiveTest : public ::testing::Test {
 protected:
  void write(const std::map<std::string, std::string>& members, int method = ZIP_CM_DEFLATE,
             const char* password = nullptr) const {
    int code = 0;
    zip_t* archive = zip_open(path_.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
    ASSERT_NE(archive, nullptr);
    for (const auto& [name, content] : members) {
      zip_source_t* source = zip_source_buffer(archive, content.data(), content.size(), 0);
      const zip_int64_t index = zip_file_add(archive, name.c_str(), source, 0);
      ASSERT_GE(index, 0);
      zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), method, 0);
      if (password != nullptr) {
        ASSERT_EQ(zip_file_set_encryption(archive, static_cast<zip_uint64_t>(index),
                                          ZIP_EM_TRAD_PKWARE, password),
                  0);
      }
    }
    ASSERT_EQ(zip_close(archive), 0);
  }

  std::vector<char> bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  void writeBytes(const std::vector<char>& bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("a.zip");
};

TEST_F(ZipArchiveTest, GivesItsMembers) {
  std::string text;
  for (int i = 0; i < 50'000; ++i) {
    text += std::to_string(i * 7919) + "\n";
  }
  for (const int method : {ZIP_CM_DEFLATE, ZIP_CM_STORE}) {
    write({{"events.txt", text}, {"images/a.png", "a"}, {"images/b.png", "b"}, {"images/c/d", ""}},
          method);
    const std::unique_ptr<FileSet> files = openZip(path_);
    EXPECT_TRUE(files->has("events.txt"));
    EXPECT_TRUE(files->has("./images//a.png"));
    EXPECT_FALSE(files->has("images"));
    EXPECT_FALSE(files->has("a.png"));
    EXPECT_THAT(files->list("images"), UnorderedElementsAre("images/a.png", "images/b.png"));
    const std::unique_ptr<ByteStream> events = files->open("events.txt");
    EXPECT_EQ(events->size(), text.size());
    // Several at once.
    EXPECT_EQ(contentOf(*files->open("images/b.png")), "b");
    EXPECT_EQ(contentOf(*events), text);
    EXPECT_EQ(events->fault(), "");
    EXPECT_EQ(files->tail("events.txt", 10), text.substr(text.size() - 10));
    EXPECT_EQ(files->tail("images/a.png", 10), "a");
    EXPECT_EQ(files->pathOf("events.txt"), path_ + ", events.txt");
    EXPECT_THAT(refusal([&] { files->open("x"); }), HasSubstr("a.zip, x is not in the archive"));
  }
}

TEST_F(ZipArchiveTest, OfOneFolderIsThatFolder) {
  write({{"slider/events.txt", "e"}, {"slider/images/a.png", "a"}, {"__MACOSX/slider/._a", "x"}});
  const std::unique_ptr<FileSet> files = openZip(path_);
  EXPECT_EQ(contentOf(*files->open("events.txt")), "e");
  EXPECT_TRUE(files->has("images/a.png"));
}

TEST_F(ZipArchiveTest, BombIsRefused) {
  write({{"events.txt", std::string(std::size_t{80} << 20, '0')}, {"b", "b"}});
  const std::unique_ptr<FileSet> files = openZip(path_);
  EXPECT_THAT(refusal([&] { files->open("events.txt"); }),
              AllOf(HasSubstr("a.zip, events.txt states 83886080 bytes, compressed to "),
                    HasSubstr("expected at most 200 times as many")));
  EXPECT_EQ(contentOf(*files->open("b")), "b");
}

/// Whose directory states fewer bytes than there are.
TEST_F(ZipArchiveTest, MemberThatIsLargerThanItStatesIsCut) {
  constexpr std::uint32_t kSize = 70'001;
  write({{"events.txt", std::string(kSize, '0')}});
  std::vector<char> all = bytes();
  constexpr std::uint32_t kStated = 123;
  std::size_t found = 0;
  for (std::size_t i = 0; i + sizeof(kSize) <= all.size(); ++i) {
    if (std::equal(all.begin() + static_cast<std::ptrdiff_t>(i),
                   all.begin() + static_cast<std::ptrdiff_t>(i + sizeof(kSize)),
                   reinterpret_cast<const char*>(&kSize))) {
      std::copy_n(reinterpret_cast<const char*>(&kStated), sizeof(kStated),
                  all.begin() + static_cast<std::ptrdiff_t>(i));
      ++found;
    }
  }
  ASSERT_EQ(found, 2u);
  writeBytes(all);
  const std::unique_ptr<ByteStream> member = openZip(path_)->open("events.txt");
  EXPECT_EQ(contentOf(*member).size(), kStated);
  EXPECT_THAT(member->fault(), HasSubstr("more than the 123 bytes that the archive states"));
}

TEST_F(ZipArchiveTest, DamageIsNamed) {
  std::string text;
  for (int i = 0; i < 20'000; ++i) {
    text += std::to_string(i * 7919) + "\n";
  }
  write({{"events.txt", text}}, ZIP_CM_STORE);
  std::vector<char> all = bytes();
  all[1000] = static_cast<char>(~all[1000]);
  writeBytes(all);
  const std::unique_ptr<ByteStream> member = openZip(path_)->open("events.txt");
  contentOf(*member);
  EXPECT_THAT(member->fault(), HasSubstr("damaged behind"));
  for (std::size_t size : {std::size_t{0}, std::size_t{10}, all.size() / 2}) {
    writeBytes({all.begin(), all.begin() + static_cast<std::ptrdiff_t>(size)});
    EXPECT_THAT(refusal([&] { openZip(path_); }), HasSubstr("cannot be opened as a zip archive"));
  }
  EXPECT_THAT(refusal([&] { openZip(directory_.file("none")); }),
              HasSubstr("cannot be opened as a zip archive (No such file"));
}

TEST_F(ZipArchiveTest, OtherKindsOfMembersAreRefused) {
  write({{"a", "text"}}, ZIP_CM_BZIP2);
  EXPECT_THAT(refusal([&] { openZip(path_)->open("a"); }),
              HasSubstr("compressed by the method 12, expected deflate (8) or none (0)"));
  write({{"a", "text"}}, ZIP_CM_DEFLATE, "secret");
  EXPECT_THAT(refusal([&] { openZip(path_)->open("a"); }),
              HasSubstr("a.zip, a is encrypted, expected it without a password"));
}

}  // namespace
}  // namespace fast_edi
