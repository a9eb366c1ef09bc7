#include "bags/written_connections.hpp"

#include <gtest/gtest.h>
#include <boost/make_shared.hpp>

#include <cstdint>
#include <string>

namespace fast_edi {
namespace {

BagConnection connectionOf(std::uint32_t id, const std::string& topic) {
  BagConnection connection;
  connection.id = id;
  connection.topic = topic;
  connection.datatype = "type";
  connection.header = boost::make_shared<ros::M_string>();
  (*connection.header)["callerid"] = topic;
  return connection;
}

TEST(WrittenConnections, NumbersThemInOrder) {
  WrittenConnections connections;
  EXPECT_EQ(connections.of(connectionOf(7, "/a")).id, 0u);
  EXPECT_EQ(connections.ofOwn(connectionOf(0, "/own")).id, 1u);
  EXPECT_EQ(connections.of(connectionOf(3, "/b")).id, 2u);
  EXPECT_EQ(connections.of(connectionOf(7, "/a")).id, 0u);
  EXPECT_EQ(connections.ofOwn(connectionOf(0, "/own")).id, 1u);
  EXPECT_EQ(connections.all().size(), 3u);
}

TEST(WrittenConnections, KeepsIdsAndFillsGaps) {
  WrittenConnections connections;
  connections.keep({{0, connectionOf(0, "/a")},
                    {2, connectionOf(2, "/b")},
                    {UINT32_MAX, connectionOf(UINT32_MAX, "/c")}});
  EXPECT_EQ(connections.of(connectionOf(2, "/b")).id, 2u);
  EXPECT_EQ(connections.of(connectionOf(UINT32_MAX, "/c")).topic, "/c");
  EXPECT_EQ(connections.ofOwn(connectionOf(0, "/own")).id, 1u);
  EXPECT_EQ(connections.ofOwn(connectionOf(0, "/more")).id, 3u);
  EXPECT_EQ(connections.all().size(), 5u);
}

TEST(WrittenConnections, AnOwnTopicIsNotThatOfTheSource) {
  WrittenConnections connections;
  connections.keep({{0, connectionOf(0, "/a")}});
  const BagConnection& own = connections.ofOwn(connectionOf(0, "/a"));
  EXPECT_EQ(own.id, 1u);
  EXPECT_EQ(own.header->at("type"), "type");
  EXPECT_EQ(own.header->count("callerid"), 0u);
  EXPECT_EQ(connections.all().at(0).header->at("callerid"), "/a");
}

TEST(WrittenConnections, EachIsNewOnce) {
  WrittenConnections connections;
  const BagConnection& connection = connections.of(connectionOf(4, "/a"));
  EXPECT_TRUE(connections.isNew(connection));
  EXPECT_FALSE(connections.isNew(connection));
  EXPECT_TRUE(connections.isNew(connections.of(connectionOf(5, "/b"))));
}

}  // namespace
}  // namespace fast_edi
