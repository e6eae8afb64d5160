// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/recording_lines.h"

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

bool SealedLines::next(std::string_view& line) {
  if (!lines_.next(line)) return false;
  if (lines_.number() > 1) hash_.add(last_ += '\n');
  last_ = line;
  return true;
}

bool SealedLines::are_sealed() {
  const Json last = Json::parse(last_);
  return last.contains("end") && last["end"].value("sha256", "") == hash_.digest();
}

}  // namespace exactvo::datasets
