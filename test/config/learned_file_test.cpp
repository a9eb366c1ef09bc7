#include "fast_edi/config/learned_file.hpp"

#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fast_edi/config/parameter_error.hpp"
#include "fast_edi/config/parameters_from_yaml.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

namespace fs = std::filesystem;

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const ContrastThresholds kThresholds{0.2512, 0.3};
constexpr std::int64_t kDelay_ns = 1'234'000;

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

class LearnedFileTest : public ::testing::Test {
 protected:
  void write(const std::string& text) const { std::ofstream(path_) << text; }

  const TemporaryDirectory directory_;
  const std::string path_ = directory_.file("learned.yaml");
};

TEST_F(LearnedFileTest, IsAConfiguration) {
  LearnedFile(path_).write(kThresholds, kDelay_ns);
  const DeblurParameters parameters = parametersFromFile(path_).deblur;
  EXPECT_EQ(parameters.thresholds, kThresholds);
  EXPECT_EQ(parameters.event_delay_ns, kDelay_ns);
  EXPECT_FALSE(fs::exists(path_ + ".active"));
}

TEST_F(LearnedFileTest, GivesOverrides) {
  LearnedFile(path_).write(kThresholds, -kDelay_ns);
  EXPECT_THAT(learnedOverrides(path_),
              ElementsAre("contrast_threshold_on:=0.2512", "contrast_threshold_off:=0.3000",
                          "event_delay_us:=-1234"));
}

TEST_F(LearnedFileTest, LeavesNothingUnlessWritten) {
  { const LearnedFile unused(path_); }
  EXPECT_TRUE(fs::is_empty(fs::path(path_).parent_path()));
  write("kept: true\n");
  { const LearnedFile unused(path_); }
  EXPECT_TRUE(fs::exists(path_));
  EXPECT_FALSE(fs::exists(path_ + ".active"));
}

TEST_F(LearnedFileTest, ReplacesAnOlderOne) {
  LearnedFile(path_).write({0.1, 0.1}, 0);
  LearnedFile(path_).write(kThresholds, kDelay_ns);
  EXPECT_EQ(parametersFromFile(path_).deblur.thresholds, kThresholds);
}

TEST_F(LearnedFileTest, SaysWhyItCannotBeWritten) {
  EXPECT_THAT(messageOf([] { LearnedFile("/nonexistent/learned.yaml"); }),
              AllOf(HasSubstr("/nonexistent/learned.yaml"), HasSubstr("No such file")));
}

TEST_F(LearnedFileTest, RefusesWhatIsNotLearned) {
  write("contrast_threshold_on: 0.3\ncontrast_threshold_off: 0.2\nfilter: false\n");
  EXPECT_THAT(messageOf([this] { learnedOverrides(path_); }),
              AllOf(HasSubstr(path_), HasSubstr("filter"), HasSubstr("event_delay_us")));
  write("contrast_threshold_on: 0.3\ncontrast_threshold_off: 20\n");
  EXPECT_THAT(messageOf([this] { learnedOverrides(path_); }),
              AllOf(HasSubstr(path_), HasSubstr("contrast_threshold_off")));
  EXPECT_THROW(learnedOverrides(directory_.file("none.yaml")), ParameterError);
}

}  // namespace
}  // namespace fast_edi
