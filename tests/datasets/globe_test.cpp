// SPDX-License-Identifier: GPL-3.0-or-later
// Features all over the globe, in degrees and in projected reference systems: lengths and areas against geodesics on
// the ellipsoid, by GeographicLib, within the distortion that is reported. EXACTVO_GLOBE_FILES says how many files.
#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/PolygonArea.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/datasets/repair.h"
#include "support/seeded_random.h"
#include "temporary_folder.h"

namespace exactvo::datasets::test {
namespace {

using exactvo::test::SeededRandom;
using geometry::Ring;
using geometry::Vec2;

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadian = kPi / 180.0;

const GeographicLib::Geodesic& geodesic() {
  return GeographicLib::Geodesic::WGS84();
}

double distance(Vec2 a, Vec2 b) {
  double metres = 0.0;
  geodesic().Inverse(a.y, a.x, b.y, b.x, metres);
  return metres;
}

Vec2 at(Vec2 from, double azimuth, double metres) {
  Vec2 to;
  geodesic().Direct(from.y, from.x, azimuth, metres, to.y, to.x);
  return to;
}

/// The area of what geodesics enclose, and how far it may be from that.
struct GroundArea {
  double square_metres = 0.0;
  double error = 0.0;
};

/// About the first corner, by distances and azimuths: too large by less than a share of x^2/6, x the size in radians.
GroundArea area_of_small(const Ring& ring, double perimeter) {
  Ring plane;
  for (const Vec2 p : ring) {
    double metres = 0.0, azimuth = 0.0, unused = 0.0;
    geodesic().Inverse(ring[0].y, ring[0].x, p.y, p.x, metres, azimuth, unused);
    plane.push_back({metres * std::sin(azimuth * kRadian), metres * std::cos(azimuth * kRadian)});
  }
  const double square_metres = area(geometry::Polygon{plane, {}}), radians = perimeter / 6.3e6;
  return {square_metres, square_metres * radians * radians / 6 + perimeter * 1e-8};
}

/// GeographicLib's polygons are good to 0.1 m^2.
GroundArea ground_area(const Ring& ring, double perimeter) {
  if (perimeter < 1e4) return area_of_small(ring, perimeter);
  GeographicLib::PolygonArea polygon(geodesic());
  for (const Vec2 p : ring) polygon.AddPoint(p.y, p.x);
  double length = 0.0, square_metres = 0.0;
  polygon.Compute(false, true, length, square_metres);
  return {std::fabs(square_metres), 0.1};
}

// --- Random features: rings of degrees, counter-clockwise ---

/// Uniform on the globe; one in six beside the antimeridian, one in six near a pole.
Vec2 random_place(SeededRandom& random) {
  const int kind = random.integer(0, 5);
  const double latitude = std::asin(random.uniform(-1.0, 1.0)) / kRadian;
  if (kind == 0) return {180.0, 0.9 * latitude};
  if (kind == 1) return {random.uniform(-180.0, 180.0), std::copysign(random.uniform(80.0, 89.99), latitude)};
  return {random.uniform(-180.0, 180.0), latitude};
}

/// Convex: corners on a circle of that radius, m.
Ring random_ring(SeededRandom& random, Vec2 middle, double radius) {
  const int corners = random.integer(3, 7);
  Ring ring;
  for (int k = 0; k < corners; ++k)
    ring.push_back(at(middle, -360.0 * (k + random.uniform(0.0, 0.7)) / corners, radius));
  return ring;
}

double log_uniform(SeededRandom& random, double low, double high) {
  return std::exp(random.uniform(std::log(low), std::log(high)));
}

bool jumps(const Ring& ring) {
  for (std::size_t k = 0; k < ring.size(); ++k)
    if (std::fabs(ring[k].x - ring[(k + 1) % ring.size()].x) > 180.0) return true;
  return false;
}

/// Convex, cut at the antimeridian by straight lines in degrees, as RFC 7946 wants it: the part in the east or the
/// west.
Ring part_of(const Ring& ring, bool is_east) {
  const auto turned = [](Vec2 p) { return Vec2{p.x < 0.0 ? p.x + 360.0 : p.x, p.y}; };
  const auto is_in = [&](Vec2 p) { return is_east ? p.x <= 180.0 : p.x >= 180.0; };
  Ring part;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = turned(ring[k]), b = turned(ring[(k + 1) % ring.size()]);
    if (is_in(a)) part.push_back(a);
    if (is_in(a) == is_in(b) || a.x == 180.0 || b.x == 180.0) continue;
    const double t = (180.0 - a.x) / (b.x - a.x);
    part.push_back({180.0, (1 - t) * a.y + t * b.y});
  }
  for (Vec2& p : part)
    if (!is_east) p.x -= 360.0;
  return part;
}

std::vector<Ring> cut_at_antimeridian(const std::vector<Ring>& rings) {
  std::vector<Ring> cut;
  for (const Ring& ring : rings) {
    if (!jumps(ring)) {
      cut.push_back(ring);
      continue;
    }
    for (const bool is_east : {true, false}) {
      Ring part = part_of(ring, is_east);
      if (part.size() >= 3) cut.push_back(std::move(part));
    }
  }
  return cut;
}

// --- Files ---

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", x);
  return text;
}

