#include "paging/planet/sqlite.h"

namespace paging {

namespace {

// Of a value that is read: more than any payload, and than the sources of a mosaic of 100 000 parts.
constexpr int kMaxValueBytes = 1 << 28;

}  // namespace

Database::Database(const std::string& path, Mode mode) : path_(path) {
  const int flags = mode == Mode::kReadOnly ? SQLITE_OPEN_READONLY : SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
  sqlite3* db = nullptr;
  // One connection is used by one thread at a time, so SQLite's own mutexes are left out.
  const int code = sqlite3_open_v2(path.c_str(), &db, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  db_.reset(db);
  if (code != SQLITE_OK) fail("open");
  sqlite3_extended_result_codes(db, 1);
  // Files come from anywhere: their schema may call no function with side effects, and pages are checked.
  sqlite3_db_config(db, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(db, SQLITE_LIMIT_ATTACHED, 0);
  if (mode == Mode::kReadOnly) sqlite3_limit(db, SQLITE_LIMIT_LENGTH, kMaxValueBytes);
  execute("PRAGMA cell_size_check = ON");
}

void Database::fail(const std::string& operation) const {
  const char* message = db_ ? sqlite3_errmsg(db_.get()) : "out of memory";
  const int code = db_ ? sqlite3_extended_errcode(db_.get()) & 0xff : SQLITE_NOMEM;
  const char* advice = code == SQLITE_FULL ? "; free some space there, or in the folder of temporary files"
                       : code == SQLITE_READONLY ? "; change its permissions, or those of its folder"
                                                 : "";
  throw DatabaseError(path_ + ": cannot " + operation + ": " + message + advice, code);
}

void Database::execute(const std::string& sql) {
  if (sqlite3_exec(db_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) fail("run '" + sql + "'");
}

std::int64_t Database::integer(const std::string& sql) {
  Statement statement(*this, sql);
  if (!statement.step()) fail("read '" + sql + "'");
  return statement.integer(0);
}

Statement::Statement(const Database& db, const std::string& sql) : db_(&db) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(db.handle(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    db.fail("prepare '" + sql + "'");
  }
  statement_.reset(statement);
}

Statement& Statement::bind(int index, std::int64_t value) {
  if (sqlite3_bind_int64(statement_.get(), index, value) != SQLITE_OK) db_->fail("bind an integer");
  return *this;
}

Statement& Statement::bind(int index, double value) {
  if (sqlite3_bind_double(statement_.get(), index, value) != SQLITE_OK) db_->fail("bind a number");
  return *this;
}

Statement& Statement::bind(int index, std::string_view value) {
  if (sqlite3_bind_text(statement_.get(), index, value.data(), static_cast<int>(value.size()),
                        SQLITE_TRANSIENT) != SQLITE_OK) {
    db_->fail("bind a text");
  }
  return *this;
}

Statement& Statement::bind(int index, std::span<const std::uint8_t> value) {
  // An empty span may have a null pointer, which SQLite would take for NULL.
  const void* data = value.empty() ? "" : static_cast<const void*>(value.data());
  if (sqlite3_bind_blob64(statement_.get(), index, data, value.size(), SQLITE_STATIC) != SQLITE_OK) {
    db_->fail("bind a blob");
  }
  return *this;
}

bool Statement::step() {
  const int code = sqlite3_step(statement_.get());
  if (code == SQLITE_ROW) return true;
  if (code != SQLITE_DONE) {
    const std::string sql = sqlite3_sql(statement_.get());
    db_->fail("run '" + sql + "'");
  }
  reset();
  return false;
}

void Statement::reset() { sqlite3_reset(statement_.get()); }

std::string Statement::text(int column) const {
  const auto* text = sqlite3_column_text(statement_.get(), column);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

std::span<const std::uint8_t> Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_.get(), column));
  return {data, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column))};
}

}  // namespace paging
