// Thin owner types over SQLite: a connection and a prepared statement. Not thread-safe: one owner at a time.
//
// Typical usage:
//   Database db(path, Database::Mode::kReadOnly);
//   Statement rows(db, "SELECT key, value FROM meta WHERE key > ?");
//   rows.bind(1, std::string_view("m"));
//   while (rows.step()) use(rows.text(0), rows.text(1));
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace paging {

// Reports a failed operation. what() names the file, the operation and SQLite's own message.
class DatabaseError : public std::runtime_error {
 public:
  explicit DatabaseError(const std::string& what, int code = SQLITE_ERROR)
      : std::runtime_error(what), code_(code) {}
  int code() const { return code_; }  // SQLite's primary result code
  bool busy() const { return code_ == SQLITE_BUSY; }

 private:
  int code_;
};

// Owns a connection. Members throw DatabaseError.
class Database {
 public:
  enum class Mode { kReadOnly, kCreate };

  Database(const std::string& path, Mode mode);

  void execute(const std::string& sql);
  // Returns the first column of the first row.
  std::int64_t integer(const std::string& sql);

  sqlite3* handle() const { return db_.get(); }
  const std::string& path() const { return path_; }
  // Throws DatabaseError for the last operation of this connection.
  [[noreturn]] void fail(const std::string& operation) const;

 private:
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close(db); }
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> db_;
};

// Owns a prepared statement. Members throw DatabaseError.
class Statement {
 public:
  Statement(const Database& db, const std::string& sql);

  // Bind a parameter; the first one has index 1. SQLite copies texts; bytes must live until step() returns.
  Statement& bind(int index, std::int64_t value);
  Statement& bind(int index, double value);
  Statement& bind(int index, std::string_view value);
  Statement& bind(int index, std::span<const std::uint8_t> value);

  // Returns true while there is a row. After the last one the statement resets itself and can be bound again.
  bool step();
  void reset();

  std::int64_t integer(int column) const { return sqlite3_column_int64(statement_.get(), column); }
  double real(int column) const { return sqlite3_column_double(statement_.get(), column); }
  std::string text(int column) const;
  std::span<const std::uint8_t> blob(int column) const;  // valid until the next step() or reset()

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  const Database* db_;
  std::unique_ptr<sqlite3_stmt, Finalize> statement_;
};

}  // namespace paging
