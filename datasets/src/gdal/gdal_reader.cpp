// SPDX-License-Identifier: GPL-3.0-or-later
#include <cpl_conv.h>
#include <ogr_feature.h>
#include <ogr_geometry.h>
#include <ogrsf_frmts.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/box.h"
#include "exactvo/geometry/shapes.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/gdal_session.h"
#include "gdal/geojson_file.h"
#include "gdal/layer_plane.h"
#include "gdal/properties.h"
#include "json/json_text.h"
#include "readers/readers.h"

namespace exactvo::datasets {
namespace {

// Polygons of a Shapefile from its rings. The format winds outer rings clockwise and holes counter-clockwise (ESRI
// Shapefile Technical Description, "Polygon"), in any order; GDAL fills the holes of a record whose rings are all
// wound alike, so it is asked for the rings as they stand.

/// While it lives, GDAL gives every ring of a Shapefile of polygons as a polygon of its own, in this thread.
struct RingsAsTheyStand : ConfigOption {
  RingsAsTheyStand() : ConfigOption("OGR_ORGANIZE_POLYGONS", "SKIP") {}
};

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

/// The outer ring first, then its holes; in the order of the outer rings. A counter-clockwise ring is a hole of the
/// smallest clockwise one round it. One that is in none is wound wrongly: it is an outer ring unless an odd number of
/// others like it are round it.
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

/// The feature's polygons, from the rings that GDAL gave.
void group_rings(OGRFeature& feature) {
  const OGRGeometry* geometry = feature.GetGeometryRef();
  if (geometry == nullptr || wkbFlatten(geometry->getGeometryType()) != wkbMultiPolygon) return;
  const OGRMultiPolygon& parts = *geometry->toMultiPolygon();
  const auto has_holes = [](const OGRPolygon* part) { return part->getNumInteriorRings() > 0; };
  if (std::any_of(parts.begin(), parts.end(), has_holes)) return;
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

/// Characters of a text that is no geometry.
constexpr std::size_t kShownText = 40;

/// What GDAL does not know may still be GeoJSON, or should be: its drivers look at the beginning alone.
bool is_json_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".json" || extension == ".geojson" || is_sequence_name(path);
}

class VectorReader {
 public:
  VectorReader(const std::filesystem::path& path, Collector& out)
      : path_(path), out_(out), plane_(path_, out, complaints_) {
    const std::string driver = vector_driver_of(path);
    if (driver.empty() ? is_json_name(path) : driver.rfind("GeoJSON", 0) == 0) {
      geojson_.emplace(path);
      return;
    }
    data_ = open_vectors(path, driver);
    refuse_complaints("", data_ == nullptr);
  }

  void read() {
    refuse_bare_tables();
    for (int k = 0; k < layers(); ++k) {
      layer_ = geojson_ ? nullptr : data_->GetLayer(k);
      settle_coordinates();
      for_each_feature([this](const Item& item) { add(item); });
    }
    plane_.note_extent();
    for (const std::string& words : complaints_.take_warnings())
      if (words.find("cannot be translated to Simple Geometry") == std::string::npos)  // its rings, as was asked
        out_.note("", words);
  }

 private:
  /// A failure is what GDAL called one; `failed` says that it gave nothing.
  void refuse_complaints(const std::string& place, bool failed = false) {
    const std::string words = complaints_.take_failure();
    if (words.empty() && !failed) return;
    if (place.empty() && lower_extension(path_) == ".topojson")
      check_json_syntax(read_text_file(path_), path_.string());
    throw DataError(DataCode::library, path_.string(), place,
                    words.empty() ? "a file that no vector driver reads" : words, "a vector file that GDAL reads");
  }

  /// Rows without any geometry would be a map without obstacles, on which every way is clear.
  void refuse_bare_tables() {
    if (geojson_ || layers() == 0) return;
    for (int k = 0; k < layers(); ++k)
      if (data_->GetLayer(k)->GetLayerDefn()->GetGeomFieldCount() > 0) return;
    throw DataError(DataCode::format_syntax, path_.string(), "", "a table without a column of geometry",
                    "a column of geometry as WKT; of points two columns, x and y in metres, and the format points-csv");
  }

  /// A feature of a layer, or a record of GeoJSON.
  struct Item {
    std::size_t number = 0;
    std::string place;
    const OGRFeature* feature = nullptr;
    const GeoJsonRecord* record = nullptr;

    bool has_geometry() const {
      return feature != nullptr ? feature->GetGeometryRef() != nullptr : geometry_of(record->json) != nullptr;
    }
    void visit(const Visitor& visitor) const {
      if (feature != nullptr)
        datasets::visit(*feature->GetGeometryRef(), visitor);
      else
        datasets::visit(*geometry_of(record->json), visitor);
    }
  };

