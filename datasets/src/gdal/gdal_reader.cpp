// SPDX-License-Identifier: GPL-3.0-or-later
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/box.h"
#include "files/text_file.h"
#include "gdal/gdal_session.h"
#include "gdal/geojson_sequence.h"
#include "gdal/geojson_shape.h"
#include "gdal/plane_system.h"
#include "gdal/properties.h"
#include "json/json_text.h"
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

/// The lines and polygons inside a geometry of any kind, in order, and a word about what else is there.
struct Visitor {
  std::function<void(RawKind, std::vector<geometry::Ring>)> shape;
  std::function<void(const std::string&)> other;
};

void visit(const OGRGeometry& geometry, const Visitor& visitor, int depth = 0) {
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

/// Degrees that a coordinate may lie beyond 180 or 90 and still be one: writers round, and some files hold
/// 180.00000000000014. A millionth of a degree is 0.1 m on the ground.
constexpr double kDegreesBeyond = 1e-6;

bool is_longitude_latitude(const geometry::Box& box) {
  constexpr double kEast = 180.0 + kDegreesBeyond, kNorth = 90.0 + kDegreesBeyond;
  return box.low.x >= -kEast && box.high.x <= kEast && box.low.y >= -kNorth && box.high.y <= kNorth;
}

/// A millionth of a degree (0.1 m): a centre that people can copy. A billionth (0.1 mm): a place to zoom to.
constexpr double kCentreDecimals = 1e6;
constexpr double kCrossingDecimals = 1e9;

double rounded_degrees(double degrees, double decimals) {
  return std::round(degrees * decimals) / decimals;
}

/// Characters of a text that is no geometry.
constexpr std::size_t kShownText = 40;

std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// A sequence whose first line is malformed is one that GDAL does not know.
bool is_sequence_name(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  const char* const known[] = {".geojsonl", ".geojsons", ".geojsonseq", ".ndjson"};
  return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

class VectorReader {
 public:
  VectorReader(const std::filesystem::path& path, Collector& out) : path_(path), out_(out), geojson_parsing_(path) {
    if (is_sequence_file()) return;  // GDAL is not asked: it would read all of it now
    data_ = open_vectors(path);
    if (data_ == nullptr && is_sequence_name(path)) {
      complaints_.take_failure();  // of a bad first line, which is reported with its number
      return;
    }
    set_malformed_aside();
    refuse_complaints("", data_ == nullptr);
  }

  void read() {
    for (int k = 0; k < layers(); ++k) {
      layer_ = is_sequence() ? nullptr : data_->GetLayer(k);
      settle_coordinates();
      for_each_feature([this](const Item& item) { add(item); });
    }
    if (driver() == "GeoJSON") for_each_stray_entry(path_, [this](const DataError& stray) { out_.reject(stray); });
    if (!malformed_.empty() && !has_told_malformed_) refuse_malformed();
    note_extent();
    for (const std::string& words : complaints_.take_warnings()) out_.note("", words);
  }

 private:
  /// A failure is what GDAL called one; `failed` says that it gave nothing.
  void refuse_complaints(const std::string& place, bool failed = false) {
    const std::string words = complaints_.take_failure();
    if (words.empty() && !failed) return;
    if (GeoJsonParsing::is_size_limit_in(words))
      throw DataError(DataCode::size, path_.string(), place, "a feature or member of more JSON than is read at a time",
                      "fewer points in a feature, or another format, such as WKT");
    if (place.empty()) refuse_malformed_json();
    if (words.empty()) refuse_late_type();
    throw DataError(DataCode::library, path_.string(), place,
                    words.empty() ? "a file that no vector driver reads" : words, "a vector file that GDAL reads");
  }

  /// Of GeoJSON and TopoJSON: what is wrong in this program's words, with line and column.
  void refuse_malformed_json() const {
    const std::string extension = lower_case_extension(path_);
    if (extension != ".json" && extension != ".geojson" && extension != ".topojson") return;
    check_json_syntax(read_text_file(path_), path_.string());
  }

  /// GeoJSON that GDAL does not take for such: it looks for the type in the first 6000 bytes.
  void refuse_late_type() const {
    const std::string type = beginning_of_geojson(path_).type;
    if (type != "FeatureCollection" && !is_type_of_record(type)) return;
    throw DataError(DataCode::format_syntax, path_.string(), "/type", "\"" + type + "\" behind long members",
                    "GeoJSON with its member \"type\" first");
  }

  /// What a layer or a sequence holds, one after the other.
  struct Item {
    std::size_t number = 0;
    std::string place;
    const OGRGeometry* shape = nullptr;
    const OGRFeature* feature = nullptr;  ///< none of a sequence
    const DataError* fault = nullptr;     ///< of a sequence
    std::string_view text{};              ///< of a sequence: the record
  };

  bool is_sequence_file() const {
    const std::string driver = vector_driver_of(path_);
    if (driver.empty()) return is_sequence_name(path_);
    return driver == "GeoJSONSeq" || (driver == "GeoJSON" && begins_as_sequence(path_, is_sequence_name(path_)));
  }

  /// GDAL's driver would leave malformed lines out; they are read here.
  bool is_sequence() const { return data_ == nullptr; }
  int layers() const { return is_sequence() ? 1 : data_->GetLayerCount(); }
  std::string layer_name() const { return is_sequence() ? "" : layer_->GetName(); }

  template <class Action>
  void for_each_record(Action action) {
    GeoJsonSequence sequence(path_);
    std::size_t number = 0;
    while (const std::optional<GeoJsonRecord> record = sequence.next()) {
      complaints_.take_failure();  // of its parser: the record's fault says it
      action(Item{number++, record->place, record->shape.get(), nullptr, record->fault ? &*record->fault : nullptr,
                  record->text});
    }
  }

  /// GeoJSON's malformed geometries are looked at one by one (`lost_geometry`), and GDAL goes on after them.
  void set_malformed_aside() {
    if (data_ == nullptr || driver() != "GeoJSON") return;
    const std::string words = complaints_.take_malformed();
    if (malformed_.empty()) malformed_ = words;
  }

  [[noreturn]] void refuse_malformed() const {
    throw DataError(DataCode::library, path_.string(), "", malformed_, "a vector file that GDAL reads");
  }

  template <class Action>
  void for_each_feature(Action for_one) {
    const auto action = [&](const Item& item) {
      call_wait_hook();
      for_one(item);
    };
    if (is_sequence()) return for_each_record(action);
    layer_->ResetReading();
    std::size_t number = 0;
    while (const std::unique_ptr<OGRFeature> feature{layer_->GetNextFeature()}) {
      set_malformed_aside();
      refuse_complaints("feature " + std::to_string(number));
      action(Item{number, place_of(number), feature->GetGeometryRef(), feature.get(), nullptr});
      ++number;
    }
    set_malformed_aside();
    refuse_complaints("after feature " + std::to_string(number));
  }

  geometry::Box bounding_box() {
    geometry::Box box;
    Visitor visitor;
    visitor.other = [](const std::string&) {};
    visitor.shape = [&](RawKind, const std::vector<geometry::Ring>& rings) {
      for (const geometry::Ring& ring : rings) {
        for (const geometry::Vec2 p : ring) {
          if (geometry::is_finite(p)) box.add(p);
        }
      }
    };
    for_each_feature([&](const Item& item) {
      if (item.shape != nullptr) visit(*item.shape, visitor);
    });
    return box;
  }

  /// What the numbers of this layer mean: sets `scale_` or `to_metres_`.
  void settle_coordinates() {
    to_metres_.reset();
    from_metres_.reset();
    scale_ = 1.0;
    given_ = GivenPlane{};
    const OGRSpatialReference* system = is_sequence() ? OGRSpatialReference::GetWGS84SRS() : layer_->GetSpatialRef();
    const Units units = units_of_layer();
    if (units == Units::metres) return settle_metres("metres: " + reason_);
    if (units == Units::automatic && system == nullptr)
      return settle_metres("taken as metres: names no reference system");
    if (units == Units::automatic && !system->IsGeographic()) return settle_projected(*system);
    const geometry::Box box = bounding_box();
    if (box.is_empty()) return;
    if (!is_longitude_latitude(box)) return settle_impossible_degrees(units);
    project_round(box, system != nullptr && system->IsGeographic() ? *system : *OGRSpatialReference::GetWGS84SRS());
    const std::string where = given_.plane.reference_system.empty() ? "round longitude " + number(origin_->longitude) +
                                                                          ", latitude " + number(origin_->latitude)
                                                                    : "of the reference system that it names";
    note_units("degrees: " + reason_ + "; brought to metres " + where);
  }

  void settle_metres(const std::string& words) {
    out_.set_plane({});
    note_units(words);
  }

  void settle_projected(const OGRSpatialReference& system) {
    scale_ = system.GetLinearUnits();
    LocalPlane plane;
    if (system.IsProjected()) {
      OGRSpatialReference in_metres = system;
      if (scale_ != 1.0) in_metres.SetLinearUnitsAndUpdateParameters("metre", 1.0);
      plane.reference_system = wkt_of(in_metres);
    }
    out_.set_plane(plane);
    const char* name = system.GetName();
    note_units(number(scale_) + " m a unit: by its reference system " + (name != nullptr ? name : "without a name"));
  }

  static std::string number(double value) {
    std::string text;
    append_number(text, value);
    return text;
  }

  void note_units(const std::string& words) { out_.note(layers() > 1 ? "layer " + layer_name() : "", words); }

  void note_extent() {
    if (!out_.extent()) return;
    const auto [low, high] = *out_.extent();
    out_.note("", "extent " + number(low.x) + " to " + number(high.x) + " m, " + number(low.y) + " to " +
                      number(high.y) + " m");
  }

  /// Sets `reason_` as well.
  Units units_of_layer() {
    reason_ = "as the reader was told";
    if (out_.options().units != Units::automatic) return out_.options().units;
    reason_ = "by its reference system";
    return is_geojson() ? units_of_geojson() : Units::automatic;
  }

  Units units_of_geojson() {
    reason_ = "GeoJSON that says nothing of units (RFC 7946)";
    const char* native = is_sequence() ? nullptr : layer_->GetMetadataItem("NATIVE_DATA", "NATIVE_DATA");
    if (native == nullptr) return Units::automatic;
    const Json members = parse_json(native, path_.string());
    given_ = given_plane(members, path_.string());
    const auto units = members.find("units");
    if (units == members.end()) return Units::automatic;
    reason_ = "by its member \"units\"";
    if (*units == "m") return Units::metres;
    if (*units == "degrees") return Units::degrees;
    throw DataError(DataCode::not_an_option, path_.string(), "/units", described(*units), "\"m\" or \"degrees\"");
  }

  std::string driver() const { return is_sequence() ? "GeoJSONSeq" : data_->GetDriverName(); }
  bool is_geojson() const { return driver().find("GeoJSON") == 0; }

  void settle_impossible_degrees(Units units) {
    if (units == Units::degrees || !is_geojson()) {
      throw DataError(DataCode::projection, path_.string(), layer_name(),
                      "coordinates beyond 180 degrees east or 90 north", "longitudes and latitudes");
    }
    settle_metres("taken as metres: says nothing of units and has coordinates that are no longitude or latitude");
  }

  /// To the plane that the file names, else to one of its own, round the middle of its box.
  void project_round(const geometry::Box& box, OGRSpatialReference from) {
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
                        excerpt(plane.reference_system, 0, kShownText),
                        "a projected reference system in metres, as WKT");
      }
      local.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
      plane.reference_system = wkt_of(local);
    } else {
      if (!origin_) {
        origin_ =
            plane.origin.value_or(ProjectionOrigin{rounded_degrees((box.low.x + box.high.x) / 2, kCentreDecimals),
                                                   rounded_degrees((box.low.y + box.high.y) / 2, kCentreDecimals)});
        if (given_.is_placed) out_.set_origin(*origin_);
      }
      local = plane_round(from, *origin_);
      plane.origin = origin_;
      if (from.IsSameGeogCS(OGRSpatialReference::GetWGS84SRS()) == FALSE)
        plane = {std::nullopt, wkt_of(local), plane.offset};
    }
    to_metres_.reset(OGRCreateCoordinateTransformation(&from, &local));
    refuse_complaints(layer_name(), to_metres_ == nullptr);
    out_.set_plane(given_.is_placed ? plane : LocalPlane{});
  }

  void bring_to_metres(geometry::Ring& ring, const std::string& place) {
    if (to_metres_ != nullptr) return project(ring, place);
    for (geometry::Vec2& p : ring)
      if (geometry::is_finite(p)) p = scale_ * p;
  }

  /// Many points a call: PROJ takes longer to be asked than to answer.
  void project(geometry::Ring& ring, const std::string& place) {
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

  [[noreturn]] void refuse_unplaced(geometry::Vec2 written, const std::string& place) {
    complaints_.take_failure();
    throw DataError(DataCode::projection, path_.string(), place,
                    "a point that has no place on the local plane: " + number(written.x) + ", " + number(written.y),
                    "coordinates near each other");
  }

  void add(const Item& item) {
    const std::string& place = item.place;
    if (item.fault != nullptr) return out_.reject(*item.fault);
    if (item.feature != nullptr) {
      if (const std::optional<DataError> lost = lost_geometry(*item.feature, place)) {
        has_told_malformed_ = true;
        return out_.reject(*lost);
      }
    }
    if (item.shape == nullptr) return out_.pass_over(place, "a feature without geometry skipped");
    const FeatureProperties properties = properties_of(item);
    std::size_t part = 0;
    Visitor visitor;
    visitor.other = [&](const std::string& words) { out_.pass_over(place, words); };
    visitor.shape = [&](RawKind kind, std::vector<geometry::Ring> rings) {
      hand_on(item.number, part++, place, kind, std::move(rings), properties);
    };
    visit(*item.shape, visitor);
  }

  FeatureProperties properties_of(const Item& item) const {
    if (!out_.options().keep_properties) return {};
    if (item.feature == nullptr) return properties_of_geojson(item.text);
    const char* native = driver() == "GeoJSON" ? item.feature->GetNativeData() : nullptr;
    return native != nullptr ? properties_of_geojson(native)
                             : datasets::properties_of(*item.feature, driver() == "GPKG");
  }

  /// GDAL says nothing of a geometry that it cannot make out, or of the parts of one.
  std::optional<DataError> lost_geometry(const OGRFeature& feature, const std::string& place) const {
    if (driver() == "GeoJSON") return lost_from_geojson(feature, place);
    return driver() == "CSV" ? lost_from_csv(feature, place) : std::nullopt;
  }

  /// A geometry that stands alone is the whole file.
  std::optional<DataError> lost_from_geojson(const OGRFeature& feature, const std::string& place) const {
    const char* native = feature.GetNativeData();
    const OGRGeometry* shape = feature.GetGeometryRef();
    const bool read = shape != nullptr && !shape->IsEmpty();
    const std::optional<GeoJsonFault> fault = geojson_fault(native != nullptr ? native : read_text_file(path_), read);
    if (!fault) return std::nullopt;
    return DataError(DataCode::format_syntax, path_.string(), place + place_within(*fault), fault->found,
                     fault->expected);
  }

  std::optional<DataError> lost_from_csv(const OGRFeature& feature, const std::string& place) const {
    if (feature.GetGeometryRef() != nullptr) return std::nullopt;
    const std::string text = text_of_geometry(feature);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) return std::nullopt;
    return DataError(DataCode::format_syntax, path_.string(), place, excerpt(text, begin, kShownText),
                     "a geometry as WKT, or nothing");
  }

  /// What stands in the column that the driver takes geometries from. It calls the geometries of a column X "X" or
  /// "geom_X", and "" those of a column WKT.
  static std::string text_of_geometry(const OGRFeature& feature) {
    if (feature.GetGeomFieldCount() == 0) return "";
    const std::string name = feature.GetGeomFieldDefnRef(0)->GetNameRef();
    int column = feature.GetFieldIndex(name.empty() ? "WKT" : name.c_str());
    if (column < 0 && name.rfind("geom_", 0) == 0) column = feature.GetFieldIndex(name.c_str() + 5);
    return column < 0 ? "" : feature.GetFieldAsString(column);
  }

  AsWritten as_written(const std::vector<geometry::Ring>& rings) {
    if (to_metres_ == nullptr) return {rings, [scale = scale_](geometry::Vec2 p) { return p / scale; }, false};
    return {rings, [this](geometry::Vec2 p) { return back_to_degrees(p); }, true};
  }

  /// For people: a crossing that rounding moved.
  geometry::Vec2 back_to_degrees(geometry::Vec2 p) {
    p = p - given_.plane.offset;
    if (from_metres_ == nullptr) from_metres_.reset(to_metres_->GetInverse());
    if (from_metres_ == nullptr || !from_metres_->Transform(1, &p.x, &p.y)) {
      complaints_.take_failure();
      constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
      return {kNowhere, kNowhere};
    }
    return {rounded_degrees(p.x, kCrossingDecimals), rounded_degrees(p.y, kCrossingDecimals)};
  }

  std::string place_of(std::size_t number) const {
    const std::string feature = "feature " + std::to_string(number);
    return layers() > 1 ? "layer " + layer_name() + ", " + feature : feature;
  }

  void hand_on(std::size_t number, std::size_t part, const std::string& place, RawKind kind,
               std::vector<geometry::Ring> rings, const FeatureProperties& properties) {
    RawGeometry raw;
    raw.properties = properties;
    raw.kind = kind;
    raw.id = std::to_string(number) + (part > 0 ? "." + std::to_string(part) : "");
    if (layers() > 1) raw.id = layer_name() + "/" + raw.id;
    raw.place = place + (part > 0 ? ", part " + std::to_string(part) : "");
    raw.rings = std::move(rings);
    if (to_metres_ != nullptr || scale_ != 1.0) raw.as_written = as_written(raw.rings);
    try {
      for (geometry::Ring& ring : raw.rings) bring_to_metres(ring, raw.place);
    } catch (const DataError& error) {
      return out_.reject(error);
    }
    out_.add(raw);
  }

  std::filesystem::path path_;
  Collector& out_;
  GeoJsonParsing geojson_parsing_;
  GdalComplaints complaints_;
  std::string malformed_;            ///< GDAL's words of a geometry of GeoJSON
  bool has_told_malformed_ = false;  ///< in words of our own, with the feature
  std::unique_ptr<GDALDataset> data_;
  OGRLayer* layer_ = nullptr;
  std::optional<ProjectionOrigin> origin_;  ///< one for all layers
  GivenPlane given_;                        ///< by GeoJSON's member "local_metres"
  double scale_ = 1.0;                      ///< m a unit
  std::string reason_;                      ///< why the layer's units are what they are
  std::unique_ptr<OGRCoordinateTransformation> to_metres_;
  std::unique_ptr<OGRCoordinateTransformation> from_metres_;  ///< made when a place is to be named
};

