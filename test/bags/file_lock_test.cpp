#include "fast_edi/bags/file_lock.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fast_edi/bags/bag_error.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

class FileLockTest : public ::testing::Test {
 protected:
  FileLockTest() : path_(directory_.file("file")) { std::ofstream(path_) << "content"; }

  const TemporaryDirectory directory_;
  const std::string path_;
};

TEST_F(FileLockTest, OneHoldsIt) {
  FileLock first;
  EXPECT_FALSE(first.isHeld());
  EXPECT_TRUE(first.take(path_));
  EXPECT_TRUE(first.isHeld());
  FileLock second;
  EXPECT_FALSE(second.take(path_));
  EXPECT_FALSE(second.isHeld());
  first.release();
  EXPECT_FALSE(first.isHeld());
  EXPECT_TRUE(second.take(path_));
}

TEST_F(FileLockTest, ComesBackAtTheEnd) {
  {
    FileLock first;
    ASSERT_TRUE(first.take(path_));
  }
  FileLock second;
  EXPECT_TRUE(second.take(path_));
}

TEST_F(FileLockTest, LeavesTheFileAsItIs) {
  FileLock lock;
  ASSERT_TRUE(lock.take(path_));
  EXPECT_EQ(std::filesystem::file_size(path_), 7u);
}

TEST_F(FileLockTest, NamesAFileThatIsMissing) {
  FileLock lock;
  EXPECT_THROW(lock.take(directory_.file("missing")), BagError);
  EXPECT_FALSE(lock.isHeld());
}

}  // namespace
}  // namespace fast_edi