  int layers() const { return geojson_ ? 1 : data_->GetLayerCount(); }
  std::string layer_name() const { return geojson_ ? path_.stem().string() : layer_->GetName(); }

  template <class Action>
  void for_each_feature(Action action) {
    if (geojson_)
      return geojson_->for_each([&](const GeoJsonRecord& record) {
        call_wait_hook();
        action(Item{record.number, record.place, nullptr, &record});
      });
    const std::optional<RingsAsTheyStand> as_they_stand =
        is_shapefile_of_polygons() ? std::make_optional<RingsAsTheyStand>() : std::nullopt;
    layer_->ResetReading();
    std::size_t number = 0;
    while (const std::unique_ptr<OGRFeature> feature{layer_->GetNextFeature()}) {
      call_wait_hook();
      refuse_complaints("feature " + std::to_string(number));
      if (is_csv()) take_ewkt(*feature);
      if (as_they_stand) group_rings(*feature);
      action(Item{number, place_of(number), feature.get(), nullptr});
      ++number;
    }
    refuse_complaints("after feature " + std::to_string(number));
  }

  void for_each_ring(const std::function<void(const geometry::Ring&)>& take) {
    Visitor visitor;
    visitor.other = [](const std::string&) {};
    visitor.shape = [&](RawKind, const std::vector<geometry::Ring>& rings) {
      for (const geometry::Ring& ring : rings) take(ring);
    };
    for_each_feature([&](const Item& item) {
      if (!is_refused(item) && item.has_geometry()) item.visit(visitor);
    });
  }

  /// What the numbers of this layer mean: sets `plane_`.
  void settle_coordinates() {
    plane_.reset();
    LayerNumbers layer;
    layer.name = layer_name();
    layer.system = system_of_layer();
    layer.units = units_of_layer();
    layer.reason = reason_;
    layer.is_perhaps_metres = geojson_.has_value();
    layer.for_each_ring = [this](const auto& take) { for_each_ring(take); };
    if (geojson_) layer.box = geojson_->box();
    const std::string words = plane_.settle(layer);
    if (!words.empty()) out_.note(layers() > 1 ? "layer " + layer_name() : "", words);
  }

  const OGRSpatialReference* system_of_layer() {
    if (geojson_) return system_of_geojson();
    const OGRSpatialReference* system = layer_->GetSpatialRef();
    csv_srid_.reset();
    if (!is_csv() || system != nullptr || out_.options().units != Units::automatic) return system;
    for_each_feature([this](const Item& item) {
      if (!csv_srid_ && item.has_geometry()) csv_srid_ = srid_of(text_of_geometry(*item.feature));
    });
    if (csv_srid_.value_or(0) == 0) return nullptr;
    named_system_ = system_of_srid(*csv_srid_, path_.string(), complaints_);
    return &named_system_;
  }

  /// The driver knows no SRID before WKT.
  static void take_ewkt(OGRFeature& feature) {
    if (feature.GetGeometryRef() != nullptr || feature.GetGeomFieldCount() == 0) return;
    const std::string text = text_of_geometry(feature);
    const std::size_t end = text.find(';');
    if (!begins_with_srid(text) || end == std::string::npos) return;
    OGRGeometry* geometry = nullptr;
    if (OGRGeometryFactory::createFromWkt(text.c_str() + end + 1, nullptr, &geometry) == OGRERR_NONE)
      feature.SetGeometryDirectly(geometry);
  }

  /// Sets `reason_` as well.
  Units units_of_layer() {
    reason_ = "as the reader was told";
    if (out_.options().units != Units::automatic) return out_.options().units;
    reason_ = "by its reference system";
    return geojson_ ? units_of_geojson() : Units::automatic;
  }

  Units units_of_geojson() {
    reason_ = "GeoJSON that says nothing of units (RFC 7946)";
    const Json& members = geojson_->members();
    plane_.set_given(given_plane(members, path_.string()));
    const auto units = members.find("units");
    if (units == members.end()) return Units::automatic;
    reason_ = "by its member \"units\"";
    if (*units == "m") return Units::metres;
    if (*units == "degrees") return Units::degrees;
    throw DataError(DataCode::not_an_option, path_.string(), "/units", described(*units), "\"m\" or \"degrees\"");
  }

