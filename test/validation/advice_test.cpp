#include "validation/advice.hpp"

#include <gmock/gmock.h>

namespace fast_edi {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr int kRemedies = static_cast<int>(Remedy::kBiases) + 1;

TEST(Advice, NamesSettingsOfTheRosDriverForItsRecordingsAlone) {
  EXPECT_EQ(adviceFor(Remedy::kBackgroundActivityFilterOff, RecordingOrigin::kRosDriver),
            "driver: background_activity_filter_enabled: false");
  for (int i = 0; i < kRemedies; ++i) {
    for (const RecordingOrigin origin : {RecordingOrigin::kDv, RecordingOrigin::kOther}) {
      const std::string text = adviceFor(static_cast<Remedy>(i), origin);
      EXPECT_THAT(text, Not(IsEmpty()));
      EXPECT_THAT(text, Not(AnyOf(HasSubstr("driver"), HasSubstr("rosbag"), HasSubstr("_enabled"),
                                  HasSubstr("aps_roi"), HasSubstr("frame_mode"),
                                  HasSubstr("polarity_"), HasSubstr("pixel_"))));
    }
    EXPECT_THAT(adviceFor(static_cast<Remedy>(i), RecordingOrigin::kRosDriver), Not(IsEmpty()));
  }
}

TEST(Advice, NamesDvForItsRecordingsAlone) {
  EXPECT_THAT(adviceFor(Remedy::kRefractoryFilterOff, RecordingOrigin::kDv),
              HasSubstr("DV: the camera's refractory period filter off"));
  for (int i = 0; i < kRemedies; ++i) {
    for (const RecordingOrigin origin : {RecordingOrigin::kRosDriver, RecordingOrigin::kOther}) {
      EXPECT_THAT(adviceFor(static_cast<Remedy>(i), origin), Not(HasSubstr("DV")));
    }
  }
}

}  // namespace
}  // namespace fast_edi
