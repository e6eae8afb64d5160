// SPDX-License-Identifier: GPL-3.0-or-later
#include "stars.h"

#include <cmath>
#include <cstdio>
#include <fstream>

#include "exactvo/geometry/validity.h"

namespace exactvo::bench {
namespace {

using geometry::Vec2;

/// SplitMix64 from a counter of its own for each star.
class Random {
 public:
  explicit Random(std::uint64_t star) : state_(star * 0x9E3779B97F4A7C15ULL + 1) {}

  std::uint64_t bits() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) { return low + (high - low) * 0x1p-53 * static_cast<double>(bits() >> 11); }

 private:
  std::uint64_t state_;
};

double millimetres(double x) {
  return std::round(1000.0 * x) / 1000.0;
}

}  // namespace

geometry::Polygon star(std::uint64_t k) {
  constexpr double kTwoPi = 6.28318530717958647692;
  Random random(k);
  const std::size_t corners = 3 + random.bits() % 14;
  const Vec2 middle{random.uniform(-1000.0, 1000.0), random.uniform(-1000.0, 1000.0)};
  const double size = random.uniform(0.5, 4.0);
  geometry::Polygon polygon;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = kTwoPi * (static_cast<double>(i) + random.uniform(0.1, 0.9)) / static_cast<double>(corners);
    const Vec2 p = middle + size * random.uniform(0.3, 1.0) * Vec2{std::cos(angle), std::sin(angle)};
    polygon.outer.push_back({millimetres(p.x), millimetres(p.y)});
  }
  return polygon;
}

std::vector<geometry::Polygon> stars(std::size_t count) {
  std::vector<geometry::Polygon> polygons;
  for (std::uint64_t k = 0; k < count; ++k) {
    geometry::NormalizedPolygon normal = geometry::normalize({star(k).outer});
    if (normal.ok()) polygons.push_back(std::move(normal.polygon));
  }
  return polygons;
}

void write_stars(const std::filesystem::path& path, std::size_t count) {
  std::ofstream file(path, std::ios::binary);
  char text[64];
  for (std::uint64_t k = 0; k < count; ++k) {
    const geometry::Polygon polygon = star(k);
    file << "POLYGON ((";
    for (std::size_t i = 0; i <= polygon.outer.size(); ++i) {
      const Vec2 p = polygon.outer[i % polygon.outer.size()];
      std::snprintf(text, sizeof text, "%s%.3f %.3f", i == 0 ? "" : ", ", p.x, p.y);
      file << text;
    }
    file << "))\n";
  }
}

}  // namespace exactvo::bench