  /// By a member "crs", as GeoJSON had it before RFC 7946; null where that is null.
  const OGRSpatialReference* system_of_geojson() {
    const Json& members = geojson_->members();
    const auto crs = members.find("crs");
    if (crs == members.end()) return OGRSpatialReference::GetWGS84SRS();
    if (crs->is_null()) return nullptr;
    const Json::json_pointer name("/properties/name");
    const std::string words = crs->is_object() && crs->contains(name) && crs->at(name).is_string() ? crs->at(name) : "";
    const char* const without_files[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
    const bool is_known = named_system_.SetFromUserInput(words.c_str(), without_files) == OGRERR_NONE;
    complaints_.take_failure();
    if (is_known) return &named_system_;
    out_.note("/crs", described(*crs) + " names no reference system that PROJ knows: taken as longitude and latitude");
    return OGRSpatialReference::GetWGS84SRS();
  }

  static bool is_refused(const Item& item) { return item.record != nullptr && item.record->fault; }

  void add(const Item& item) {
    const std::string& place = item.place;
    if (is_refused(item)) return out_.reject(*item.record->fault);
    if (const auto lost = geojson_ || !is_csv() ? std::nullopt : lost_from_csv(*item.feature, place))
      return out_.reject(*lost);
    if (!geojson_ && is_csv() && item.has_geometry()) {
      try {
        // The SRID of each row of a CSV must be that of the first geometry.
        const int srid = srid_of(text_of_geometry(*item.feature));
        if (srid != csv_srid_.value_or(srid)) throw other_system(srid, *csv_srid_, path_.string(), place);
      } catch (const DataError& error) {
        return out_.reject(error);
      }
    }
    if (!item.has_geometry()) return out_.pass_over(place, "a feature without geometry skipped");
    const FeatureProperties properties = properties_of(item);
    std::size_t part = 0;
    Visitor visitor;
    visitor.other = [&](const std::string& words) { out_.pass_over(place, words); };
    visitor.shape = [&](RawKind kind, std::vector<geometry::Ring> rings) {
      hand_on(item.number, part++, place, kind, std::move(rings), properties);
    };
    item.visit(visitor);
  }

  FeatureProperties properties_of(const Item& item) const {
    if (!out_.options().keep_properties) return {};
    if (geojson_) return datasets::properties_of(item.record->json);
    return datasets::properties_of(*item.feature, data_->GetDriverName());
  }

  bool is_shapefile_of_polygons() const {
    return data_->GetDriverName() == std::string("ESRI Shapefile") && wkbFlatten(layer_->GetGeomType()) == wkbPolygon;
  }

  bool is_csv() const { return data_->GetDriverName() == std::string("CSV"); }

  /// GDAL says nothing of a geometry that it cannot make out.
  std::optional<DataError> lost_from_csv(const OGRFeature& feature, const std::string& place) const {
    if (feature.GetGeometryRef() != nullptr) return std::nullopt;
    const std::string text = text_of_geometry(feature);
    const std::size_t begin = text.find_first_not_of(" \t\r\n");
    if (begin == std::string::npos) return std::nullopt;
    return DataError(DataCode::format_syntax, path_.string(), place, excerpt(text, begin, kShownText),
                     "a geometry as WKT, or nothing");
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
    if (!geojson_ && is_shapefile_of_polygons()) raw.winding = Winding::clockwise;
    raw.id = std::to_string(number) + (part > 0 ? "." + std::to_string(part) : "");
    if (layers() > 1) raw.id = layer_name() + "/" + raw.id;
    raw.place = place + (part > 0 ? ", part " + std::to_string(part) : "");
    raw.rings = std::move(rings);
    raw.as_written = plane_.as_written(raw.rings);
    try {
      for (geometry::Ring& ring : raw.rings) plane_.bring_to_metres(ring, raw.place);
    } catch (const DataError& error) {
      return out_.reject(error);
    }
    out_.add(raw);
  }

  std::filesystem::path path_;
  Collector& out_;
  GdalComplaints complaints_;
  std::optional<GeoJsonFile> geojson_;  ///< else:
  std::unique_ptr<GDALDataset> data_;
  OGRLayer* layer_ = nullptr;
  LayerPlane plane_;
  OGRSpatialReference named_system_;  ///< by GeoJSON, or by the SRID of a CSV's geometries
  std::optional<int> csv_srid_;       ///< of the first geometry, 0 where it names none; unset where it does not count
  std::string reason_;                ///< why the layer's units are what they are
};

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
  // Entities are declared before the first element; what is hidden behind a longer comment is left to expat, which
  // bounds what entities grow to.
  const std::string beginning = read_beginning(path, std::size_t{1} << 16);
  if (!beginning.empty() && beginning[0] == '<') refuse_entities(beginning, path.string());
  VectorReader(path, out).read();
}

}  // namespace exactvo::datasets
