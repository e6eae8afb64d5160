// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <ogr_spatialref.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/geometry/box.h"
#include "gdal/degree_box.h"
#include "gdal/gdal_session.h"
#include "gdal/properties.h"
#include "readers/raw_geometry.h"

namespace exactvo::datasets {

/// What is known of a layer's numbers before they are read.
struct LayerNumbers {
  std::string name;                             ///< of the layer, for errors
  const OGRSpatialReference* system = nullptr;  ///< null: none is named
  Units units = Units::automatic;
  std::string reason;             ///< why the units are those
  bool is_perhaps_metres = true;  ///< where it names degrees by default only: numbers that are none are metres then
  /// Calls with every ring and line. May be called several times.
  std::function<void(const std::function<void(const geometry::Ring&)>&)> for_each_ring;
  std::optional<DegreeBox> box{};  ///< of all rings, where it is known already
};

/// From the numbers of a layer to metres on a plane, and back to degrees for people.
class LayerPlane {
 public:
  /// All must outlive this.
  LayerPlane(const std::filesystem::path& path, Collector& out, GdalComplaints& complaints)
      : path_(path), out_(out), complaints_(complaints) {}

  /// Begins the next layer: its numbers are metres as they stand.
  void reset();
  /// What the file says of its plane.
  void set_given(GivenPlane given) { given_ = std::move(given); }
  /// Decides what the numbers become, and tells the collector; the words of it, empty for a layer without any. Throws
  /// DataError (E_PROJECTION; E_LIBRARY).
  std::string settle(const LayerNumbers& layer);

  /// Throws DataError (E_PROJECTION) where a point has no place on the plane.
  void bring_to_metres(geometry::Ring& ring, const std::string& place);
  /// The rings before they are brought to metres; none where that changes nothing.
  std::optional<AsWritten> as_written(const std::vector<geometry::Ring>& rings);
  /// Tells the collector the extent of what it took and its distortion, after all layers.
  void note_extent();

 private:
  std::string settle_as_they_stand(const std::string& words);
  std::string settle_degrees(const LayerNumbers& layer);
  std::string settle_impossible_degrees(const LayerNumbers& layer);
  std::string settle_other_system(const LayerNumbers& layer);
  std::string settle_projected(const LayerNumbers& layer, const geometry::Box& box);
  std::string keep_units(const OGRSpatialReference& system, const std::optional<Distortion>& distortion);
  std::string project_round(const LayerNumbers& layer, const DegreeBox& box, OGRSpatialReference from,
                            const std::string& reason);
  void choose_local(OGRSpatialReference& local, const OGRSpatialReference& from, const DegreeBox& box);
  OGRSpatialReference named_plane() const;
  void check_named_plane(const OGRSpatialReference& plane, const DegreeBox& box);
  void check_reach(const LayerNumbers& layer, const DegreeBox& box);
  double farthest_of(const geometry::Ring& ring);
  [[noreturn]] void refuse_far(const std::string& place, double metres) const;
  void add_distortion(const Distortion& distortion);

  void project(geometry::Ring& ring, const std::string& place);
  [[noreturn]] void refuse_unplaced(geometry::Vec2 written, const std::string& place);
  geometry::Vec2 back_to_numbers(geometry::Vec2 p);

  const std::filesystem::path& path_;
  Collector& out_;
  GdalComplaints& complaints_;
  double scale_ = 1.0;  ///< m a unit
  GivenPlane given_;    ///< by GeoJSON's member "local_metres"
  LocalPlane plane_;
  bool numbers_are_degrees_ = true;
  std::optional<ProjectionOrigin> origin_;  ///< one for all layers
  double semi_minor_ = 0.0;                 ///< m; of the ellipsoid of the plane; 0: it is not ours, or nowhere
  std::optional<Distortion> distortion_;    ///< of all layers
  std::unique_ptr<OGRCoordinateTransformation> to_metres_;
  std::unique_ptr<OGRCoordinateTransformation> from_metres_;  ///< made when a place is to be named
};

}  // namespace exactvo::datasets
