// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/geometry_visitor.h"

#include <memory>

#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

geometry::Ring points_of(const OGRSimpleCurve& curve) {
  geometry::Ring points(static_cast<std::size_t>(curve.getNumPoints()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {curve.getX(static_cast<int>(i)), curve.getY(static_cast<int>(i))};
  }
  return points;
}

std::vector<geometry::Ring> rings_of(const OGRPolygon& polygon) {
  std::vector<geometry::Ring> rings;
  for (const OGRLinearRing* ring : polygon) rings.push_back(points_of(*ring));
  return rings;
}

}  // namespace

void visit(const OGRGeometry& geometry, const Visitor& visitor, int depth) {
  if (depth > kDeepestCollection) return visitor.other("collections nested too deeply skipped");
  if (geometry.IsEmpty()) return visitor.other(std::string("an empty ") + geometry.getGeometryName() + " skipped");
  switch (wkbFlatten(geometry.getGeometryType())) {
    case wkbPoint:
    case wkbMultiPoint:
      return visitor.other("a " + std::string(geometry.getGeometryName()) + " skipped: points are no obstacles");
    case wkbLineString:
      return visitor.shape(RawKind::polyline, {points_of(*geometry.toLineString())});
    case wkbPolygon:
    case wkbTriangle:
      return visitor.shape(RawKind::polygon, rings_of(*geometry.toPolygon()));
    case wkbMultiLineString:
    case wkbMultiPolygon:
    case wkbGeometryCollection:
      for (const OGRGeometry* part : *geometry.toGeometryCollection()) visit(*part, visitor, depth + 1);
      return;
    default:
      break;
  }
  const std::unique_ptr<OGRGeometry> straight(geometry.getLinearGeometry());
  if (straight && wkbFlatten(straight->getGeometryType()) != wkbFlatten(geometry.getGeometryType())) {
    return visit(*straight, visitor, depth + 1);
  }
  visitor.other(std::string("a ") + geometry.getGeometryName() + " skipped: no line or polygon");
}

}  // namespace exactvo::datasets
