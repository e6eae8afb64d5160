// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/layer_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "files/text_file.h"
#include "gdal/vector_library.h"
#include "json/json_text.h"

namespace exactvo::datasets {
namespace {

/// A millionth of a degree (0.1 m): a centre that people can copy. A billionth (0.1 mm): a place to zoom to.
constexpr double kCentreDecimals = 1e6;
constexpr double kCrossingDecimals = 1e9;
/// A digit more than doubles of degrees beyond 100 have: what was written in fewer comes back as it was.
constexpr double kWrittenDecimals = 1e13;

double rounded_degrees(double degrees, double decimals) {
  return std::round(degrees * decimals) / decimals;
}

/// Characters of a text that is no reference system.
constexpr std::size_t kShownText = 40;

[[noreturn]] void refuse_nowhere(geometry::Vec2 p, const LocalPlane& plane, const std::string& file) {
  throw DataError(
      DataCode::projection, file, "",
      number_text(p.x) + ", " + number_text(p.y) + " m, which has no longitude and latitude",
      plane.is_placed() ? "a place on earth" : "coordinates within 1000 km of their middle, or GeoJSON in metres");
}

}  // namespace

void LayerPlane::reset() {
  to_metres_.reset();
  from_metres_.reset();
  scale_ = 1.0;
  given_ = GivenPlane{};
}

bool LayerPlane::project_round(const geometry::Box& box, OGRSpatialReference from) {
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  LocalPlane plane = given_.plane;
  OGRSpatialReference local;
  if (!plane.reference_system.empty()) {
    const char* const without_files[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
    const bool known = local.SetFromUserInput(plane.reference_system.c_str(), without_files) == OGRERR_NONE &&
                       local.IsProjected() && local.GetLinearUnits() == 1.0;
    complaints_.take_failure();
    if (!known) {
      throw DataError(DataCode::projection, path_.string(), "/local_metres/reference_system",
                      excerpt(plane.reference_system, 0, kShownText), "a projected reference system in metres, as WKT");
    }
    local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
    plane.reference_system = wkt_of(local);
  } else {
    if (!origin_) {
      origin_ = plane.origin.value_or(ProjectionOrigin{rounded_degrees((box.low.x + box.high.x) / 2, kCentreDecimals),
                                                       rounded_degrees((box.low.y + box.high.y) / 2, kCentreDecimals)});
      if (given_.is_placed) out_.set_origin(*origin_);
    }
    local = plane_round(from, *origin_);
    plane.origin = origin_;
    if (from.IsSameGeogCS(OGRSpatialReference::GetWGS84SRS()) == FALSE)
      plane = {std::nullopt, wkt_of(local), plane.offset};
  }
  plane_ = plane;
  to_metres_.reset(OGRCreateCoordinateTransformation(&from, &local));
  return to_metres_ != nullptr;
}

void LayerPlane::bring_to_metres(geometry::Ring& ring, const std::string& place) {
  if (to_metres_ != nullptr) return project(ring, place);
  for (geometry::Vec2& p : ring)
    if (geometry::is_finite(p)) p = scale_ * p;
}

/// Many points a call: PROJ takes longer to be asked than to answer.
void LayerPlane::project(geometry::Ring& ring, const std::string& place) {
  constexpr std::size_t kPoints = 4096;
  std::vector<std::size_t> taken;
  std::vector<double> x, y;
  std::vector<int> success(kPoints);
  for (std::size_t begin = 0; begin < ring.size(); begin += kPoints) {
    taken.clear();
    x.clear();
    y.clear();
    for (std::size_t k = begin; k < std::min(begin + kPoints, ring.size()); ++k) {
      if (!geometry::is_finite(ring[k])) continue;
      taken.push_back(k);
      x.push_back(ring[k].x);
      y.push_back(ring[k].y);
    }
    to_metres_->Transform(static_cast<int>(taken.size()), x.data(), y.data(), nullptr, success.data());
    for (std::size_t k = 0; k < taken.size(); ++k) {
      geometry::Vec2& p = ring[taken[k]];
      if (!success[k]) refuse_unplaced(p, place);
      p = given_.rounded(geometry::Vec2{x[k], y[k]} + given_.plane.offset);
    }
  }
}

void LayerPlane::refuse_unplaced(geometry::Vec2 written, const std::string& place) {
  complaints_.take_failure();
  throw DataError(
      DataCode::projection, path_.string(), place,
      "a point that has no place on the local plane: " + number_text(written.x) + ", " + number_text(written.y),
      "coordinates near each other");
}

std::optional<AsWritten> LayerPlane::as_written(const std::vector<geometry::Ring>& rings) {
  if (to_metres_ != nullptr) return AsWritten{rings, [this](geometry::Vec2 p) { return back_to_degrees(p); }, true};
  if (scale_ == 1.0) return std::nullopt;
  return AsWritten{rings, [scale = scale_](geometry::Vec2 p) { return p / scale; }, false};
}

/// For people: a crossing that rounding moved.
geometry::Vec2 LayerPlane::back_to_degrees(geometry::Vec2 p) {
  p = p - given_.plane.offset;
  if (from_metres_ == nullptr) from_metres_.reset(to_metres_->GetInverse());
  if (from_metres_ == nullptr || !from_metres_->Transform(1, &p.x, &p.y)) {
    complaints_.take_failure();
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    return {kNowhere, kNowhere};
  }
  return {rounded_degrees(p.x, kCrossingDecimals), rounded_degrees(p.y, kCrossingDecimals)};
}

// --- Reference systems, and metres to degrees ---

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

PlaneTransform make_plane_transform(LocalPlane plane, std::string file) {
  OGRSpatialReference degrees = *OGRSpatialReference::GetWGS84SRS();
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  GdalComplaints complaints;
  OGRSpatialReference metres;
  if (plane.reference_system.empty()) {
    metres = plane_round(degrees, plane.origin.value_or(ProjectionOrigin{}));
  } else {
    metres.importFromWkt(plane.reference_system.c_str());
  }
  metres.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::shared_ptr<OGRCoordinateTransformation> transform(OGRCreateCoordinateTransformation(&metres, &degrees));
  const std::string words = complaints.take_failure();
  if (transform == nullptr)
    throw DataError(DataCode::projection, file, "", words.empty() ? "a plane without a way to degrees" : words,
                    "a reference system that PROJ knows");
  return [plane = std::move(plane), file = std::move(file), transform](std::vector<geometry::Vec2> points) {
    const GdalComplaints unheard;  // a point without a place is refused in words of our own
    for (geometry::Vec2& p : points) {
      const geometry::Vec2 given = p;
      p = p - plane.offset;
      const bool is_far = !plane.is_placed() && std::max(std::fabs(p.x), std::fabs(p.y)) > kLargestUnplaced;
      const bool worked = !is_far && transform->Transform(1, &p.x, &p.y) != FALSE;
      if (!worked || !geometry::is_finite(p)) refuse_nowhere(given, plane, file);
      p = {rounded_degrees(p.x, kWrittenDecimals) + 0.0, rounded_degrees(p.y, kWrittenDecimals) + 0.0};  // no -0
    }
    return points;
  };
}

}  // namespace exactvo::datasets
