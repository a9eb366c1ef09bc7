#include "evaluation/method_options.hpp"

#include <fstream>

#include <gmock/gmock.h>

#include "evaluation/message_of.hpp"
#include "support/temporary_directory.hpp"

namespace fast_edi {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::string faultOf(const std::string& text) {
  std::vector<std::string> taken = methodNames();
  return messageOf<std::invalid_argument>([&] { namedFile("--column", text, taken); });
}

TEST(NamedFileTest, SplitsAtTheFirstEqualsSign) {
  std::vector<std::string> taken;
  const NamedFile named = namedFile("--column", "MPR net=a=b.bag", taken);
  EXPECT_EQ(named.name, "MPR net");
  EXPECT_EQ(named.file, "a=b.bag");
  EXPECT_THAT(taken, Contains("MPR net"));
}

TEST(NamedFileTest, SaysWhatIsWrong) {
  for (const char* text : {"", "out.bag", "=out.bag", "name="}) {
    EXPECT_THAT(faultOf(text), HasSubstr("--column: expected NAME=FILE, got \"")) << text;
  }
  EXPECT_THAT(faultOf("a|b=out.bag"), HasSubstr("expected a name without"));
  EXPECT_THAT(faultOf("a,b=out.bag"), HasSubstr("expected a name without"));
  EXPECT_THAT(faultOf("ours=out.bag"), HasSubstr("there is a column \"ours\" already"));
}

TEST(NamedFileTest, TakesANameOnce) {
  std::vector<std::string> taken;
  namedFile("--column", "one=out.bag", taken);
  EXPECT_THROW(namedFile("--network", "one=net.onnx", taken), std::invalid_argument);
}

TEST(RecordedTopicTest, ATopicFollowsTheLastColon) {
  EXPECT_EQ(recordedTopic("out.bag", "/d").recording, "out.bag");
  EXPECT_EQ(recordedTopic("out.bag", "/d").topic, "/d");
  EXPECT_EQ(recordedTopic("a:b.bag:/e", "/d").recording, "a:b.bag");
  EXPECT_EQ(recordedTopic("a:b.bag:/e", "/d").topic, "/e");
}

TEST(RecordedTopicTest, AFileWithAColonInItsNameHasNoTopic) {
  const TemporaryDirectory directory;
  const std::string path = directory.file("of:12:30.bag");
  std::ofstream(path) << "";
  EXPECT_EQ(recordedTopic(path, "/d").recording, path);
  EXPECT_EQ(recordedTopic(path, "/d").topic, "/d");
  EXPECT_EQ(recordedTopic(path + ":/e", "/d").topic, "/e");
}

}  // namespace
}  // namespace fast_edi
