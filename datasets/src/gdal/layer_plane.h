// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ogr_spatialref.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/box.h"
#include "gdal/gdal_session.h"
#include "gdal/properties.h"
#include "readers/raw_geometry.h"

namespace exactvo::datasets {

/// From the numbers of a layer to metres on a plane, and back to degrees for people.
class LayerPlane {
 public:
  /// All must outlive this.
  LayerPlane(const std::filesystem::path& path, Collector& out, GdalComplaints& complaints)
      : path_(path), out_(out), complaints_(complaints) {}

  /// Of the next layer: its numbers are metres as they stand.
  void reset();
  void set_scale(double metres_a_unit) { scale_ = metres_a_unit; }
  /// What the file says of its plane.
  void set_given(GivenPlane given) { given_ = std::move(given); }
  /// Degrees: to the plane that the file names, else to one of its own, round the middle of its box, the same for all
  /// layers. False where GDAL has no way there, and says why in its complaints. Throws DataError (E_PROJECTION).
  bool project_round(const geometry::Box& box, OGRSpatialReference from);
  /// The plane that metres are on after that; none where the file says that they have no place.
  LocalPlane plane() const { return given_.is_placed ? plane_ : LocalPlane{}; }

  bool is_named() const { return !given_.plane.reference_system.empty(); }
  /// REQUIRES: `project_round` to a plane that is not named.
  const ProjectionOrigin& origin() const { return *origin_; }

  /// Throws DataError (E_PROJECTION) where a point has no place on the plane.
  void bring_to_metres(geometry::Ring& ring, const std::string& place);
  /// Of the rings before they are brought to metres; none where that changes nothing.
  std::optional<AsWritten> as_written(const std::vector<geometry::Ring>& rings);

 private:
  void project(geometry::Ring& ring, const std::string& place);
  [[noreturn]] void refuse_unplaced(geometry::Vec2 written, const std::string& place);
  geometry::Vec2 back_to_degrees(geometry::Vec2 p);

  const std::filesystem::path& path_;
  Collector& out_;
  GdalComplaints& complaints_;
  double scale_ = 1.0;  ///< m a unit
  GivenPlane given_;    ///< by GeoJSON's member "local_metres"
  LocalPlane plane_;
  std::optional<ProjectionOrigin> origin_;  ///< one for all layers
  std::unique_ptr<OGRCoordinateTransformation> to_metres_;
  std::unique_ptr<OGRCoordinateTransformation> from_metres_;  ///< made when a place is to be named
};

}  // namespace exactvo::datasets
