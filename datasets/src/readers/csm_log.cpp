// SPDX-License-Identifier: GPL-3.0-or-later
// CSM logs: JSON objects one after the other, a scan each; null stands for NaN.
#include <cmath>
#include <limits>
#include <string_view>

#include "exactvo/geometry/counted.h"
#include "files/text_file.h"
#include "json/json_cursor.h"
#include "readers/hits.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

/// The next {...} of the text, found by its braces (those in strings do not count); empty at the end.
std::string_view next_object(std::string_view text, std::size_t& at, const std::string& file) {
  at = text.find_first_not_of(" \t\r\n,", at);
  if (at == std::string_view::npos) return {};
  const std::size_t begin = at;
  int depth = 0;
  bool in_string = false;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (in_string && c == '\\') {
      ++at;
    } else if (c == '"') {
      in_string = !in_string;
    } else if (!in_string && c == '{') {
      ++depth;
    } else if (!in_string && c == '}' && --depth == 0) {
      return text.substr(begin, ++at - begin);
    } else if (depth == 0) {
      break;
    }
  }
  throw DataError(DataCode::json_syntax, file, line_and_column(text, begin), excerpt(text, begin),
                  "a whole JSON object");
}

double number_or_nan(const JsonCursor& at) {
  return at.is_null() ? std::numeric_limits<double>::quiet_NaN() : at.number();
}

/// The first of these that is given in full: what the scan matcher made of it, what the wheels said, the truth.
Pose pose_of(const JsonCursor& scan) {
  for (const char* key : {"estimate", "odometry", "true_pose"}) {
    if (!scan.has(key) || scan.at(key).is_null() || scan.at(key).size() != 3) continue;
    const JsonCursor pose = scan.at(key);
    const Pose laser{{number_or_nan(pose.at(std::size_t{0})), number_or_nan(pose.at(1))}, number_or_nan(pose.at(2))};
    if (geometry::is_finite(laser.position) && std::isfinite(laser.heading)) return laser;
  }
  return {};
}

bool is_valid(const JsonCursor& scan, std::size_t k) {
  if (!scan.has("valid")) return true;
  const JsonCursor flag = scan.at("valid").at(k);
  return flag.json().is_boolean() ? flag.truth() : flag.number() != 0.0;
}

void add_scan(const JsonCursor& scan, std::vector<geometry::Vec2>& hits) {
  const Pose laser = pose_of(scan);
  const JsonCursor readings = scan.at("readings");
  for (std::size_t k = 0; k < readings.size(); ++k) {
    const double range = number_or_nan(readings.at(k));
    if (!is_valid(scan, k) || is_no_return(range)) continue;
    const geometry::Vec2 hit = hit_at(laser, scan.at("theta").at(k).number(), range);
    if (!geometry::is_finite(hit)) readings.at(k).refuse("a finite hit", DataCode::not_finite);
    hits.push_back(hit);
  }
}

}  // namespace

bool looks_like_csm_log(const FormatProbe& probe) {
  return probe.beginning.find('{') < 8 && probe.beginning.find("\"nrays\"") != std::string::npos;
}

void read_csm_log(const std::filesystem::path& path, Collector& out) {
  const std::string text = read_text_file(path);
  std::vector<geometry::Vec2> hits;
  std::size_t scans = 0;
  for (std::size_t at = 0;;) {
    const std::string_view object = next_object(text, at, out.file());
    if (object.empty()) break;
    const Json tree = parse_json(object, out.file());
    add_scan(JsonCursor(tree, out.file(), "scan " + std::to_string(scans++)), hits);
  }
  out.note("", geometry::counted(scans, "scan"));
  add_hits(hits, out);
}

}  // namespace exactvo::datasets
