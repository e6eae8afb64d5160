// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/recording_lines.h"

#include <utility>

#include "files/sha256.h"
#include "files/text_file.h"
#include "json/json_text.h"

namespace exactvo::datasets {

NextLine lines_of(std::string_view text) {
  return [rest = text](std::string_view& line) mutable {
    if (rest.empty()) return false;
    const std::size_t end = rest.find('\n');
    line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return true;
  };
}

SealedRecording::SealedRecording(std::filesystem::path path) : path_(std::move(path)) {
  if (is_pipe(path_)) text_ = read_text_file(path_);
}

RecordingFile SealedRecording::read(const TakeRow& take) {
  std::optional<TextLines> file;
  if (!text_) file.emplace(path_);
  const NextLine plain = text_ ? lines_of(*text_) : [&](std::string_view& line) { return file->next(line); };
  Sha256 hash;
  std::string last;
  bool is_first = true;
  const NextLine hashed = [&](std::string_view& line) {
    if (!plain(line)) return false;
    if (!is_first) hash.add(last += '\n');
    is_first = false;
    last = line;
    return true;
  };
  RecordingFile run = read_recording_lines(hashed, path_.string(), take);
  const std::string digest = hash.digest();
  if (digest_.empty()) {
    digest_ = digest;
    last_line_ = last;
  } else if (digest != digest_ || last != last_line_) {
    throw DataError(DataCode::file_unreadable, path_.string(), "", "a file that changed while it was read",
                    "one that nobody writes");
  }
  return run;
}

bool SealedRecording::is_sealed() const {
  const Json last = Json::parse(last_line_);
  return last.contains("end") && last["end"].value("sha256", "") == digest_;
}

}  // namespace exactvo::datasets
