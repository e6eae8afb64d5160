// SPDX-License-Identifier: GPL-3.0-or-later
#include "gdal/layer_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/ground_scale.h"
#include "gdal/vector_library.h"
#include "json/json_text.h"

namespace exactvo::datasets {
namespace {

/// A millionth of a degree (0.1 m): a centre that people can copy. A billionth (0.1 mm): a place to zoom to.
constexpr double kCentreDecimals = 1e6;
constexpr double kCrossingDecimals = 1e9;
constexpr double kCrossingDecimalsOfUnits = 1e4;
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

/// Degrees that a coordinate may lie beyond 180 or 90 and still be one: writers round, and some files hold
/// 180.00000000000014. A millionth of a degree is 0.1 m on the ground.
constexpr double kDegreesBeyond = 1e-6;

/// `turns`: a file of our own goes on beyond 180 where a shape crosses the antimeridian.
bool is_longitude_latitude(const geometry::Box& box, bool turns) {
  const double east = (turns ? 360.0 : 180.0) + kDegreesBeyond, north = 90.0 + kDegreesBeyond;
  return box.low.x >= -east && box.high.x <= east && box.low.y >= -north && box.high.y <= north;
}

/// Within that of the centre of a local plane lengths are within kMostDistortion: where x^2/6 (1 + 0.12 x^2) is that.
double farthest_from_centre(double semi_minor) {
  constexpr double kRadians = 0.2440;
  return kRadians * semi_minor;
}

bool is_in_plain_degrees(const OGRSpatialReference& system) {
  constexpr double kDegree = 3.14159265358979323846 / 180.0, kClose = 1e-12;
  return std::fabs(system.GetAngularUnits() - kDegree) < kClose && system.GetPrimeMeridian() == 0.0;
}

/// The longitudes and latitudes that a system is made of, in degrees from Greenwich.
OGRSpatialReference degrees_of(const OGRSpatialReference& system) {
  OGRSpatialReference degrees;
  degrees.CopyGeogCSFrom(&system);
  if (!is_in_plain_degrees(degrees)) {
    const char* const datum = degrees.GetAttrValue("DATUM");
    const char* const spheroid = degrees.GetAttrValue("SPHEROID");
    OGRSpatialReference plain;
    plain.SetGeogCS("degrees from Greenwich", datum != nullptr ? datum : "unknown",
                    spheroid != nullptr ? spheroid : "unknown", degrees.GetSemiMajor(), degrees.GetInvFlattening());
    degrees = plain;
  }
  degrees.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return degrees;
}

/// 17 x 17 places of a box.
std::vector<geometry::Vec2> places_in(const geometry::Box& box) {
  constexpr int kSteps = 16;
  std::vector<geometry::Vec2> places;
  for (int i = 0; i <= kSteps; ++i) {
    for (int k = 0; k <= kSteps; ++k) {
      const double s = static_cast<double>(i) / kSteps, t = static_cast<double>(k) / kSteps;
      places.push_back({(1 - s) * box.low.x + s * box.high.x, (1 - t) * box.low.y + t * box.high.y});
    }
  }
  return places;
}

/// Those that have an image.
std::vector<geometry::Vec2> transformed(OGRCoordinateTransformation& way, const std::vector<geometry::Vec2>& places) {
  std::vector<geometry::Vec2> images;
  for (geometry::Vec2 p : places)
    if (way.Transform(1, &p.x, &p.y) != FALSE && geometry::is_finite(p)) images.push_back(p);
  return images;
}

std::string name_of(const OGRSpatialReference& system) {
  const char* const name = system.GetName();
  return name != nullptr ? name : "without a name";
}

/// What the header of a drawing says of its unit, which GDAL leaves out: "; its header states millimetres ($INSUNITS)".
/// It is no more than a note, since many programs write a unit that is not that of the numbers: GDAL writes inches.
std::string words_of_drawing_unit(const std::filesystem::path& path) {
  constexpr std::size_t kHeader = std::size_t{1} << 16;  // bytes
  constexpr std::pair<int, const char*> kUnits[] = {{1, "inches"},      {2, "feet"},       {4, "millimetres"},
                                                    {5, "centimetres"}, {7, "kilometres"}, {14, "decimetres"}};
  if (lower_extension(path) != ".dxf") return "";
  const std::string text = read_beginning(path, kHeader);
  const std::size_t name = text.find("$INSUNITS");
  if (name == std::string::npos) return "";
  std::istringstream values(text.substr(text.find('\n', name) + 1));
  int group = 0, unit = 0;
  if (!(values >> group >> unit) || group != 70) return "";
  for (const auto& [code, word] : kUnits)
    if (unit == code) return std::string("; its header states ") + word + " ($INSUNITS)";
  return "";
}

std::string kilometres(double metres) {
  return number_text(std::ceil(metres / 1000.0));
}

}  // namespace

void LayerPlane::reset() {
  to_metres_.reset();
  from_metres_.reset();
  scale_ = 1.0;
  semi_minor_ = 0.0;
  numbers_are_degrees_ = true;
  given_ = GivenPlane{};
}

std::string LayerPlane::settle(const LayerNumbers& layer) {
  if (layer.units == Units::metres) return settle_as_they_stand("metres: " + layer.reason);
  if (layer.units == Units::automatic && layer.system == nullptr)
    return settle_as_they_stand("taken as metres: names no reference system" + words_of_drawing_unit(path_));
  const bool is_other =
      layer.units == Units::automatic && !(layer.system->IsGeographic() != FALSE && is_in_plain_degrees(*layer.system));
  return is_other ? settle_other_system(layer) : settle_degrees(layer);
}

std::string LayerPlane::settle_as_they_stand(const std::string& words) {
  out_.set_plane({});
  return words;
}

std::string LayerPlane::settle_degrees(const LayerNumbers& layer) {
  DegreeBox box;
  if (layer.box) {
    box = *layer.box;
  } else {
    layer.for_each_ring([&](const geometry::Ring& ring) { box.add(ring); });
  }
  if (box.is_empty()) return "";
  const bool names_plane = given_.plane.origin || !given_.plane.reference_system.empty();
  if (!is_longitude_latitude(box.numbers(), names_plane)) return settle_impossible_degrees(layer);
  const bool names_degrees = layer.system != nullptr && layer.system->IsGeographic() != FALSE;
  return project_round(layer, box, names_degrees ? *layer.system : *OGRSpatialReference::GetWGS84SRS(),
                       "degrees: " + layer.reason);
}

std::string LayerPlane::settle_impossible_degrees(const LayerNumbers& layer) {
  if (layer.units == Units::degrees || !layer.is_perhaps_metres) {
    throw DataError(DataCode::projection, path_.string(), layer.name, "coordinates beyond 180 degrees east or 90 north",
                    "longitudes and latitudes");
  }
  return settle_as_they_stand(
      "taken as metres: says nothing of units and has coordinates that are no longitude or latitude");
}

/// Projected, of a place of its own, or in degrees of another kind.
std::string LayerPlane::settle_other_system(const LayerNumbers& layer) {
  const OGRSpatialReference& system = *layer.system;
  if (system.IsGeocentric() != FALSE) {
    throw DataError(DataCode::projection, path_.string(), layer.name,
                    "the reference system " + name_of(system) + ", which counts from the middle of the earth",
                    "longitude and latitude, or a projected reference system");
  }
  const bool has_degrees = system.IsProjected() != FALSE || system.IsGeographic() != FALSE;
  geometry::Box box;
  if (has_degrees) {
    layer.for_each_ring([&](const geometry::Ring& ring) {
      for (const geometry::Vec2 p : ring)
        if (geometry::is_finite(p)) box.add(p);
    });
  }
  return box.is_empty() ? keep_units(system, std::nullopt) : settle_projected(layer, box);
}

/// Numbers whose lengths are nearly those on the ground stay what they are; others become metres on a local plane.
std::string LayerPlane::settle_projected(const LayerNumbers& layer, const geometry::Box& box) {
  OGRSpatialReference system = *layer.system;
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const OGRSpatialReference degrees = degrees_of(system);
  const std::unique_ptr<OGRCoordinateTransformation> inverse(OGRCreateCoordinateTransformation(&system, &degrees));
  const std::vector<geometry::Vec2> places = places_in(box);
  const std::vector<geometry::Vec2> on_earth =
      inverse != nullptr ? transformed(*inverse, places) : std::vector<geometry::Vec2>{};
  const std::unique_ptr<OGRCoordinateTransformation> forward(OGRCreateCoordinateTransformation(&degrees, &system));
  complaints_.take_failure();
  if (on_earth.empty() || forward == nullptr) {
    throw DataError(DataCode::projection, path_.string(), layer.name,
                    "coordinates that have no longitude and latitude in the reference system " + name_of(system),
                    "coordinates of that system; units metres takes them as they stand");
  }
  if (system.IsProjected() != FALSE) {
    const Distortion distortion = measured_distortion(*forward, degrees, system.GetLinearUnits(), on_earth);
    complaints_.take_failure();
    if (on_earth.size() == places.size() && distortion.length <= kMostDistortion) return keep_units(system, distortion);
  }
  DegreeBox degree_box;
  for (const geometry::Vec2 p : on_earth) degree_box.add(p);
  numbers_are_degrees_ = false;
  const std::string kind = system.IsProjected() != FALSE ? "a reference system that does not keep lengths, "
                                                         : "longitudes and latitudes of another kind, ";
  return project_round(layer, degree_box, system, kind + name_of(system));
}

std::string LayerPlane::keep_units(const OGRSpatialReference& system, const std::optional<Distortion>& distortion) {
  const double metres_a_unit = system.GetLinearUnits();
  scale_ = metres_a_unit;
  LocalPlane plane;
  if (system.IsProjected() != FALSE) {
    OGRSpatialReference in_metres = system;
    if (metres_a_unit != 1.0) in_metres.SetLinearUnitsAndUpdateParameters("metre", 1.0);
    plane.reference_system = wkt_of(in_metres);
  }
  if (distortion) add_distortion(*distortion);
  out_.set_plane(plane);
  return number_text(metres_a_unit) + " m a unit: by its reference system " + name_of(system);
}

/// To the plane that the file names, else to one of its own, round the middle of its box, the same for all layers.
std::string LayerPlane::project_round(const LayerNumbers& layer, const DegreeBox& box, OGRSpatialReference from,
                                      const std::string& reason) {
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  plane_ = given_.plane;
  const bool is_named = !given_.plane.reference_system.empty();
  OGRSpatialReference local = is_named ? named_plane() : OGRSpatialReference();
  if (is_named) {
    plane_.reference_system = wkt_of(local);
    if (given_.is_placed) check_named_plane(local, box);
  } else {
    choose_local(local, degrees_of(from), box);
    if (given_.is_placed) out_.set_origin(*origin_, numbers_are_degrees_ ? "degrees" : name_of(from));
  }
  complaints_.take_failure();
  to_metres_.reset(OGRCreateCoordinateTransformation(&from, &local));
  if (to_metres_ == nullptr) {
    const std::string words = complaints_.take_failure();
    throw DataError(DataCode::library, path_.string(), layer.name,
                    words.empty() ? "a file that no vector driver reads" : words, "a vector file that GDAL reads");
  }
  if (semi_minor_ > 0.0) check_reach(layer, box);
  out_.set_plane(given_.is_placed ? plane_ : LocalPlane{});
  const std::string where =
      is_named ? "of the reference system that it names"
               : "round longitude " + number_text(origin_->longitude) + ", latitude " + number_text(origin_->latitude);
  return reason + "; brought to metres " + where;
}

/// Metres that are nowhere on earth have no distortion: they are what they were.
void LayerPlane::choose_local(OGRSpatialReference& local, const OGRSpatialReference& from, const DegreeBox& box) {
  if (!origin_) {
    const geometry::Vec2 middle = box.middle();
    origin_ = plane_.origin.value_or(
        ProjectionOrigin{rounded_degrees(middle.x, kCentreDecimals), rounded_degrees(middle.y, kCentreDecimals)});
  }
  local = plane_round(from, *origin_);
  local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  plane_.origin = origin_;
  if (given_.is_placed) semi_minor_ = from.GetSemiMinor();
  if (from.IsSameGeogCS(OGRSpatialReference::GetWGS84SRS()) == FALSE)
    plane_ = {std::nullopt, wkt_of(local), plane_.offset};
}

OGRSpatialReference LayerPlane::named_plane() const {
  OGRSpatialReference named;
  const std::string& words = given_.plane.reference_system;
  const char* const without_files[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  const bool known = named.SetFromUserInput(words.c_str(), without_files) == OGRERR_NONE &&
                     named.IsProjected() != FALSE && named.GetLinearUnits() == 1.0;
  complaints_.take_failure();
  if (!known) {
    throw DataError(DataCode::projection, path_.string(), "/local_metres/reference_system",
                    excerpt(words, 0, kShownText), "a projected reference system in metres, as WKT");
  }
  named.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return named;
}

void LayerPlane::check_named_plane(const OGRSpatialReference& plane, const DegreeBox& box) {
  const OGRSpatialReference degrees = degrees_of(plane);
  const std::unique_ptr<OGRCoordinateTransformation> forward(OGRCreateCoordinateTransformation(&degrees, &plane));
  if (forward == nullptr) return;  // said by the way from the file's degrees
  const Distortion distortion = measured_distortion(*forward, degrees, 1.0, places_in(box.on_circle()));
  complaints_.take_failure();
  if (distortion.length > kMostDistortion) {
    throw DataError(DataCode::projection, path_.string(), "/local_metres/reference_system",
                    "a reference system in which lengths are not those on the ground: " + name_of(plane),
                    "one that keeps lengths within " + percent_text(kMostDistortion) + " over the file");
  }
  add_distortion(distortion);
}

/// A box may reach farther than what is in it: then all of that is looked at.
void LayerPlane::check_reach(const LayerNumbers& layer, const DegreeBox& box) {
  const double limit = farthest_from_centre(semi_minor_);
  double farthest = limit + 1.0;
  if (numbers_are_degrees_) {
    const geometry::Box b = box.on_circle();
    farthest = farthest_of({b.low, b.high, {b.low.x, b.high.y}, {b.high.x, b.low.y}});
  }
  if (farthest <= limit) return;
  farthest = 0.0;
  layer.for_each_ring([&](const geometry::Ring& ring) { farthest = std::max(farthest, farthest_of(ring)); });
  if (farthest > limit) refuse_far(layer.name, farthest);
}

/// Looks at the points that have a place; the others are refused when they are read.
double LayerPlane::farthest_of(const geometry::Ring& ring) {
  std::vector<double> x, y;
  for (const geometry::Vec2 p : ring) {
    if (!geometry::is_finite(p)) continue;
    x.push_back(p.x);
    y.push_back(p.y);
  }
  std::vector<int> success(x.size());
  to_metres_->Transform(static_cast<int>(x.size()), x.data(), y.data(), nullptr, success.data());
  complaints_.take_failure();
  double farthest = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k)
    if (success[k] != 0) farthest = std::max(farthest, std::hypot(x[k], y[k]));
  return farthest;
}

void LayerPlane::refuse_far(const std::string& place, double metres) const {
  throw DataError(DataCode::projection, path_.string(), place,
                  "obstacles up to " + kilometres(metres) + " km from their middle (longitude " +
                      number_text(origin_->longitude) + ", latitude " + number_text(origin_->latitude) +
                      "): on one plane lengths are more than " + percent_text(kMostDistortion) + " too large there",
                  "obstacles within " + kilometres(farthest_from_centre(semi_minor_) - 1000.0) +
                      " km: split the file, and at the antimeridian each shape; units metres takes the numbers as they "
                      "stand");
}

void LayerPlane::add_distortion(const Distortion& distortion) {
  if (!distortion_) {
    distortion_ = distortion;
    return;
  }
  distortion_->length = std::max(distortion_->length, distortion.length);
  distortion_->area = std::max(distortion_->area, distortion.area);
  distortion_->certified = distortion_->certified && distortion.certified;
}

void LayerPlane::note_extent() {
  if (!out_.extent()) return;
  const auto [low, high] = *out_.extent();
  const auto in_millimetres = [](double x) { return number_text(std::nearbyint(1e3 * x) / 1e3); };
  out_.note("", "extent " + in_millimetres(low.x) + " to " + in_millimetres(high.x) + " m, " + in_millimetres(low.y) +
                    " to " + in_millimetres(high.y) + " m");
  if (!distortion_) return;
  out_.set_distortion(*distortion_);
  out_.note("", words_of(*distortion_));
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
  double farthest = 0.0;
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
      const double from_centre = std::hypot(x[k], y[k]);
      if (semi_minor_ > 0.0 && from_centre > farthest_from_centre(semi_minor_)) refuse_far(place, from_centre);
      farthest = std::max(farthest, from_centre);
      p = given_.rounded(geometry::Vec2{x[k], y[k]} + given_.plane.offset);
    }
  }
  if (semi_minor_ > 0.0) add_distortion(distortion_round_centre(farthest, semi_minor_));
}

