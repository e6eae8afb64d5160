// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/shapefile_rings.h"

#include <cpl_conv.h>
#include <ogr_geometry.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "exactvo/geometry/box.h"

namespace exactvo::datasets {
namespace {

using geometry::Ring;
using geometry::Vec2;

struct ShapeRing {
  double doubled_area = 0.0;  ///< with its sign, about the first point
  geometry::Box box;
};

ShapeRing shape_of(const Ring& ring) {
  ShapeRing shape;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    shape.box.add(ring[k]);
    shape.doubled_area += cross(ring[k] - ring[0], ring[(k + 1) % ring.size()] - ring[0]);
  }
  return shape;
}

/// Whether p is inside; none on the ring. Rounded: what is misjudged by that touches the ring, which validation finds.
std::optional<bool> is_inside(const Ring& ring, Vec2 p) {
  bool inside = false;
  for (std::size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
    if (p == a) return std::nullopt;
    if ((a.y > p.y) == (b.y > p.y)) continue;
    const double side = b.y > a.y ? cross(b - a, p - a) : cross(a - b, p - b);
    if (side == 0.0) return std::nullopt;
    if (side > 0.0) inside = !inside;
  }
  return inside;
}

class Nesting {
 public:
  explicit Nesting(const std::vector<Ring>& rings) : rings_(rings) {
    for (const Ring& ring : rings) shapes_.push_back(shape_of(ring));
  }

  bool is_outer(std::size_t k) const { return !(shapes_[k].doubled_area > 0.0); }

  bool is_round(std::size_t outer, std::size_t inner) const {
    const geometry::Box &o = shapes_[outer].box, &i = shapes_[inner].box;
    if (outer == inner || !(size(outer) > size(inner)) || !o.contains(i.low) || !o.contains(i.high)) return false;
    for (const Vec2 p : rings_[inner])
      if (const auto inside = is_inside(rings_[outer], p)) return *inside;
    return true;
  }

  /// The smallest of `candidates` round it.
  std::optional<std::size_t> nearest_round(std::size_t inner, const std::vector<std::size_t>& candidates) const {
    std::optional<std::size_t> nearest;
    for (const std::size_t k : candidates) {
      const bool is_nearer = !nearest || size(k) < size(*nearest);
      if (is_nearer && is_round(k, inner)) nearest = k;
    }
    return nearest;
  }

  double size(std::size_t k) const { return std::fabs(shapes_[k].doubled_area); }

 private:
  const std::vector<Ring>& rings_;
  std::vector<ShapeRing> shapes_;
};

std::vector<Ring> rings_of_parts(const OGRMultiPolygon& parts) {
  std::vector<Ring> rings;
  for (const OGRPolygon* part : parts) {
    const OGRLinearRing* line = part->getExteriorRing();
    Ring ring;
    for (int k = 0; line != nullptr && k < line->getNumPoints(); ++k) ring.push_back({line->getX(k), line->getY(k)});
    rings.push_back(std::move(ring));
  }
  return rings;
}

bool has_only_outer_rings(const OGRMultiPolygon& parts) {
  return std::all_of(parts.begin(), parts.end(),
                     [](const OGRPolygon* part) { return part->getNumInteriorRings() == 0; });
}

}  // namespace

bool is_of_rings_as_they_stand(const std::string& warning) {
  return warning.find("cannot be translated to Simple Geometry") != std::string::npos;
}

std::vector<std::vector<Ring>> polygons_of_rings(const std::vector<Ring>& rings) {
  const Nesting nesting(rings);
  std::vector<std::size_t> outer, holes, stray;
  for (std::size_t k = 0; k < rings.size(); ++k) (nesting.is_outer(k) ? outer : holes).push_back(k);
  std::vector<std::optional<std::size_t>> round(rings.size());
  for (const std::size_t k : holes) {
    round[k] = nesting.nearest_round(k, outer);
    if (!round[k]) stray.push_back(k);
  }
  for (const std::size_t k : stray) {
    const auto depth =
        std::count_if(stray.begin(), stray.end(), [&](std::size_t other) { return nesting.is_round(other, k); });
    if (depth % 2 == 1) round[k] = nesting.nearest_round(k, stray);
  }
  std::vector<std::vector<Ring>> polygons;
  std::vector<std::size_t> polygon_of(rings.size());
  for (std::size_t k = 0; k < rings.size(); ++k) {
    if (round[k]) continue;
    polygon_of[k] = polygons.size();
    polygons.push_back({rings[k]});
  }
  for (std::size_t k = 0; k < rings.size(); ++k)
    if (round[k]) polygons[polygon_of[*round[k]]].push_back(rings[k]);
  return polygons;
}

void group_rings(OGRFeature& feature) {
  const OGRGeometry* geometry = feature.GetGeometryRef();
  if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbMultiPolygon) return;
  const OGRMultiPolygon& parts = *geometry->toMultiPolygon();
  if (!has_only_outer_rings(parts)) return;
  auto grouped = std::make_unique<OGRMultiPolygon>();
  for (const std::vector<Ring>& rings : polygons_of_rings(rings_of_parts(parts))) {
    auto polygon = std::make_unique<OGRPolygon>();
    for (const Ring& points : rings) {
      OGRLinearRing ring;
      ring.setNumPoints(static_cast<int>(points.size()));
      for (std::size_t k = 0; k < points.size(); ++k) ring.setPoint(static_cast<int>(k), points[k].x, points[k].y);
      polygon->addRing(&ring);
    }
    grouped->addGeometryDirectly(polygon.release());
  }
  feature.SetGeometryDirectly(grouped.release());
}

}  // namespace exactvo::datasets
