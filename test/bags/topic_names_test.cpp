#include "fast_edi/bags/topic_names.hpp"

#include <map>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/message_traits.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Int32.h>

#include "fast_edi/messages/event_array.hpp"

namespace fast_edi {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

using Connections = std::map<std::uint32_t, BagConnection>;

template <typename Message>
void add(const std::string& topic, Connections& connections) {
  BagConnection connection;
  connection.topic = topic;
  connection.datatype = ros::message_traits::datatype<Message>();
  connection.md5sum = ros::message_traits::md5sum<Message>();
  connection.messages = 10;
  connections[static_cast<std::uint32_t>(connections.size())] = connection;
}

/// Of another driver, with its own names.
Connections otherDriver() {
  Connections connections;
  add<EventArray>("/cam/events", connections);
  add<sensor_msgs::Image>("/cam/image", connections);
  return connections;
}

TEST(GuessTopics, TakesTheOnlyOnesOfTheirTypeAndSaysSo) {
  const Connections connections = otherDriver();
  const TopicNames guessed = guessTopics({}, connections);
  EXPECT_EQ(guessed.events, "/cam/events");
  EXPECT_EQ(guessed.image, "/cam/image");
  const std::string text = guessText({}, guessed, connections);
  EXPECT_THAT(text, HasSubstr("no messages on /dvs/events: /cam/events is taken as the events"));
  EXPECT_THAT(text, HasSubstr("no messages on /dvs/image_raw: /cam/image is taken as the frames"));
  EXPECT_EQ(checkTopics(guessed, connections), "");
}

TEST(GuessTopics, KeepsNamesThatHaveMessages) {
  Connections connections = otherDriver();
  add<EventArray>("/dvs/events", connections);
  add<sensor_msgs::Image>("/dvs/image_raw", connections);
  const TopicNames guessed = guessTopics({}, connections);
  EXPECT_EQ(guessed.events, "/dvs/events");
  EXPECT_THAT(guessText({}, guessed, connections), IsEmpty());
}

TEST(GuessTopics, KeepsNamesThatSomebodyGave) {
  TopicNames named;
  named.image = "/cam/imagee";
  const TopicNames guessed = guessTopics(named, otherDriver());
  EXPECT_EQ(guessed.image, "/cam/imagee");
  EXPECT_EQ(guessed.events, "/cam/events");
  EXPECT_THAT(checkTopics(guessed, otherDriver()), HasSubstr("/cam/imagee"));
}

TEST(GuessTopics, AmongSeveralOfATypeTakesNone) {
  Connections connections = otherDriver();
  add<sensor_msgs::Image>("/cam/other", connections);
  const TopicNames guessed = guessTopics({}, connections);
  EXPECT_EQ(guessed.image, "/dvs/image_raw");
  EXPECT_THAT(checkTopics(guessed, connections), HasSubstr("/dvs/image_raw"));
}

TEST(GuessTopics, TrueFramesAndOutputsAreNoFrames) {
  Connections connections;
  add<EventArray>("/dvs/events", connections);
  add<sensor_msgs::Image>("/dvs/ground_truth/image_raw", connections);
  EXPECT_EQ(guessTopics({}, connections).image, "/dvs/image_raw");
  EXPECT_THAT(
      checkTopics(guessTopics({}, connections), connections),
      HasSubstr("topic /dvs/image_raw (--image, a sensor_msgs/Image) is not in the recording"));
  for (const char* topic :
       {"/dvs/deblurred/image_raw", "/dvs/latent/image_raw", "/dvs/comparison", "/cam/image"}) {
    add<sensor_msgs::Image>(topic, connections);
  }
  EXPECT_EQ(guessTopics({}, connections).image, "/cam/image");
}

TEST(CheckTopics, ListsWhatIsThereWithTheMessagesWhereTheyWereCounted) {
  Connections connections = otherDriver();
  EXPECT_THAT(checkTopics({}, connections),
              HasSubstr("/cam/events  dvs_msgs/EventArray  10 messages\n"));
  for (auto& entry : connections) {
    entry.second.counted = false;
  }
  EXPECT_THAT(checkTopics({}, connections), HasSubstr("/cam/events  dvs_msgs/EventArray\n"));
}

TEST(GuessTopics, AnIntegerIsAnExposureOnlyByItsName) {
  Connections connections = otherDriver();
  add<std_msgs::Int32>("/battery/level", connections);
  TopicNames guessed = guessTopics({}, connections);
  EXPECT_EQ(guessed.exposure, "/dvs/exposure");
  EXPECT_THAT(guessText({}, guessed, connections),
              HasSubstr("/battery/level is a std_msgs/Int32 and not taken as exposure times"));

  add<std_msgs::Int32>("/cam/exposure", connections);
  guessed = guessTopics({}, connections);
  EXPECT_EQ(guessed.exposure, "/cam/exposure");
  const std::string text = guessText({}, guessed, connections);
  EXPECT_THAT(text, HasSubstr("/cam/exposure is taken as the exposure times"));
  EXPECT_THAT(text, Not(HasSubstr("/battery")));
}

}  // namespace
}  // namespace fast_edi
