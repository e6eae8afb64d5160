// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What a reader hands on: rings as they stand in the file, not yet validated; and the collector that validates them.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"

namespace exactvo::datasets {

enum class RawKind { polyline, polygon };

/// How a format winds outer rings; holes run the other way.
enum class Winding { counter_clockwise, clockwise };

/// A geometry names a reference system, EPSG:`srid`, and nothing was read before it: to be read anew in that.
struct ReferenceSystemMet {
  int srid;
};

/// The numbers of a file that is not in metres.
struct AsWritten {
  std::vector<geometry::Ring> rings;
  std::function<geometry::Vec2(geometry::Vec2)> from_metres;
  bool is_degrees = false;
};

/// One geometry of a file. A polyline has one ring.
struct RawGeometry {
  RawKind kind = RawKind::polygon;
  std::string id;                                ///< becomes the obstacle's
  std::string place;                             ///< "feature 3", "line 12", "/obstacles/4"
  std::vector<geometry::Ring> rings;             ///< closed or not, any winding
  std::vector<std::string> ring_pointers{};      ///< JSON pointers of the rings; empty for other formats
  std::optional<AsWritten> as_written{};         ///< none where `rings` stand in the file
  FeatureProperties properties{};                ///< only where `ReadOptions::keep_properties` asks for them
  Winding winding = Winding::counter_clockwise;  ///< as the format demands it
  std::optional<geometry::Disc> disc{};          ///< round which the polygon is
};

/// Part `number`, from 0, of a geometry; the second and later ones have it behind their ids and places.
RawGeometry part_of_geometry(std::size_t number, RawKind kind, const std::string& id, const std::string& place,
                             std::vector<geometry::Ring> rings);

/// "feature 3, ring 0, vertex 17", or the ring's pointer "/obstacles/4/polygon": the vertex alone is not at fault.
std::string place_of_vertex(const RawGeometry& raw, std::size_t ring, std::size_t vertex);

/// The shape put in order, and what was found in it; to be used only if all of that was repaired.
struct ValidationResult {
  geometry::Obstacle shape;
  std::vector<RingFinding> findings;         ///< kMostFindings at most, the first that was not repaired among them
  std::map<DataCode, std::size_t> unlisted;  ///< the others
};
ValidationResult validate(const RawGeometry& raw);

DataError ring_refusal(const RingFinding& finding, const std::string& file);

/// Throws DataError for the first finding that was not repaired.
void refuse_unrepaired(const ValidationResult& checked, const std::string& file);

/// E_PROJECTION: a geometry of another reference system than those before it; 0: none.
DataError other_system(int srid, int before, const std::string& file, const std::string& place);

/// Gathers a file's geometries into an ObstacleFile and keeps the books. Virtual, so that a reader in a module that is
/// loaded (vector_library.h) runs the program's copy of the geometry behind it, not one of its own.
class Collector {
 public:
  /// With a stream nothing is kept of single obstacles; it must outlive the collector.
  Collector(std::string file, std::string format, const ReadOptions& options, const ObstacleStream* stream = nullptr);
  virtual ~Collector() = default;
  Collector(const Collector&) = delete;
  Collector& operator=(const Collector&) = delete;

  virtual void add(const RawGeometry& raw);
  virtual void pass_over(std::string place, std::string text);
  /// A note on the file or on a layer.
  virtual void note(std::string place, std::string text);
  /// Before a geometry that may name a reference system: 0 where it names none. Throws ReferenceSystemMet, or DataError
  /// (E_PROJECTION) where an earlier geometry of the file names another.
  virtual void reference_system(int srid, const std::string& place);
  /// Counts it, and throws it unless reading goes on.
  virtual void reject(DataError error);
  /// `from`: what was projected round it.
  void set_origin(ProjectionOrigin origin, std::string from) {
    result_.origin = origin;
    result_.projected_from = std::move(from);
  }
  void set_distortion(const Distortion& distortion) { result_.distortion = distortion; }
  /// For everything that is added from now on.
  void set_plane(const LocalPlane& plane);
  /// Grows the file's extent.
  virtual void extend(const geometry::Obstacle& shape);
  const std::optional<Extent>& extent() const { return result_.extent; }
  void set_coverage(Coverage coverage) { result_.coverage = coverage; }
  /// How much of the file is read, 0 to 1.
  virtual void progress(double share) const {
    if (stream_ != nullptr && stream_->progress) stream_->progress(share);
  }

  const std::string& file() const { return result_.file; }
  const ReadOptions& options() const { return options_; }
  ObstacleFile take() { return std::move(result_); }

 private:
  /// Whether it has a coordinate beyond kLargestCoordinate.
  bool reject_far(const RawGeometry& raw);
  /// Where `repair` may do more than `validate`.
  void add_repaired(const RawGeometry& raw);
  DataError refusal_of(DataCode reason, const ValidationResult& checked, const std::string& place) const;
  void take_findings(const std::vector<RingFinding>& findings, const std::map<DataCode, std::size_t>& unlisted = {});
  void count(const std::vector<RingFinding>& findings);
  void keep(const RawGeometry& raw, std::string id, geometry::Obstacle shape, bool repaired);

  ObstacleFile result_;
  ReadOptions options_;
  const ObstacleStream* stream_;
  std::size_t notes_of_findings_ = 0;
  bool has_plane_ = false;
  std::optional<int> srid_;  ///< of the first geometry
};

}  // namespace exactvo::datasets