void LayerPlane::refuse_unplaced(geometry::Vec2 written, const std::string& place) {
  complaints_.take_failure();
  throw DataError(
      DataCode::projection, path_.string(), place,
      "a point that has no place on the local plane: " + number_text(written.x) + ", " + number_text(written.y),
      "coordinates near each other");
}

std::optional<AsWritten> LayerPlane::as_written(const std::vector<geometry::Ring>& rings) {
  if (to_metres_ != nullptr)
    return AsWritten{rings, [this](geometry::Vec2 p) { return back_to_numbers(p); }, numbers_are_degrees_};
  if (scale_ == 1.0) return std::nullopt;
  return AsWritten{rings, [scale = scale_](geometry::Vec2 p) { return p / scale; }, false};
}

/// For people: a crossing that rounding moved.
geometry::Vec2 LayerPlane::back_to_numbers(geometry::Vec2 p) {
  p = p - given_.plane.offset;
  if (from_metres_ == nullptr) from_metres_.reset(to_metres_->GetInverse());
  if (from_metres_ == nullptr || !from_metres_->Transform(1, &p.x, &p.y)) {
    complaints_.take_failure();
    constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
    return {kNowhere, kNowhere};
  }
  const double decimals = numbers_are_degrees_ ? kCrossingDecimals : kCrossingDecimalsOfUnits;
  return {rounded_degrees(p.x, decimals), rounded_degrees(p.y, decimals)};
}

// --- Reference systems, and metres to degrees ---

OGRSpatialReference plane_round(const OGRSpatialReference& geographic, const ProjectionOrigin& origin) {
  OGRSpatialReference local;
  local.CopyGeogCSFrom(&geographic);
  local.SetAE(origin.latitude, origin.longitude, 0.0, 0.0);
  return local;
}

OGRSpatialReference system_of_srid(int srid, const std::string& file, GdalComplaints& complaints) {
  OGRSpatialReference system;
  const bool is_known = system.importFromEPSG(srid) == OGRERR_NONE;
  complaints.take_failure();
  if (!is_known) {
    throw DataError(DataCode::projection, file, "", "SRID=" + std::to_string(srid),
                    "the EPSG code of a reference system that PROJ knows, or SRID=0 for metres");
  }
  system.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return system;
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
