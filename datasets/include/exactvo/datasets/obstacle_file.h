// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Obstacles from files. Whatever the format, what comes out is in metres, outer rings counter-clockwise, holes
/// clockwise, first point not repeated, every ring simple (geometry/validity.h, `normalize`). What has one right answer
/// is repaired and noted; what has not is refused with a code, the feature, the ring, the vertex and its coordinates.
///
/// Coordinates. A file in a projected reference system is scaled to metres and otherwise left where it is, if its
/// lengths are those on the ground within kMostDistortion. One in degrees (a geographic reference system; GeoJSON
/// unless told otherwise, RFC 7946), or in a reference system that does not keep lengths (Web Mercator), is brought to
/// local metres by the azimuthal equidistant projection on its ellipsoid round the middle of its bounding box, on the
/// circle of longitudes; that centre is recorded, and how far lengths and areas are from those on the ground. A file
/// that reaches too far for kMostDistortion is refused (E_PROJECTION). SRID=N; before WKT names the reference system
/// EPSG:N. A GeoJSON file says that it is in metres by a top-level member `"units": "m"`; a caller says so by
/// `ReadOptions::units`. One that `write_obstacles` wrote in degrees names its plane in `"local_metres"`
/// (obstacle_write.h) and is brought to that. A GeoJSON file that says nothing and has a coordinate beyond +-180 or
/// +-90 degrees, by more than the millionth that writers round by, is taken as metres. The notes of a file read by GDAL
/// say how its units were decided, which point is the centre of the projection, and how far the file extends.
///
/// Heights (Z, M) are dropped. Points are no obstacles: skipped, with a note. A coordinate beyond
/// kLargestCoordinate is refused (E_RANGE), whatever the format.

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/local_plane.h"
#include "exactvo/datasets/repair.h"
#include "exactvo/formation/scenario.h"
#include "exactvo/geometry/box.h"