std::string points_text(const Ring& ring, const char* between, const char* begin, const char* end) {
  std::string text;
  for (std::size_t k = 0; k <= ring.size(); ++k) {
    const Vec2 p = ring[k % ring.size()];
    text += (k > 0 ? ", " : "") + (begin + number(p.x)) + between + number(p.y) + end;
  }
  return text;
}

std::string geojson(const std::vector<Ring>& rings, const std::string& system) {
  std::string text = R"({"type": "FeatureCollection", )";
  if (!system.empty()) text += R"("crs": {"type": "name", "properties": {"name": ")" + system + R"("}}, )";
  text += R"("features": [)";
  for (std::size_t k = 0; k < rings.size(); ++k)
    text += std::string(k > 0 ? ", " : "") +
            R"({"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[)" +
            points_text(rings[k], ", ", "[", "]") + "]]}}";
  return text + "]}";
}

std::string ewkt(const std::vector<Ring>& rings, int srid) {
  std::string text;
  for (const Ring& ring : rings)
    text += "SRID=" + std::to_string(srid) + ";POLYGON ((" + points_text(ring, " ", "", "") + "))\n";
  return text;
}

std::string ewkt_table(const std::vector<Ring>& rings, int srid) {
  std::string text = "id,WKT\n";
  for (const Ring& ring : rings)
    text += "1,\"SRID=" + std::to_string(srid) + ";POLYGON ((" + points_text(ring, " ", "", "") + "))\"\n";
  return text;
}

// --- Reference systems, by formulas of their own ---

enum class System { degrees, utm, web_mercator, world_mercator };

int zone_of(double longitude) {
  return std::clamp(static_cast<int>(std::floor((longitude + 180.0) / 6.0)) + 1, 1, 60);
}

Vec2 projected(Vec2 p, System system, int zone) {
  constexpr double kA = 6378137.0;
  if (system == System::utm) {
    Vec2 q;
    GeographicLib::TransverseMercator::UTM().Forward(6.0 * zone - 183.0, p.y, p.x, q.x, q.y);
    return {q.x + 500000.0, q.y};
  }
  const double sine = std::sin(p.y * kRadian);
  const double e = system == System::world_mercator ? std::sqrt((2.0 - 1.0 / 298.257223563) / 298.257223563) : 0.0;
  return {kA * p.x * kRadian, kA * (std::atanh(sine) - e * std::atanh(e * sine))};
}

int srid_of(System system, int zone) {
  if (system == System::utm) return 32600 + zone;
  if (system == System::web_mercator) return 3857;
  return system == System::world_mercator ? 3395 : 4326;
}

// --- The test ---

struct Tally {
  int files = 0, refused = 0, distances = 0, areas = 0, crossing = 0;
  double largest_excess = 0.0;  ///< of a distance, as a share
};

class Globe : public TemporaryFolder {
 protected:
  void SetUp() override {
    if (!built_with_gdal()) GTEST_SKIP() << "built without GDAL";
    TemporaryFolder::SetUp();
  }
  void TearDown() override {
    if (!folder_.empty()) TemporaryFolder::TearDown();
  }

