// SPDX-License-Identifier: GPL-3.0-or-later
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "gdal/gdal_session.h"
#include "gdal/plane_system.h"
#include "gdal/plane_transform.h"
#include "json/json_text.h"

namespace exactvo::datasets {
namespace {

/// A digit more than doubles of degrees beyond 100 have: what was written in fewer comes back as it was.
constexpr double kDecimals = 1e13;

double rounded_degrees(double degrees) {
  const double rounded = std::round(degrees * kDecimals) / kDecimals;
  return rounded + 0.0;  // takes the sign off -0
}

}  // namespace

OGRSpatialReference plane_round(const OGRSpatialReference& geographic, const ProjectionOrigin& origin) {
  OGRSpatialReference local;
  local.CopyGeogCSFrom(&geographic);
  local.SetAE(origin.latitude, origin.longitude, 0.0, 0.0);
  return local;
}

std::string wkt_of(const OGRSpatialReference& system) {
  const char* const options[] = {"FORMAT=WKT2_2019", "MULTILINE=NO", nullptr};
  char* text = nullptr;
  const bool worked = system.exportToWkt(&text, options) == OGRERR_NONE && text != nullptr;
  std::string wkt = worked ? text : "";
  CPLFree(text);
  return wkt;
}

namespace {

class ToDegrees {
 public:
  ToDegrees(LocalPlane given, std::string named) : plane_(std::move(given)), file_(std::move(named)) {
    GdalComplaints complaints;
    OGRSpatialReference degrees = *OGRSpatialReference::GetWGS84SRS();
    degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    OGRSpatialReference metres;
    if (plane_.reference_system.empty()) {
      metres = plane_round(degrees, plane_.origin.value_or(ProjectionOrigin{}));
    } else {
      metres.importFromWkt(plane_.reference_system.c_str());
    }
    metres.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    transform_.reset(OGRCreateCoordinateTransformation(&metres, &degrees));
    const std::string words = complaints.take_failure();
    if (transform_ == nullptr)
      throw DataError(DataCode::projection, file_, "", words.empty() ? "a plane without a way to degrees" : words,
                      "a reference system that PROJ knows");
  }

  std::vector<geometry::Vec2> operator()(std::vector<geometry::Vec2> points) const {
    const GdalComplaints unheard;  // a point without a place is refused in words of our own
    for (geometry::Vec2& p : points) {
      const geometry::Vec2 given = p;
      p = p - plane_.offset;
      const bool is_far = !plane_.is_placed() && std::max(std::fabs(p.x), std::fabs(p.y)) > kLargestUnplaced;
      const bool worked = !is_far && transform_->Transform(1, &p.x, &p.y) != FALSE;
      if (!worked || !geometry::is_finite(p)) refuse(given);
      p = {rounded_degrees(p.x), rounded_degrees(p.y)};
    }
    return points;
  }

 private:
  [[noreturn]] void refuse(geometry::Vec2 p) const {
    std::string found;
    append_number(found, p.x);
    found += ", ";
    append_number(found, p.y);
    throw DataError(
        DataCode::projection, file_, "", found + " m, which has no longitude and latitude",
        plane_.is_placed() ? "a place on earth" : "coordinates within 1000 km of their middle, or GeoJSON in metres");
  }

  LocalPlane plane_;
  std::string file_;
  std::unique_ptr<OGRCoordinateTransformation> transform_;
};

}  // namespace

PlaneTransform make_plane_transform(LocalPlane plane, std::string file) {
  const auto transform = std::make_shared<const ToDegrees>(std::move(plane), std::move(file));
  return [transform](std::vector<geometry::Vec2> points) { return (*transform)(std::move(points)); };
}

}  // namespace exactvo::datasets
