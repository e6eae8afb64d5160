// SPDX-License-Identifier: GPL-3.0-or-later
#include <ogrsf_frmts.h>

#include <memory>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/box.h"
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

/// Degrees that a coordinate may lie beyond 180 or 90 and still be one: writers round, and some files hold
/// 180.00000000000014. A millionth of a degree is 0.1 m on the ground.
constexpr double kDegreesBeyond = 1e-6;

bool is_longitude_latitude(const geometry::Box& box) {
  constexpr double kEast = 180.0 + kDegreesBeyond, kNorth = 90.0 + kDegreesBeyond;
  return box.low.x >= -kEast && box.high.x <= kEast && box.low.y >= -kNorth && box.high.y <= kNorth;
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
    for (int k = 0; k < layers(); ++k) {
      layer_ = geojson_ ? nullptr : data_->GetLayer(k);
      settle_coordinates();
      for_each_feature([this](const Item& item) { add(item); });
    }
    note_extent();
    for (const std::string& words : complaints_.take_warnings()) out_.note("", words);
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
    layer_->ResetReading();
    std::size_t number = 0;
    while (const std::unique_ptr<OGRFeature> feature{layer_->GetNextFeature()}) {
      call_wait_hook();
      refuse_complaints("feature " + std::to_string(number));
      action(Item{number, place_of(number), feature.get(), nullptr});
      ++number;
    }
    refuse_complaints("after feature " + std::to_string(number));
  }

  geometry::Box bounding_box() {
    if (geojson_ && geojson_->box()) return *geojson_->box();
    geometry::Box box;
    const Visitor visitor = taker_of_points(box);
    for_each_feature([&](const Item& item) {
      if (!is_refused(item) && item.has_geometry()) item.visit(visitor);
    });
    return box;
  }

  /// What the numbers of this layer mean: sets `plane_`.
  void settle_coordinates() {
    plane_.reset();
    const OGRSpatialReference* system = geojson_ ? system_of_geojson() : layer_->GetSpatialRef();
    const Units units = units_of_layer();
    if (units == Units::metres) return settle_metres("metres: " + reason_);
    if (units == Units::automatic && system == nullptr)
      return settle_metres("taken as metres: names no reference system");
    if (units == Units::automatic && !system->IsGeographic()) return settle_projected(*system);
    const geometry::Box box = bounding_box();
    if (box.is_empty()) return;
    if (!is_longitude_latitude(box)) return settle_impossible_degrees(units);
    const bool names_degrees = system != nullptr && system->IsGeographic();
    const bool is_projected = plane_.project_round(box, names_degrees ? *system : *OGRSpatialReference::GetWGS84SRS());
    refuse_complaints(layer_name(), !is_projected);
    out_.set_plane(plane_.plane());
    const std::string where = plane_.is_named() ? "of the reference system that it names"
                                                : "round longitude " + number_text(plane_.origin().longitude) +
                                                      ", latitude " + number_text(plane_.origin().latitude);
    note_units("degrees: " + reason_ + "; brought to metres " + where);
  }

  void settle_metres(const std::string& words) {
    out_.set_plane({});
    note_units(words);
  }

  void settle_projected(const OGRSpatialReference& system) {
    const double metres_a_unit = system.GetLinearUnits();
    plane_.set_scale(metres_a_unit);
    LocalPlane plane;
    if (system.IsProjected()) {
      OGRSpatialReference in_metres = system;
      if (metres_a_unit != 1.0) in_metres.SetLinearUnitsAndUpdateParameters("metre", 1.0);
      plane.reference_system = wkt_of(in_metres);
    }
    out_.set_plane(plane);
    const char* name = system.GetName();
    note_units(number_text(metres_a_unit) + " m a unit: by its reference system " +
               (name != nullptr ? name : "without a name"));
  }

  void note_units(const std::string& words) { out_.note(layers() > 1 ? "layer " + layer_name() : "", words); }

  void note_extent() {
    if (!out_.extent()) return;
    const auto [low, high] = *out_.extent();
    out_.note("", "extent " + number_text(low.x) + " to " + number_text(high.x) + " m, " + number_text(low.y) + " to " +
                      number_text(high.y) + " m");
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

  void settle_impossible_degrees(Units units) {
    if (units == Units::degrees || !geojson_) {
      throw DataError(DataCode::projection, path_.string(), layer_name(),
                      "coordinates beyond 180 degrees east or 90 north", "longitudes and latitudes");
    }
    settle_metres("taken as metres: says nothing of units and has coordinates that are no longitude or latitude");
  }

  static bool is_refused(const Item& item) { return item.record != nullptr && item.record->fault; }

  void add(const Item& item) {
    const std::string& place = item.place;
    if (is_refused(item)) return out_.reject(*item.record->fault);
    if (const auto lost = geojson_ || !is_csv() ? std::nullopt : lost_from_csv(*item.feature, place))
      return out_.reject(*lost);
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
    return datasets::properties_of(*item.feature, data_->GetDriverName() == std::string("GPKG"));
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
  OGRSpatialReference named_system_;  ///< by GeoJSON
  std::string reason_;                ///< why the layer's units are what they are
};

/// Entities are declared before the first element; what is hidden behind a longer comment is left to expat, which
/// bounds what entities grow to.
void refuse_early_entities(const std::filesystem::path& path) {
  constexpr std::size_t kDeclarations = 1 << 16;
  const std::string beginning = read_beginning(path, kDeclarations);
  if (!beginning.empty() && beginning[0] == '<') refuse_entities(beginning, path.string());
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
  refuse_early_entities(path);
  VectorReader(path, out).read();
}

}  // namespace exactvo::datasets
