// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/sqlite_file.h"

#include <sqlite3.h>

#include <boost/algorithm/string/replace.hpp>
#include <system_error>
#include <utility>

#include "exactvo/datasets/data_error.h"

namespace exactvo::datasets::batch {
namespace {

/// Of SQLite's virtual file systems the one that asks for no locks.
constexpr const char* kWithoutLocks = "unix-none";

}  // namespace

SqliteFile::SqliteFile(std::filesystem::path path) : path_(std::move(path)) {
  // Threads take turns at it (Session::finish_piece), so that it need not look after them at every call.
  constexpr int kHow = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX;
  const int status = sqlite3_open_v2(path_.c_str(), &database_, kHow, kWithoutLocks);
  if (status == SQLITE_OK) {
    sqlite3_extended_result_codes(database_, 1);
    return;
  }
  const std::string words = sqlite3_errstr(status);
  sqlite3_close(database_);
  throw DataError(DataCode::file_unwritable, path_.string(), "", words, "a place that can be written");
}

SqliteFile::~SqliteFile() {
  sqlite3_close_v2(database_);
}

void SqliteFile::refuse() const {
  std::string words = sqlite3_errmsg(database_);
  if (const int error = sqlite3_system_errno(database_); error != 0) {
    words += ": " + std::generic_category().message(error);
  }
  throw DataError(DataCode::file_unwritable, path_.string(), "", words, "a place that can be written");
}

void SqliteFile::run(const std::string& sql) {
  need(sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
}

void SqliteFile::close() {
  need(sqlite3_close(database_) == SQLITE_OK);
  database_ = nullptr;
}

SqliteStatement::SqliteStatement(SqliteFile& file, const std::string& sql)
    : file_(&file), statement_(nullptr, sqlite3_finalize) {
  sqlite3_stmt* prepared = nullptr;
  file.need(sqlite3_prepare_v3(file.database_, sql.c_str(), -1, SQLITE_PREPARE_PERSISTENT, &prepared, nullptr) ==
            SQLITE_OK);
  statement_.reset(prepared);
}

SqliteStatement& SqliteStatement::bind(int value, std::int64_t number) {
  file_->need(sqlite3_bind_int64(statement_.get(), value + 1, number) == SQLITE_OK);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int value, double number) {
  file_->need(sqlite3_bind_double(statement_.get(), value + 1, number) == SQLITE_OK);
  return *this;
}

SqliteStatement& SqliteStatement::bind(int value, std::string_view text) {
  file_->need(sqlite3_bind_text64(statement_.get(), value + 1, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8) ==
              SQLITE_OK);
  return *this;
}

SqliteStatement& SqliteStatement::bind_bytes(int value, std::string_view bytes) {
  file_->need(sqlite3_bind_blob64(statement_.get(), value + 1, bytes.data(), bytes.size(), SQLITE_STATIC) == SQLITE_OK);
  return *this;
}

bool SqliteStatement::step() {
  const int status = sqlite3_step(statement_.get());
  if (status == SQLITE_ROW) return true;
  if (status != SQLITE_DONE) file_->refuse();
  file_->need(sqlite3_reset(statement_.get()) == SQLITE_OK);
  return false;
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(statement_.get(), column);
}

std::string SqliteStatement::text(int column) const {
  const unsigned char* words = sqlite3_column_text(statement_.get(), column);
  return words == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(words));
}

std::string sql_name(std::string_view name) {
  return "\"" + boost::replace_all_copy(std::string(name), "\"", "\"\"") + "\"";
}

}  // namespace exactvo::datasets::batch
