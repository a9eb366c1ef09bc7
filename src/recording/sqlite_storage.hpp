/// \file
/// SQLite files of rosbag2 (`*.db3`): tables `topics` and `messages`
/// (https://github.com/ros2/rosbag2/tree/rolling/rosbag2_storage_sqlite3).
///
/// Times and row numbers of all messages are read first, 16 bytes each; messages then one by one in
/// the order of their times. Where the tree of rows is damaged, it is read from both ends.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "recording/packet_compression.hpp"
#include "recording/rosbag2_storage.hpp"
#include "recording/sqlite_file.hpp"

namespace fast_edi {

class SqliteStorage : public Rosbag2Storage {
 public:
  static constexpr char kMagic[] = "SQLite format 3";

  /// \param database must outlive this
  /// \param log the log of writes that an interrupted recorder leaves; null for none
  /// \param name of the file, for messages
  /// \throws RecordingError when it has no tables of messages that can be read
  SqliteStorage(const ByteSource& database, const ByteSource* log, const std::string& name);

  std::string format() const override;
  const std::vector<Rosbag2Topic>& topics() const override { return topics_; }
  bool next(Rosbag2Message& message) override;
  double progress() const override;

 protected:
  void restart() override { done_ = 0; }

 private:
  struct Row {
    std::int64_t time_ns = 0;
    std::int64_t id = 0;
  };

  std::string fault() const;
  /// Notes when the file is shorter than its head says.
  void checkSize(const ByteSource& database);
  void readTopics(const std::string& name);
  void readRows();
  /// Appends rows in one direction. \return false when it ended at damage
  bool readRows(bool descending, std::vector<Row>& rows);

  SqliteFile file_;
  SqliteStatement message_;  ///< selects one
  std::vector<Rosbag2Topic> topics_;
  std::map<std::int64_t, std::size_t> numbers_;  ///< from the table's numbers to topics_
  std::vector<Row> rows_;
  std::size_t done_ = 0;
};

}  // namespace fast_edi
