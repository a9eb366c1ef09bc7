#include "recording/sqlite_file.hpp"

#include <algorithm>
#include <cstring>

#include "fast_edi/recording/recording_error.hpp"
#include "recording/rosbag2_storage.hpp"

namespace fast_edi {
namespace {

/// The log's name is the database's with this behind it.
constexpr char kDatabaseName[] = "recording";
constexpr char kLogName[] = "recording-wal";
constexpr int kMaxName = 64;
constexpr int kSectorBytes = 4096;
/// Tables of a recording have five columns at most; far more than any query here needs.
constexpr int kMaxColumns = 64;
constexpr int kMaxDepth = 64;

}  // namespace

struct SqliteFile::OpenFile {
  sqlite3_file base;  // SQLite expects it in front
  const ByteSource* source;
  Bytes* bytes;
};

struct SqliteFile::Functions {
  static OpenFile* of(sqlite3_file* file) { return reinterpret_cast<OpenFile*>(file); }
  static Bytes* of(sqlite3_vfs* system) { return static_cast<Bytes*>(system->pAppData); }

  // Of a file.
  static int close(sqlite3_file*) { return SQLITE_OK; }
  static int read(sqlite3_file* file, void* buffer, int count, sqlite3_int64 offset) {
    const OpenFile& open = *of(file);
    const auto begin = static_cast<std::uint64_t>(offset);
    const auto wanted = static_cast<std::size_t>(count);
    const std::uint64_t size = open.source->size();
    const std::size_t there =
        begin >= size ? 0 : static_cast<std::size_t>(std::min<std::uint64_t>(wanted, size - begin));
    open.bytes->last_offset = begin;
    const std::uint8_t* found = open.source->read(begin, there, open.bytes->scratch);
    if (found == nullptr && there > 0) {
      return SQLITE_IOERR_READ;
    }
    if (there > 0) {
      std::memcpy(buffer, found, there);
    }
    std::memset(static_cast<std::uint8_t*>(buffer) + there, 0, wanted - there);
    return there == wanted ? SQLITE_OK : SQLITE_IOERR_SHORT_READ;
  }
  static int write(sqlite3_file*, const void*, int, sqlite3_int64) { return SQLITE_READONLY; }
  static int truncate(sqlite3_file*, sqlite3_int64) { return SQLITE_READONLY; }
  static int sync(sqlite3_file*, int) { return SQLITE_OK; }
  static int fileSize(sqlite3_file* file, sqlite3_int64* size) {
    *size = static_cast<sqlite3_int64>(of(file)->source->size());
    return SQLITE_OK;
  }
  static int lock(sqlite3_file*, int) { return SQLITE_OK; }
  static int isReserved(sqlite3_file*, int* reserved) {
    *reserved = 0;
    return SQLITE_OK;
  }
  static int control(sqlite3_file*, int, void*) { return SQLITE_NOTFOUND; }
  static int sectorSize(sqlite3_file*) { return kSectorBytes; }
  static int characteristics(sqlite3_file*) { return 0; }

  static constexpr sqlite3_io_methods fileMethods() {
    sqlite3_io_methods methods = {};
    methods.iVersion = 1;
    methods.xClose = close;
    methods.xRead = read;
    methods.xWrite = write;
    methods.xTruncate = truncate;
    methods.xSync = sync;
    methods.xFileSize = fileSize;
    methods.xLock = lock;
    methods.xUnlock = lock;
    methods.xCheckReservedLock = isReserved;
    methods.xFileControl = control;
    methods.xSectorSize = sectorSize;
    methods.xDeviceCharacteristics = characteristics;
    return methods;
  }
  static const sqlite3_io_methods kFileMethods;

