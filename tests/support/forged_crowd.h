// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Recordings of crowds that no run has made, byte for byte as docs/guide/crowd-recordings.md has them.

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace exactvo::test {

inline std::uint64_t fnv1a(const std::string& bytes) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

/// A number as it stands in memory.
template <class T>
std::string in_bytes(T number) {
  std::string bytes(sizeof number, '\0');
  std::memcpy(bytes.data(), &number, sizeof number);
  return bytes;
}

struct ForgedCrowd {
  struct Kind {
    double radius, max_speed;
  };
  struct Edge {
    double ax, ay, bx, by;
  };
  struct Body {
    bool moves;
    std::uint8_t shape;  ///< 0: a disc
    std::vector<double> numbers;
  };
  /// In lattice steps.
  struct Place {
    std::int64_t x, y;
  };
  struct Row {
    std::uint32_t step;
    std::vector<Place> robots, bodies;
  };

  std::vector<Row> rows;
  std::vector<Edge> edges{};
  std::vector<Body> bodies{};
  std::vector<Kind> kinds{{0.3, 1.0}};
  std::vector<std::uint16_t> kind_of{0};
  double time_step = 0.1, position_step = 0x1p-10;  ///< s, m
  bool is_whole = true;                             ///< false: the file has no end
};

/// The file, with checksums that fit.
inline std::string bytes_of(const ForgedCrowd& crowd) {
  const auto counted = [](std::size_t count) { return in_bytes(static_cast<std::uint32_t>(count)); };
  const auto block = [](const std::string& bytes) {
    return in_bytes<std::uint64_t>(bytes.size()) + in_bytes(fnv1a(bytes)) + bytes;
  };
  std::string head = counted(6) + "forged" + in_bytes(crowd.time_step) + in_bytes(crowd.position_step) + counted(1);
  head += counted(crowd.kinds.size());
  for (const auto& kind : crowd.kinds) head += in_bytes(kind.radius) + in_bytes(kind.max_speed);
  head += counted(crowd.kind_of.size());
  for (const std::uint16_t kind : crowd.kind_of) head += in_bytes(kind);
  head += counted(crowd.edges.size());
  for (const auto& e : crowd.edges) head += in_bytes(e.ax) + in_bytes(e.ay) + in_bytes(e.bx) + in_bytes(e.by);
  head += counted(crowd.bodies.size());
  for (const auto& body : crowd.bodies) {
    head += in_bytes<std::uint8_t>(body.moves) + in_bytes(body.shape) + counted(body.numbers.size());
    for (const double number : body.numbers) head += in_bytes(number);
  }
  std::string out = "EXACTVR2" + block(head);
  std::uint64_t sum = fnv1a(head);
  std::vector<ForgedCrowd::Place> robots(crowd.kind_of.size()), bodies(crowd.bodies.size());
  for (const auto& next : crowd.rows) {
    std::string row = in_bytes(next.step);
    const auto append = [&](std::int64_t difference) {
      auto left = (static_cast<std::uint64_t>(difference) << 1U) ^ static_cast<std::uint64_t>(difference >> 63);
      for (; left >= 0x80; left >>= 7U) row.push_back(static_cast<char>(left | 0x80U));
      row.push_back(static_cast<char>(left));
    };
    for (auto [last, now] : {std::pair(&robots, &next.robots), std::pair(&bodies, &next.bodies)}) {
      for (std::size_t i = 0; i < last->size(); ++i) append(now->at(i).x - (*last)[i].x);
      for (std::size_t i = 0; i < last->size(); ++i) append(now->at(i).y - (*last)[i].y);
      *last = *now;
    }
    row.append((robots.size() + 7) / 8, '\xff');
    if (robots.size() % 8 != 0) row.back() = static_cast<char>((1U << robots.size() % 8) - 1U);
    out += "R" + block(row);
    sum = fnv1a(in_bytes(sum) + in_bytes(fnv1a(row)));
  }
  return crowd.is_whole ? out + "E" + block(in_bytes<std::uint64_t>(crowd.rows.size()) + in_bytes(sum)) : out;
}

}  // namespace exactvo::test
