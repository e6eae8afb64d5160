// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Inputs for the tests of batches, and what two outputs have in common.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "support/seeded_random.h"

namespace exactvo::datasets::test {

inline std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path, std::ios::binary) << text;
}

/// `count` stars of 3 to 16 corners, one a line.
inline std::string stars_as_wkt(std::uint64_t seed, int count) {
  exactvo::test::SeededRandom random(seed);
  std::ostringstream text;
  text.precision(17);
  for (int k = 0; k < count; ++k) {
    const int corners = random.integer(3, 16);
    const geometry::Vec2 middle = random.in_box(1000.0);
    std::string first;
    text << "POLYGON ((";
    for (int i = 0; i <= corners; ++i) {
      if (i == corners) {
        text << first << "))\n";
        break;
      }
      const double angle = 2.0 * 3.14159265358979 * (i + random.uniform(0.1, 0.9)) / corners;
      const geometry::Vec2 p = middle + random.uniform(1.0, 4.0) * geometry::Vec2{std::cos(angle), std::sin(angle)};
      std::ostringstream point;
      point.precision(17);
      point << p.x << ' ' << p.y;
      if (i == 0) first = point.str();
      text << point.str() << ", ";
    }
  }
  return text.str();
}

/// A folder with a bit of everything: many obstacles, a wall, a hole, a bad ring among good ones, a grid, broken and
/// foreign files.
inline void write_inputs(const std::filesystem::path& folder, int stars) {
  write_text(folder / "stars.wkt", stars_as_wkt(5, stars));
  write_text(folder / "few.wkt",
             "LINESTRING (0 0, 1 0, 2 0, 2 2)\nPOLYGON ((0 0, 4 0, 4 4, 0 4, 0 0), (1 1, 1 2, 2 2, 1 1))\n"
             "POLYGON ((0 0, 4 4, 4 0, 0 4, 0 0))\nPOLYGON ((0 0, 0 1, 1 1, 0 0))\nPOINT (1 2)\n");
  write_text(folder / "bow.wkt", "POLYGON ((0 0, 4 4, 4 0, 0 4, 0 0))\n");
  write_text(folder / "maps" / "cells.map", "type octile\nheight 3\nwidth 4\nmap\n@@..\n@...\n...T\n");
  write_text(folder / "maps" / "notes.txt", "nothing of ours\n");
  write_text(folder / "broken.json", "[[[0, 0], [1, 0]\n");
}

/// Every file of an output by its name, summary.json without its line of times.
inline std::map<std::string, std::string> output_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_directory()) continue;
    const std::string name = entry.path().lexically_relative(folder).string();
    std::string text = text_of(entry.path());
    if (name == "summary.json") {
      const std::size_t start = text.find("\n  \"times\":");
      text.erase(start, text.find('\n', start + 1) - start);
    }
    files[name] = std::move(text);
  }
  return files;
}

/// The names of the files that differ, or are in one only.
inline std::string difference(const std::filesystem::path& a, const std::filesystem::path& b) {
  const std::map<std::string, std::string> left = output_of(a);
  const std::map<std::string, std::string> right = output_of(b);
  std::string names;
  for (const auto& [name, text] : left) {
    const auto other = right.find(name);
    if (other == right.end() || other->second != text) names += name + " ";
  }
  for (const auto& [name, text] : right) {
    if (left.count(name) == 0) names += name + " ";
  }
  return names;
}

}  // namespace exactvo::datasets::test
