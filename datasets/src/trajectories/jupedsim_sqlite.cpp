// SPDX-License-Identifier: GPL-3.0-or-later
#include "trajectories/jupedsim_sqlite.h"

#include <sqlite3.h>

#include <memory>
#include <string>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"

namespace exactvo::datasets {
namespace {

using Database = std::unique_ptr<sqlite3, int (*)(sqlite3*)>;
using Statement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

constexpr const char* kExpected = "a database with the table trajectory_data (frame, id, pos_x, pos_y)";

class Reading {
 public:
  explicit Reading(const std::filesystem::path& path) : path_(path), database_(nullptr, sqlite3_close_v2) {
    sqlite3* opened = nullptr;
    // Read as it stands: nothing is locked, and no journal of a writer that has died is replayed.
    const std::string name = "file:" + escaped(path.string()) + "?mode=ro&immutable=1";
    const int status = sqlite3_open_v2(name.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(opened);
    if (status != SQLITE_OK) refuse();
  }

  Statement prepared(const char* sql) {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) refuse();
    return {statement, sqlite3_finalize};
  }
  bool next(const Statement& statement) {
    const int status = sqlite3_step(statement.get());
    if (status == SQLITE_ROW) return true;
    if (status != SQLITE_DONE) refuse();
    return false;
  }
  [[noreturn]] void refuse() const {
    throw DataError(DataCode::format_syntax, path_.string(), "", sqlite3_errmsg(database_.get()), kExpected);
  }
  [[noreturn]] void refuse_row(std::uint64_t row, const char* column) const {
    throw DataError(DataCode::number, path_.string(), "row " + std::to_string(row),
                    std::string("no number in the column ") + column, "numbers");
  }

 private:
  /// As a part of a URI.
  static std::string escaped(const std::string& text) {
    std::string escaped;
    for (const char c : text) {
      if (c == '%' || c == '?' || c == '#') {
        constexpr const char* kDigits = "0123456789abcdef";
        escaped += {'%', kDigits[(c >> 4) & 15], kDigits[c & 15]};
      } else {
        escaped += c;
      }
    }
    return escaped;
  }
  std::filesystem::path path_;
  Database database_;
};

}  // namespace

void read_jupedsim_sqlite_file(const std::filesystem::path& path, const SqliteTrajectories& to) {
  Reading reading(path);
  double frame_rate = 0.0;
  {
    const Statement tables = reading.prepared("SELECT 1 FROM sqlite_master WHERE name = 'metadata'");
    if (reading.next(tables)) {
      const Statement rate = reading.prepared("SELECT value FROM metadata WHERE key = 'fps'");
      if (reading.next(rate)) frame_rate = sqlite3_column_double(rate.get(), 0);
    }
  }
  to.begin(frame_rate);
  const Statement rows = reading.prepared("SELECT frame, id, pos_x, pos_y FROM trajectory_data ORDER BY frame, rowid");
  constexpr const char* kColumns[] = {"frame", "id", "pos_x", "pos_y"};
  for (std::uint64_t row = 1; reading.next(rows); ++row) {
    for (int c = 0; c < 4; ++c) {
      const int type = sqlite3_column_type(rows.get(), c);
      if (type != SQLITE_INTEGER && (type != SQLITE_FLOAT || c < 2)) reading.refuse_row(row, kColumns[c]);
    }
    if (row % 4096 == 0) call_wait_hook();
    to.take(sqlite3_column_int64(rows.get(), 0), sqlite3_column_int64(rows.get(), 1),
            {sqlite3_column_double(rows.get(), 2), sqlite3_column_double(rows.get(), 3)}, row);
  }
}

}  // namespace exactvo::datasets
