/// \file
/// SQLite (https://www.sqlite.org/vfs.html) on bytes that are only ever read: it writes no journal,
/// takes no locks and asks for no other file than the log of writes ("-wal") that an interrupted
/// recorder leaves.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <sqlite3.h>

#include "fast_edi/recording/byte_source.hpp"

namespace fast_edi {

class SqliteFile {
 public:
  /// \param database must outlive this
  /// \param log null where there is none; must outlive this
  /// \throws RecordingError when SQLite cannot open it; \p name is for the message
  SqliteFile(const ByteSource& database, const ByteSource* log, const std::string& name);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  sqlite3* handle() const { return handle_; }
  /// Where SQLite has read last, which is the place of the damage when it reports some.
  std::uint64_t lastOffset() const { return bytes_.last_offset; }

 private:
  /// What the functions that SQLite calls are given.
  struct Bytes {
    const ByteSource* database = nullptr;
    const ByteSource* log = nullptr;
    std::uint64_t last_offset = 0;
    std::vector<std::uint8_t> scratch;
    sqlite3_vfs* system = nullptr;
  };
  struct OpenFile;
  struct Functions;

  Bytes bytes_;
  std::string system_name_;
  sqlite3_vfs system_ = {};
  sqlite3* handle_ = nullptr;
};

/// A statement that is finalised with it.
struct SqliteFinalise {
  void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
};
using SqliteStatement = std::unique_ptr<sqlite3_stmt, SqliteFinalise>;

/// \return null when SQLite refuses it; sqlite3_errmsg() says why
SqliteStatement prepare(sqlite3* handle, const char* sql);

}  // namespace fast_edi
