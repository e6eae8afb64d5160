// SPDX-License-Identifier: GPL-3.0-or-later
// CARMEN logs: "FLASER n r1 .. rn x y theta odom_x odom_y odom_theta ..." among lines of other kinds.
#include "files/text_file.h"
#include "readers/hits.h"
#include "readers/line_reader.h"
#include "readers/readers.h"

#include "exactvo/geometry/counted.h"
#include "exactvo/geometry/pi.h"

namespace exactvo::datasets {
namespace {

using geometry::kPi;
/// No laser of these logs has more beams.
constexpr std::int64_t kMostBeams = 100000;

/// Beams over half a turn, from the right. An odd number has one at each end (181, 361), an even one leaves the last
/// out (180, 360).
double beam_bearing(std::size_t beam, std::size_t beams) {
  const std::size_t gaps = beams % 2 == 1 && beams > 1 ? beams - 1 : beams;
  return -kPi / 2 + kPi * static_cast<double>(beam) / static_cast<double>(gaps);
}

void add_scan(const LineReader& lines, const std::vector<std::string_view>& words, std::vector<geometry::Vec2>& hits) {
  if (words.size() < 2) lines.refuse(DataCode::wrong_count, "no number of beams", "FLASER n r1 .. rn x y theta");
  const std::int64_t stated = lines.to_integer(words[1]);
  if (stated < 0 || stated > kMostBeams || words.size() < static_cast<std::size_t>(stated) + 5) {
    lines.refuse(DataCode::wrong_count, geometry::counted(words.size(), "word"),
                 "FLASER, a number n, n ranges and a pose; n is " + std::to_string(stated));
  }
  const auto beams = static_cast<std::size_t>(stated);
  const Pose laser{{lines.to_number(words[beams + 2]), lines.to_number(words[beams + 3])},
                   lines.to_number(words[beams + 4])};
  for (std::size_t k = 0; k < beams; ++k) {
    const double range = lines.to_number(words[k + 2]);
    if (is_no_return(range)) continue;
    const geometry::Vec2 hit = hit_at(laser, beam_bearing(k, beams), range);
    if (!geometry::is_finite(hit)) lines.refuse(DataCode::not_finite, "a pose that is not finite", "a finite pose");
    hits.push_back(hit);
  }
}

}  // namespace

bool looks_like_carmen_log(const FormatProbe& probe) {
  const std::string& text = probe.beginning;
  return text.rfind("FLASER ", 0) == 0 || text.find("\nFLASER ") != std::string::npos ||
         text.rfind("# CARMEN Logfile", 0) == 0;
}

void read_carmen_log(const std::filesystem::path& path, Collector& out) {
  const std::string text = read_text_file(path);
  LineReader lines(text, out.file());
  std::vector<geometry::Vec2> hits;
  std::size_t scans = 0;
  while (lines.next()) {
    if (lines.line().substr(0, 7) != "FLASER ") continue;
    add_scan(lines, words_of(lines.line()), hits);
    ++scans;
  }
  out.note("", geometry::counted(scans, "scan"));
  add_hits(hits, out);
}

}  // namespace exactvo::datasets
