#include "recording/sqlite_storage.hpp"

#include <algorithm>
#include <limits>
#include <tuple>

#include "fast_edi/recording/recording_error.hpp"

namespace fast_edi {
namespace {

/// More topics than any robot has.
constexpr std::size_t kMaxTopics = 100'000;

// The head of a file (https://www.sqlite.org/fileformat2.html#the_database_header), big endian.
constexpr std::size_t kHeadBytes = 100;
constexpr std::size_t kPageBytes = 16;  ///< 16 bits; 1: the largest
constexpr std::size_t kChanges = 24;
constexpr std::size_t kPages = 28;
constexpr std::size_t kChangesOfPages = 92;
constexpr std::uint64_t kLargestPage = 65'536;

std::string textColumn(sqlite3_stmt* statement, int column) {
  const unsigned char* text = sqlite3_column_text(statement, column);
  return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

}  // namespace

SqliteStorage::SqliteStorage(const ByteSource& database, const ByteSource* log,
                             const std::string& name)
    : file_(database, log, name) {
  if (log == nullptr) {
    checkSize(database);
  }
  readTopics(name);
  message_ = prepare(file_.handle(), "SELECT topic_id, data FROM messages WHERE rowid = ?");
  if (!message_) {
    throw RecordingError("cannot read " + name + ": the table of messages: " + fault());
  }
  readRows();
  keepNotes();
}

std::string SqliteStorage::fault() const {
  return std::string("SQLite: ") + sqlite3_errmsg(file_.handle());
}

void SqliteStorage::checkSize(const ByteSource& database) {
  std::vector<std::uint8_t> scratch;
  const std::uint8_t* head = database.read(0, kHeadBytes, scratch);
  if (head == nullptr) {
    return;
  }
  const auto number = [head](std::size_t place, std::size_t bytes) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
      value = value << 8 | head[place + i];
    }
    return value;
  };
  const std::uint64_t page_bytes =
      number(kPageBytes, 2) == 1 ? kLargestPage : number(kPageBytes, 2);
  const std::uint64_t expected = page_bytes * number(kPages, 4);
  // Only where both counters agree, the number of pages is up to date.
  if (number(kChanges, 4) == number(kChangesOfPages, 4) && expected > database.size()) {
    note(database.size(), "the file ends, expected " + std::to_string(expected) + " bytes: cut");
  }
}

void SqliteStorage::readTopics(const std::string& name) {
  // Real tables: a view could compute for ever.
  const SqliteStatement tables = prepare(
      file_.handle(),
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND sql LIKE 'CREATE TABLE%' AND "
      "name IN ('topics', 'messages')");
  if (!tables || sqlite3_step(tables.get()) != SQLITE_ROW) {
    throw RecordingError("cannot read " + name + ": " + fault());
  }
  if (sqlite3_column_int(tables.get(), 0) != 2) {
    throw RecordingError("cannot read " + name +
                         ": a SQLite database without the tables topics and messages of a rosbag2");
  }
  const SqliteStatement topics =
      prepare(file_.handle(), "SELECT id, name, type, serialization_format FROM topics");
  int status = topics ? SQLITE_ROW : SQLITE_ERROR;
  while (topics && topics_.size() < kMaxTopics &&
         (status = sqlite3_step(topics.get())) == SQLITE_ROW) {
    numbers_[sqlite3_column_int64(topics.get(), 0)] = topics_.size();
    topics_.push_back(
        {textColumn(topics.get(), 1), textColumn(topics.get(), 2), textColumn(topics.get(), 3)});
  }
  if (status != SQLITE_DONE && status != SQLITE_ROW) {
    if (topics_.empty()) {
      throw RecordingError("cannot read " + name + ": the table of topics: " + fault());
    }
    note(file_.lastOffset(), "the table of topics: " + fault());
  }
}

bool SqliteStorage::readRows(bool descending, std::vector<Row>& rows) {
  const SqliteStatement select =
      prepare(file_.handle(),
              descending ? "SELECT rowid, timestamp FROM messages NOT INDEXED ORDER BY rowid DESC"
                         : "SELECT rowid, timestamp FROM messages NOT INDEXED ORDER BY rowid");
  if (!select) {
    return false;
  }
  std::int64_t last = 0;
  int status = SQLITE_DONE;
  while ((status = sqlite3_step(select.get())) == SQLITE_ROW) {
    const std::int64_t id = sqlite3_column_int64(select.get(), 0);
    if (!rows.empty() && (descending ? id >= last : id <= last)) {
      return false;  // a damaged tree may lead in circles
    }
    rows.push_back({sqlite3_column_int64(select.get(), 1), id});
    last = id;
  }
  return status == SQLITE_DONE;
}

void SqliteStorage::readRows() {
  if (!readRows(false, rows_)) {
    const std::uint64_t offset = file_.lastOffset();
    const std::string what = fault();
    const std::int64_t before =
        rows_.empty() ? std::numeric_limits<std::int64_t>::min() : rows_.back().id;
    std::vector<Row> behind;
    readRows(true, behind);
    const auto end = std::find_if(behind.begin(), behind.end(),
                                  [before](const Row& row) { return row.id <= before; });
    note(offset, "the table of messages is damaged behind row " + std::to_string(rows_.size()) +
                     " (" + what + "); " + std::to_string(end - behind.begin()) +
                     " rows are found behind the damage");
    rows_.insert(rows_.end(), behind.begin(), end);
  }
  std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) {
    return std::tie(a.time_ns, a.id) < std::tie(b.time_ns, b.id);
  });
}

bool SqliteStorage::next(Rosbag2Message& message) {
  while (done_ < rows_.size()) {
    const Row& row = rows_[done_++];
    sqlite3_reset(message_.get());
    sqlite3_bind_int64(message_.get(), 1, row.id);
    if (sqlite3_step(message_.get()) != SQLITE_ROW) {
      note(file_.lastOffset(), "message " + std::to_string(row.id) + ": " + fault());
      continue;
    }
    const std::int64_t topic = sqlite3_column_int64(message_.get(), 0);
    const auto number = numbers_.find(topic);
    const std::uint64_t offset = file_.lastOffset();
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(message_.get(), 1));
    if (number == numbers_.end() || data == nullptr) {
      note(offset, "message " + std::to_string(row.id) +
                       (number == numbers_.end()
                            ? " of topic " + std::to_string(topic) + ", which there is none of"
                            : ": no data (" + fault() + ")"));
      continue;
    }
    message.topic = number->second;
    message.record_ns = row.time_ns;
    message.offset = offset;
    message.data = data;
    message.size = static_cast<std::size_t>(sqlite3_column_bytes(message_.get(), 1));
    return true;
  }
  return false;
}

std::string SqliteStorage::format() const {
  return "SQLite";
}

double SqliteStorage::progress() const {
  return rows_.empty() ? 1.0 : static_cast<double>(done_) / static_cast<double>(rows_.size());
}

}  // namespace fast_edi
