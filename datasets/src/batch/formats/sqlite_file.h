// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// An SQLite database that this process alone writes, once, from beginning to end: no journal, no locks (network mounts
/// may have none), no syncs; whoever writes it syncs the file at its end. Until then a crash loses nothing, since
/// nobody reads it. Errors are DataErrors (E_FILE_UNWRITABLE).

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

struct sqlite3;
struct sqlite3_stmt;

namespace exactvo::datasets::batch {

class SqliteFile {
 public:
  /// Opens what stands at `path`.
  explicit SqliteFile(std::filesystem::path path);
  ~SqliteFile();
  SqliteFile(const SqliteFile&) = delete;
  SqliteFile& operator=(const SqliteFile&) = delete;

  /// Statements without values and without answers.
  void run(const std::string& sql);
  void close();

 private:
  friend class SqliteStatement;
  [[noreturn]] void refuse() const;
  void need(bool done) const {
    if (!done) refuse();
  }

  std::filesystem::path path_;
  sqlite3* database_ = nullptr;
};

/// One statement, run as often as wanted. Columns and values count from 0. Text and bytes must live until the next
/// `step` or `run`.
class SqliteStatement {
 public:
  SqliteStatement(SqliteFile& file, const std::string& sql);

  SqliteStatement& bind(int value, std::int64_t number);
  SqliteStatement& bind(int value, double number);
  SqliteStatement& bind(int value, std::string_view text);
  SqliteStatement& bind_bytes(int value, std::string_view bytes);

  /// Whether there is a next row of the answer; after the last one the statement may be run anew.
  bool step();
  /// For statements without an answer.
  void run() { step(); }
  std::int64_t integer(int column) const;
  std::string text(int column) const;

 private:
  SqliteFile* file_;
  std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)> statement_;
};

/// `name` as SQL quotes it.
std::string sql_name(std::string_view name);

}  // namespace exactvo::datasets::batch