/// As our own XML readers do. Entities are declared before the first element; what is hidden behind a longer comment is
/// left to expat, which bounds what entities grow to.
void refuse_entities(const std::filesystem::path& path) {
  constexpr std::size_t kDeclarations = 1 << 16;
  const std::string beginning = read_beginning(path, kDeclarations);
  const std::size_t at = beginning.find("<!ENTITY");
  if (beginning.empty() || beginning[0] != '<' || at == std::string::npos) return;
  throw DataError(DataCode::format_syntax, path.string(), line_and_column(beginning, at), excerpt(beginning, at),
                  "XML without entities of its own: they are not expanded");
}

/// GDAL opens them beside the file, and would wait for a pipe for ever.
void refuse_irregular_companions(const std::filesystem::path& path) {
  for (const char* extension :
       {".shp", ".shx", ".dbf", ".prj",  ".cpg", ".qpj", ".qix", ".sbn", ".sbx", ".idm", ".ind", ".tab", ".dat", ".map",
        ".id",  ".mid", ".mif", ".csvt", ".xsd", ".gfs", ".SHX", ".DBF", ".PRJ", ".CPG", ".DAT", ".MAP", ".ID"}) {
    const std::filesystem::path companion = std::filesystem::path(path).replace_extension(extension);
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(companion, error);
    if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) continue;
    if (std::filesystem::is_directory(status)) continue;
    throw DataError(DataCode::file_unreadable, companion.string(), "", "a pipe, a socket or a device",
                    "a regular file");
  }
}

}  // namespace

void read_vector_file(const std::filesystem::path& path, Collector& out) {
  refuse_irregular_companions(path);
  refuse_entities(path);
  VectorReader(path, out).read();
}

}  // namespace exactvo::datasets