  static std::size_t files_wanted(std::size_t otherwise) {
    const char* asked = std::getenv("EXACTVO_GLOBE_FILES");
    return asked != nullptr ? std::strtoull(asked, nullptr, 10) : otherwise;
  }

  ObstacleFile read(const std::vector<Ring>& numbers, System system, int zone, int kind) const {
    const int srid = srid_of(system, zone);
    const std::string name = system == System::degrees ? "" : "EPSG:" + std::to_string(srid);
    if (kind == 1) return read_obstacles(put("a.wkt", ewkt(numbers, srid)));
    if (kind == 2) return read_obstacles(put("a.csv", ewkt_table(numbers, srid)));
    return read_obstacles(put("a.geojson", geojson(numbers, name)));
  }

  void judge(const ObstacleFile& file, const std::vector<Ring>& rings, Tally& tally) const {
    ASSERT_TRUE(file.distortion.has_value());
    ASSERT_EQ(file.obstacles.size(), rings.size());
    const Distortion& distortion = *file.distortion;
    EXPECT_LE(distortion.length, kMostDistortion);
    std::vector<Vec2> plane, ground;
    double reach = 0.0;
    for (std::size_t k = 0; k < rings.size(); ++k) {
      const auto& outer = std::get<geometry::Polygon>(file.obstacles[k].shape).outer;
      ASSERT_EQ(outer.size(), rings[k].size());
      plane.insert(plane.end(), outer.begin(), outer.end());
      ground.insert(ground.end(), rings[k].begin(), rings[k].end());
      for (const Vec2 p : outer) reach = std::max(reach, norm(p - outer.front()));
    }
    for (const Vec2 p : plane) reach = std::max(reach, norm(p - plane.front()));
    constexpr double kRounding = 1e-7;  // m: degrees of 17 digits, and two projections
    for (std::size_t i = 0; i < plane.size(); ++i) {
      for (std::size_t k = i + 1; k < plane.size(); ++k) {
        const double on_ground = distance(ground[i], ground[k]), on_plane = norm(plane[i] - plane[k]);
        const double least = distortion.certified ? on_ground : (1.0 - distortion.length) * on_ground;
        EXPECT_GE(on_plane, least - kRounding);
        EXPECT_LE(on_plane, (1.0 + distortion.length) * on_ground + kRounding);
        if (on_ground > 1.0) tally.largest_excess = std::max(tally.largest_excess, on_plane / on_ground - 1.0);
        ++tally.distances;
      }
    }
    for (std::size_t k = 0; k < rings.size(); ++k)
      judge_area(std::get<geometry::Polygon>(file.obstacles[k].shape), rings[k], distortion, reach, tally);
  }

  /// A straight line of length L on the plane bends from the geodesic by less than L^2 h / (8 R^2), at the distance h
  /// from the centre, R = b; in Mercator's projections as well, within the limit of distortion.
  static void judge_area(const geometry::Polygon& polygon, const Ring& ring, const Distortion& distortion, double reach,
                         Tally& tally) {
    constexpr double kB = 6356752.3, kRounding = 1e-7;
    double between = 0.0, perimeter = 0.0;
    for (std::size_t k = 0; k < ring.size(); ++k) {
      const double length = distance(ring[k], ring[(k + 1) % ring.size()]);
      const double from_centre = distortion.certified ? reach : kB * 0.1;
      between += length * length * length * from_centre / (8 * kB * kB);
      perimeter += length;
    }
    const GroundArea ground = ground_area(ring, perimeter);
    const double on_ground = ground.square_metres, on_plane = area(polygon);
    const double rounding = perimeter * kRounding + ground.error;
    EXPECT_GE(on_plane, (distortion.certified ? 1.0 : 1.0 - distortion.area) * on_ground - between - rounding);
    EXPECT_LE(on_plane, (1.0 + distortion.area) * on_ground + between + rounding);
    ++tally.areas;
  }
};

