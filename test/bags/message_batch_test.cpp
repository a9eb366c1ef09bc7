#include "bags/message_batch.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include <boost/make_shared.hpp>

namespace fast_edi {
namespace {

ReadMessage messageOf(const BagConnection& connection, const std::vector<std::uint8_t>& bytes) {
  ReadMessage read;
  read.message.connection = &connection;
  read.message.data = bytes.data();
  read.message.size = static_cast<std::uint32_t>(bytes.size());
  return read;
}

TEST(MessageBatch, HasBytesOfItsOwn) {
  const BagConnection connection;
  MessageBatch batch;
  std::vector<std::uint8_t> source;  // the same memory for each message, as a reader does it
  for (std::uint8_t i = 0; i < 100; ++i) {
    source.assign(i, i);
    batch.add(messageOf(connection, source));
  }
  batch.complete();
  ASSERT_EQ(batch.entries().size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    const BagMessage& message = batch.entries()[i].read.message;
    EXPECT_EQ(message.connection, &connection);
    EXPECT_EQ(std::string(message.data, message.data + message.size),
              std::string(i, static_cast<char>(i)));
  }
  EXPECT_EQ(batch.bytes(), 99u * 100u / 2u);
  batch.endBefore(30);
  EXPECT_EQ(batch.entries().size(), 30u);
  EXPECT_EQ(batch.entries().back().read.message.size, 29u);
}

TEST(MessageBatch, IsFullSomewhere) {
  const BagConnection connection;
  MessageBatch batch;
  EXPECT_FALSE(batch.isFull());
  const std::vector<std::uint8_t> megabyte(1 << 20);
  batch.add(messageOf(connection, megabyte));
  EXPECT_TRUE(batch.isFull());
}

TEST(MessageBatch, StartsAnewWhenCleared) {
  const BagConnection connection;
  MessageBatch batch;
  batch.add(messageOf(connection, std::vector<std::uint8_t>(1 << 20)));
  batch.complete();
  batch.clear();
  EXPECT_TRUE(batch.entries().empty());
  EXPECT_EQ(batch.bytes(), 0u);
  EXPECT_FALSE(batch.isFull());
  const std::vector<std::uint8_t> bytes = {1, 2, 3};
  batch.add(messageOf(connection, bytes));
  batch.complete();
  ASSERT_EQ(batch.entries().size(), 1u);
  const BagMessage& message = batch.entries()[0].read.message;
  EXPECT_EQ(std::vector<std::uint8_t>(message.data, message.data + message.size), bytes);
}

TEST(MessageBatch, CountsImages) {
  MessageBatch batch;
  batch.addEnd(ros::Time(12, 5));
  batch.complete();
  MessageBatch::Entry& end = batch.entries().at(0);
  EXPECT_EQ(end.read.message.connection, nullptr);
  EXPECT_EQ(end.read.message.time, ros::Time(12, 5));
  EXPECT_EQ(batch.bytes(), 0u);
  end.outputs.emplace_back();
  end.outputs.back().image = boost::make_shared<sensor_msgs::Image>();
  end.outputs.back().image->data.resize(1000);
  end.outputs.back().latent.push_back(boost::make_shared<sensor_msgs::Image>());
  end.outputs.back().latent.back()->data.resize(200);
  EXPECT_EQ(batch.bytes(), 1200u);
}

}  // namespace
}  // namespace fast_edi