namespace exactvo::datasets {

/// Largest coordinate accepted from a file, m: squares, areas and the entries of ellipses stay far from overflow. Rings
/// that are cut (geometry/even_odd.h) and the apex of a cone (vo/free_velocities.h) have the same limit.
inline constexpr double kLargestCoordinate = 0x1p100;

/// The unit of the coordinates of a file.
enum class Units {
  automatic,  ///< as the file says (above)
  metres,     ///< m, whatever the file says
  degrees     ///< longitude, latitude on WGS 84
};
/// "automatic", "metres", "degrees".
const char* name(Units units);
/// False where the word names none.
bool parse(const std::string& text, Units& out);
/// All, in the order of the enumeration.
std::vector<std::string> unit_names();

/// What the unknown cells of a map are: those between its thresholds, and transparent ones. Known for ROS maps only.
enum class UnknownCells {
  free,    ///< free; a note says how many
  blocked  ///< obstacles, as the occupied cells; a note says how many
};
/// "free", "blocked".
const char* name(UnknownCells unknown);
/// False where the word names none.
bool parse(const std::string& text, UnknownCells& out);
/// All, in the order of the enumeration.
std::vector<std::string> unknown_cells_names();

/// How a file is read.
struct ReadOptions {
  std::string format;              ///< a name of `readable_formats()`; empty: chosen by content, then by extension
  Units units = Units::automatic;  ///< what the numbers mean
  UnknownCells unknown = UnknownCells::free;  ///< what unknown cells of a grid become
  double cell_size =
      0.0;  ///< m, >= 0: side of a grid's or scan's cell; 0: 1 m for grids without a scale, 0.05 m for scans
  /// False: the first obstacle that can't be used throws. True: it is put into `rejected` and reading goes on.
  bool keep_going = false;
  /// True: `ObstacleFile::properties` are kept.
  bool keep_properties = false;
  /// True: what `repair` (repair.h) repairs is no refusal. A polygon may become several obstacles: "7", "7-2", "7-3".
  bool repair = false;
};

/// Something that a reader should know and that did not stop the reading: a repair, or something skipped.
struct DataNote {
  std::optional<DataCode> code;  ///< of a repair; none where something was merely skipped
  std::string place;             ///< "feature 3, ring 0, vertex 17"
  std::string text;              ///< "ring closed", "point skipped"
  bool of_feature = false;       ///< of one feature or line; else of the file or a layer
};

/// Numbers that stand in a file and are no metres, so that a finding can be searched for there.
struct PlaceInFile {
  geometry::Vec2 where;     ///< a vertex as it is written; else brought back from metres, degrees to nine decimals
  bool is_degrees = false;  ///< longitude, latitude; else units of the file's reference system
};

/// This many findings of a file are listed, the others counted (`ObstacleFile::unlisted`): a report must not take a
/// hundred times the size of its file.
inline constexpr std::size_t kMostFindings = 100'000;

/// One problem of one ring, repaired or not; also of obstacles that were refused.
struct RingFinding {
  DataCode code = DataCode::self_intersection;  ///< what is wrong
  std::string place;                            ///< "feature 3, ring 0, vertex 17"
  std::string feature;                          ///< "feature 3"
  geometry::Vec2 where;                         ///< m
  std::size_t ring = 0;                         ///< 0 is the outer one
  std::size_t vertex = 0;                       ///< as the file lists them
  bool repaired = false;                        ///< repaired by `normalize` (validity.h)
  geometry::Vec2 at_vertex;            ///< the vertex as it is written; `where` may lie on an edge from or to it
  std::optional<PlaceInFile> in_file;  ///< `where`, where the file is not in metres
};

/// What was found, for people: "a hole that is not inside its polygon or meets another ring".
const char* words_of(const RingFinding& finding);

/// "(11, 1), on an edge at vertex (10, 0)"; "longitude 13.001, latitude 52.001 (0.5, 2 m)".
std::string words_of_place(const RingFinding& finding);

/// What `ReadOptions::repair` made of one polygon that had a problem.
struct RepairRecord {
  std::string place;                  ///< "feature 3"
  std::string id;                     ///< of the first obstacle that it became
  std::vector<DataCode> codes;        ///< of its problems, each once, in the order of the documentation
  std::optional<DataCode> refused;    ///< why nothing could be made of it
  bool recombined = false;            ///< by the even-odd rule
  double moved = 0.0;                 ///< m
  std::vector<geometry::Ring> given;  ///< where recombined: the rings before, m
  RepairFacts before;                 ///< the polygon as given
  RepairFacts after;                  ///< what it became
};

/// The properties of a feature, without its shape, as JSON texts.
struct FeatureProperties {
  std::string id;       ///< a number or a string, as the file gives it; empty where it gives none
  std::string members;  ///< an object; empty where there are none
};

/// The box of all vertices of the obstacles that were taken, m.
using Extent = geometry::Box;

/// An input counts as `read`; each ends as an obstacle (`done` or `repaired`), skipped or in `rejected`.
struct ReadCounts {
  std::size_t read = 0;         ///< geometries met: polygons and polylines, one each, and points
  std::size_t done = 0;         ///< obstacles as they stood
  std::size_t repaired = 0;     ///< inputs that became one obstacle or several after a repair
  std::size_t passed_over = 0;  ///< points, empty geometries
  std::size_t rejected = 0;     ///< refused, each with a code
};

/// The coverage of a grid or a scan. Its polygons are the union of the occupied cells, which they contain whole. They
/// add no area to a grid; hits of a scan are points, without area.
struct Coverage {
  std::size_t cells = 0;     ///< of the whole grid
  std::size_t occupied = 0;  ///< of them
  double cell_area = 0.0;    ///< m^2; times `occupied` is the polygons' area
};

/// How far lengths and areas on the plane are from those on the ground, as shares of them, at most. The
/// azimuthal equidistant projection makes both too large, never too small, between any two points of the file
/// (certified: derived in gdal/ground_scale.h). For a file's own reference system they are measured at 289 places over
/// its extent.
struct Distortion {
  double length = 0.0;     ///< of lengths
  double area = 0.0;       ///< of areas
  bool certified = false;  ///< whether these are bounds
};

/// A file is refused if its lengths would differ from those on the ground by more than this share. Coordinates in
/// degrees reach 1 % some 1551 km from their middle.
inline constexpr double kMostDistortion = 0.01;

/// The content of a file, and the findings about it.
struct ObstacleFile {
  std::string file;                                 ///< its path, as the caller named it
  std::string format;                               ///< the one that was used
  std::vector<formation::SceneObstacle> obstacles;  ///< in the order of the file
  std::vector<FeatureProperties>
      properties;                     ///< with `keep_properties`: one an obstacle; empty where no feature has any
  LocalPlane plane;                   ///< the plane of the obstacles' coordinates; unplaced if layers lie on several
  std::vector<DataNote> notes;        ///< repairs and what was skipped
  std::vector<RingFinding> findings;  ///< in the order of the file; kMostFindings at most
  std::map<DataCode, std::size_t> unlisted;  ///< findings that are not listed, by code
  std::vector<DataError> rejected;           ///< only with `keep_going`
  std::vector<RepairRecord> repairs;         ///< only with `repair`: one for every polygon that had a problem
  std::optional<ProjectionOrigin> origin;    ///< where degrees, or what `projected_from` names, were projected
  std::string projected_from;            ///< "degrees", or the name of the file's reference system; empty: no origin
  std::optional<Distortion> distortion;  ///< where the place on earth is known
  std::optional<Extent> extent;          ///< none without obstacles
  std::optional<Coverage> coverage;      ///< of grids and scans
  ReadCounts counts;                     ///< how many inputs there were and how they ended
};

/// Reads a whole file. Throws DataError: for the file, and (unless `keep_going`) for its first bad obstacle.
ObstacleFile read_obstacles(const std::filesystem::path& path, const ReadOptions& options = {});

/// Where obstacles go that are not to be kept: called one by one, in the order of the file, while it is read. What is
/// thrown in them ends the reading and comes out of it, unless it is a DataError about a format.
struct ObstacleStream {
  /// Takes an obstacle; `repaired`: it came of a repair.
  std::function<void(formation::SceneObstacle obstacle, bool repaired)> obstacle;
  /// Takes the error of an obstacle that was refused.
  std::function<void(DataError error)> rejected;
  std::function<void(double share)> progress;  ///< of the file that is read, 0 to 1; only where a reader knows
  std::function<void(const LocalPlane& plane)> plane{};  ///< of the obstacles that follow; only where a reader knows
};

/// The same, obstacle by obstacle: what comes back holds the counts and what concerns the file as a whole, but no
/// obstacle and nothing about single ones. Plain WKT, and what GDAL gives feature by feature, takes no more memory for
/// a longer file. `keep_going` is implied.
ObstacleFile read_obstacles(const std::filesystem::path& path, const ReadOptions& options,
                            const ObstacleStream& stream);

/// Plain WKT from text: one geometry a line or one spread over many; nested collections, EMPTY, Z and M. Needs no GDAL.
ObstacleFile parse_wkt(const std::string& text, const std::string& file_name, const ReadOptions& options = {});

/// The format that a file's content and name tell. Throws DataError where they tell none.
std::string format_of(const std::filesystem::path& path);
/// Whether that is a guess, by the name or by lines of numbers that files of other formats may have too. Throws as
/// `format_of`.
bool may_be_another_format(const std::filesystem::path& path);

/// The names that `ReadOptions::format` takes in this build.
std::vector<std::string> readable_formats();

/// Whether vector files other than plain WKT can be read.
bool built_with_gdal();

}  // namespace exactvo::datasets
