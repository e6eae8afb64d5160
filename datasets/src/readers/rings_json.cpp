// SPDX-License-Identifier: GPL-3.0-or-later
// One polygon as nested lists, [shell, hole, ...], each a list of [x, y]; often unclosed, either winding.
#include <cctype>

#include "files/text_file.h"
#include "json/json_cursor.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

geometry::Ring to_ring(const JsonCursor& at) {
  geometry::Ring ring;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const JsonCursor point = at.at(i);
    if (point.size() < 2) point.refuse("[x, y]", DataCode::wrong_count);
    ring.push_back({point.at(std::size_t{0}).number(), point.at(1).number()});
  }
  return ring;
}

}  // namespace

bool looks_like_rings_json(const FormatProbe& probe) {
  std::size_t brackets = 0;
  for (const char c : probe.beginning) {
    if (c == '[') ++brackets;
    if (c != '[' && std::isspace(static_cast<unsigned char>(c)) == 0) break;
  }
  return brackets == 3;
}

void read_rings_json(const std::filesystem::path& path, Collector& out) {
  const Json tree = parse_json(read_text_file(path), out.file());
  const JsonCursor rings(tree, out.file(), "");
  RawGeometry raw{RawKind::polygon, "0", "polygon", {}};
  for (std::size_t k = 0; k < rings.size(); ++k) raw.rings.push_back(to_ring(rings.at(k)));
  if (raw.rings.empty()) return out.pass_over(raw.place, "an empty polygon skipped");
  out.add(raw);
}

}  // namespace exactvo::datasets
