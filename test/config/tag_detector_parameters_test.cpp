#include "fast_edi/config/tag_detector_parameters.hpp"

#include <string>

#include <gmock/gmock.h>

#include "fast_edi/config/parameters_from_yaml.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;

std::string refusal(const std::string& yaml) {
  try {
    tagDetectorParametersFromYaml(YAML::Load(yaml));
  } catch (const ParameterError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(TagDetectorParametersTest, NothingGivenMeansDefaults) {
  const TagDetectorParameters parameters = tagDetectorParametersFromYaml(YAML::Load(""));
  EXPECT_EQ(parameters.detector.family, "36h11");
  EXPECT_EQ(parameters.detector.threads, 1);
  EXPECT_EQ(parameters.detector.decimate, 1.0);
  EXPECT_TRUE(parameters.lazy);
}

TEST(TagDetectorParametersTest, EveryKeyIsRead) {
  const TagDetectorParameters parameters = tagDetectorParametersFromYaml(
      YAML::Load("{family: 25h9, tag_size_m: 0.05, decimate: 2, threads: 3, corrected_bits: 1, "
                 "rectified: true, frame_id: camera, lazy: false}"));
  EXPECT_EQ(parameters.detector.family, "25h9");
  EXPECT_EQ(parameters.tag_size_m, 0.05);
  EXPECT_EQ(parameters.detector.decimate, 2.0);
  EXPECT_EQ(parameters.detector.threads, 3);
  EXPECT_EQ(parameters.detector.corrected_bits, 1);
  EXPECT_TRUE(parameters.rectified);
  EXPECT_EQ(parameters.frame_id, "camera");
  EXPECT_FALSE(parameters.lazy);
  EXPECT_EQ(tagDetectorDescriptions().size(), 8U) << "a key that this test does not know";
}

TEST(TagDetectorParametersTest, FaultsAreNamedAllAtOnce) {
  const std::string message = refusal("{famly: 36h11, family: 36h12, tag_size_m: 0, threads: 1.5}");
  EXPECT_THAT(message, HasSubstr("famly: unknown, the nearest known key is family"));
  EXPECT_THAT(message, HasSubstr("family: found '36h12', expected one of: 36h11, "));
  EXPECT_THAT(message, HasSubstr("tag_size_m: found '0', expected a number 0.001..100 [m]"));
  EXPECT_THAT(message, HasSubstr("threads: found '1.5', expected an integer 1..64"));
  EXPECT_THAT(refusal("{decimate: 0.5}"), HasSubstr("decimate: found '0.5'"));
  EXPECT_THAT(refusal("[1]"), HasSubstr("expected a map"));
}

TEST(TagDetectorParametersTest, RangesEndWhereTheySay) {
  for (const char* good :
       {"{tag_size_m: 0.001}", "{tag_size_m: 100}", "{decimate: 1}", "{decimate: 16}",
        "{threads: 1}", "{threads: 64}", "{corrected_bits: 0}", "{corrected_bits: 2}"}) {
    EXPECT_EQ(refusal(good), "accepted");
  }
  for (const char* bad :
       {"{tag_size_m: 0.00099}", "{tag_size_m: 100.1}", "{decimate: 0.99}", "{decimate: 16.01}",
        "{threads: 0}", "{threads: 65}", "{corrected_bits: -1}", "{corrected_bits: 3}"}) {
    EXPECT_THAT(refusal(bad), HasSubstr(", expected a")) << bad;
  }
}

}  // namespace
}  // namespace fast_edi