std::vector<Ring> random_features(SeededRandom& random, double farthest) {
  const Vec2 middle = random_place(random);
  const double apart = log_uniform(random, 10.0, farthest);
  std::vector<Ring> rings;
  for (int k = random.integer(1, 3); k > 0; --k) {
    const Vec2 place = rings.empty() ? middle : at(middle, random.uniform(0.0, 360.0), apart);
    rings.push_back(random_ring(random, place, log_uniform(random, 1.0, std::min(1e5, farthest))));
  }
  return rings;
}

double greatest_distance(const std::vector<Ring>& rings) {
  double greatest = 0.0;
  for (const Ring& a : rings)
    for (const Ring& b : rings)
      for (const Vec2 p : a)
        for (const Vec2 q : b) greatest = std::max(greatest, distance(p, q));
  return greatest;
}

/// Rings that a pole lies in, or that touch it, have no outline in degrees.
bool is_near_pole(const std::vector<Ring>& rings) {
  for (const Ring& ring : rings)
    for (const Vec2 p : ring)
      if (90.0 - std::fabs(p.y) < 2.0) return true;
  return false;
}

TEST_F(Globe, DegreesBecomeMetresWithinTheDistortionThatIsReported) {
  SeededRandom random(exactvo::test::seed_of_run(71));
  Tally tally;
  for (std::size_t n = 0; n < files_wanted(300); ++n) {
    const std::vector<Ring> whole = random_features(random, n % 4 == 0 ? 6e6 : 5e5);
    if (is_near_pole(whole) && std::any_of(whole.begin(), whole.end(), jumps)) continue;
    const std::vector<Ring> rings = cut_at_antimeridian(whole);
    SCOPED_TRACE(geojson(rings, ""));
    ++tally.files;
    tally.crossing += rings.size() > whole.size() ? 1 : 0;
    try {
      judge(read(rings, System::degrees, 0, static_cast<int>(n % 3)), rings, tally);
    } catch (const DataError& error) {
      ++tally.refused;
      EXPECT_STREQ(code_name(error.code()), "E_PROJECTION") << error.what();
      EXPECT_GT(greatest_distance(rings), 1.5e6) << error.what();
    }
    if (HasFailure()) return;
  }
  std::cout << tally.files << " files in degrees, " << tally.crossing << " across the antimeridian, " << tally.refused
            << " refused; " << tally.distances << " distances, " << tally.areas
            << " areas; distances too large by up to " << tally.largest_excess << "\n";
  EXPECT_GT(tally.distances, 20 * tally.files);
  EXPECT_GT(tally.crossing, tally.files / 30);
  EXPECT_GT(tally.refused, tally.files / 100);
  EXPECT_LT(tally.refused, tally.files / 3);
}

TEST_F(Globe, ProjectedNumbersBecomeMetresWithinTheDistortionThatIsReported) {
  SeededRandom random(exactvo::test::seed_of_run(72));
  std::map<System, Tally> tallies;
  for (std::size_t n = 0; n < files_wanted(300); ++n) {
    const System system = std::array{System::utm, System::web_mercator, System::world_mercator}[n % 3];
    std::vector<Ring> rings = random_features(random, 2e5);
    const bool is_apart = std::any_of(rings.begin(), rings.end(), jumps) || is_near_pole(rings) ||
                          std::fabs(rings.front().front().x) > 170.0 || std::fabs(rings.front().front().y) > 80.0;
    if (is_apart) continue;
    const int zone = zone_of(rings.front().front().x);
    std::vector<Ring> numbers = rings;
    for (Ring& ring : numbers)
      for (Vec2& p : ring) p = projected(p, system, zone);
    SCOPED_TRACE(geojson(numbers, "EPSG:" + std::to_string(srid_of(system, zone))));
    Tally& tally = tallies[system];
    ++tally.files;
    judge(read(numbers, system, zone, static_cast<int>(n / 3 % 3)), rings, tally);
    if (HasFailure()) return;
  }
  for (const auto& [system, tally] : tallies) {
    std::cout << "EPSG:" << srid_of(system, 0) << ": " << tally.files << " files, " << tally.distances << " distances, "
              << tally.areas << " areas; distances too large by up to " << tally.largest_excess << "\n";
    EXPECT_GT(tally.distances, 10 * tally.files);
  }
  EXPECT_EQ(tallies.size(), 3u);
}

}  // namespace
}  // namespace exactvo::datasets::test