  // Of the system of files.
  static int open(sqlite3_vfs* system, const char* name, sqlite3_file* file, int flags,
                  int* out_flags) {
    OpenFile& open = *of(file);
    open.base.pMethods = nullptr;
    open.bytes = of(system);
    open.source = (flags & SQLITE_OPEN_MAIN_DB) != 0 ? open.bytes->database
                  : (flags & SQLITE_OPEN_WAL) != 0   ? open.bytes->log
                                                     : nullptr;
    if (name == nullptr || open.source == nullptr) {
      return SQLITE_CANTOPEN;
    }
    open.base.pMethods = &kFileMethods;
    if (out_flags != nullptr) {
      *out_flags = (flags & ~(SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE)) | SQLITE_OPEN_READONLY;
    }
    return SQLITE_OK;
  }
  static int remove(sqlite3_vfs*, const char*, int) { return SQLITE_READONLY; }
  static int access(sqlite3_vfs* system, const char* name, int, int* exists) {
    *exists = std::strcmp(name, kLogName) == 0 && of(system)->log != nullptr ? 1 : 0;
    return SQLITE_OK;
  }
  static int fullName(sqlite3_vfs*, const char* name, int room, char* full) {
    sqlite3_snprintf(room, full, "%s", name);
    return SQLITE_OK;
  }
  static int randomness(sqlite3_vfs* system, int count, char* bytes) {
    sqlite3_vfs* real = of(system)->system;
    return real->xRandomness(real, count, bytes);
  }
  static int sleep(sqlite3_vfs*, int) { return 0; }
  static int currentTime(sqlite3_vfs* system, double* days) {
    sqlite3_vfs* real = of(system)->system;
    return real->xCurrentTime(real, days);
  }
};

const sqlite3_io_methods SqliteFile::Functions::kFileMethods = fileMethods();

SqliteFile::SqliteFile(const ByteSource& database, const ByteSource* log, const std::string& name) {
  bytes_.database = &database;
  bytes_.log = log;
  bytes_.system = sqlite3_vfs_find(nullptr);
  if (bytes_.system == nullptr) {
    throw RecordingError("cannot read " + name + ": SQLite cannot be initialised");
  }
  system_name_ = "fast_edi_" + std::to_string(reinterpret_cast<std::uintptr_t>(this));
  system_.iVersion = 1;
  system_.szOsFile = sizeof(OpenFile);
  system_.mxPathname = kMaxName;
  system_.zName = system_name_.c_str();
  system_.pAppData = &bytes_;
  system_.xOpen = Functions::open;
  system_.xDelete = Functions::remove;
  system_.xAccess = Functions::access;
  system_.xFullPathname = Functions::fullName;
  system_.xRandomness = Functions::randomness;
  system_.xSleep = Functions::sleep;
  system_.xCurrentTime = Functions::currentTime;
  int status = sqlite3_vfs_register(&system_, 0);
  if (status == SQLITE_OK) {
    status = sqlite3_open_v2(kDatabaseName, &handle_, SQLITE_OPEN_READONLY, system_name_.c_str());
  }
  if (status != SQLITE_OK) {
    sqlite3_close(handle_);
    sqlite3_vfs_unregister(&system_);
    throw RecordingError("cannot read " + name + ": SQLite: " + sqlite3_errstr(status));
  }
  sqlite3_limit(handle_, SQLITE_LIMIT_LENGTH, static_cast<int>(Rosbag2Storage::kMaxMessageBytes));
  sqlite3_limit(handle_, SQLITE_LIMIT_COLUMN, kMaxColumns);
  sqlite3_limit(handle_, SQLITE_LIMIT_EXPR_DEPTH, kMaxDepth);
  sqlite3_limit(handle_, SQLITE_LIMIT_ATTACHED, 0);
  sqlite3_db_config(handle_, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  // Exclusive: the index of the log lies in memory. With a schema that may be written (it never
  // is), a file that is shorter than its header says is read all the same.
  sqlite3_exec(handle_,
               "PRAGMA locking_mode=EXCLUSIVE; PRAGMA trusted_schema=OFF;"
               "PRAGMA cell_size_check=ON; PRAGMA writable_schema=ON; PRAGMA temp_store=MEMORY;",
               nullptr, nullptr, nullptr);
}

SqliteFile::~SqliteFile() {
  sqlite3_close_v2(handle_);
  sqlite3_vfs_unregister(&system_);
}

SqliteStatement prepare(sqlite3* handle, const char* sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(handle, sql, -1, &statement, nullptr);
  return SqliteStatement(statement);
}

}  // namespace fast_edi
