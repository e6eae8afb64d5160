// SPDX-License-Identifier: GPL-3.0-or-later
#include <ogrsf_frmts.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/box.h"
#include "files/file_names.h"
#include "files/text_file.h"
#include "gdal/gdal_session.h"
#include "gdal/geojson_scan.h"
#include "gdal/geojson_sequence.h"
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

/// A sequence whose first line is malformed is one that GDAL does not know.
bool is_sequence_name(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  const char* const known[] = {".geojsonl", ".geojsons", ".geojsonseq", ".ndjson"};
  return std::find(std::begin(known), std::end(known), extension) != std::end(known);
}

/// What begins so, in words.
std::string kind_of_value(char c) {
  if (c == '"') return "a string";
  if (c == '[') return "an array";
  if (c == 'n') return "null";
  return c == 't' || c == 'f' ? "true or false" : "a number";
}

class VectorReader {
 public:
  VectorReader(const std::filesystem::path& path, Collector& out)
      : path_(path), out_(out), geojson_parsing_(path), plane_(path_, out, complaints_) {
    const std::string driver = vector_driver_of(path);
    if (is_sequence_file(driver)) return;  // GDAL is not asked: it would read all of it now
    if (driver == "GeoJSON") refuse_bulky_geojson();
    data_ = open_vectors(path, driver);
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
    if (driver() == "GeoJSON") reject_strays();
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
    const std::string extension = lower_extension(path_);
    if (extension != ".json" && extension != ".geojson" && extension != ".topojson") return;
    check_json_syntax(read_text_file(path_), path_.string());
  }

  /// Of GeoJSON alone.
  const GeoJsonScan& scan() {
    if (!scan_) scan_ = scan_geojson(path_, is_sequence_name(path_));
    return *scan_;
  }

  /// Of a collection GDAL takes one feature after the other, with a limit of its own (GeoJsonParsing), which leaves out
  /// what stands before them.
  void refuse_bulky_geojson() {
    std::error_code error;
    const double size = static_cast<double>(std::filesystem::file_size(path_, error));
    const JsonMemory& memory = scan().memory;
    const bool is_bulky =
        scan().is_collection() ? !error && memory.bytes() > parser_memory_for(size) : memory.is_too_much();
    if (is_bulky) throw too_bulky(memory, path_.string(), "");
  }

  void reject_strays() {
    for (const StrayEntry& stray : scan().strays)
      out_.reject({DataCode::format_syntax, path_.string(), "/features/" + std::to_string(stray.number),
                   kind_of_value(stray.begin), "a feature"});
  }

  /// GeoJSON that GDAL does not take for such: it looks for the type in the first 6000 bytes.
  void refuse_late_type() {
    const std::string& type = scan().type;
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
    const GeoJsonText* json = nullptr;    ///< of a sequence
  };

  bool is_sequence_file(const std::string& driver) {
    if (driver.empty()) return is_sequence_name(path_);
    return driver == "GeoJSONSeq" || (driver == "GeoJSON" && scan().is_sequence);
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
                  &record->text});
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
      action(Item{number, place_of(number), feature->GetGeometryRef(), feature.get()});
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

  /// What the numbers of this layer mean: sets `plane_`.
  void settle_coordinates() {
    plane_.reset();
    const OGRSpatialReference* system = is_sequence() ? OGRSpatialReference::GetWGS84SRS() : layer_->GetSpatialRef();
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
    return is_geojson() ? units_of_geojson() : Units::automatic;
  }

  Units units_of_geojson() {
    reason_ = "GeoJSON that says nothing of units (RFC 7946)";
    const char* native = is_sequence() ? nullptr : layer_->GetMetadataItem("NATIVE_DATA", "NATIVE_DATA");
    if (native == nullptr) return Units::automatic;
    const Json members = parse_json(native, path_.string());
    plane_.set_given(given_plane(members, path_.string()));
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

  void add(const Item& item) {
    const std::string& place = item.place;
    if (item.fault != nullptr) return out_.reject(*item.fault);
    std::optional<GeoJsonText> of_feature;
    if (driver() == "GeoJSON") of_feature.emplace(text_of(*item.feature));
    const GeoJsonText* json = of_feature ? &*of_feature : item.json;
    if (item.feature != nullptr) {
      if (const std::optional<DataError> lost = lost_geometry(*item.feature, json, place)) {
        has_told_malformed_ = true;
        return out_.reject(*lost);
      }
    }
    if (item.shape == nullptr) return out_.pass_over(place, "a feature without geometry skipped");
    const FeatureProperties properties = properties_of(item, json);
    std::size_t part = 0;
    Visitor visitor;
    visitor.other = [&](const std::string& words) { out_.pass_over(place, words); };
    visitor.shape = [&](RawKind kind, std::vector<geometry::Ring> rings) {
      hand_on(item.number, part++, place, kind, std::move(rings), properties);
    };
    visit(*item.shape, visitor);
  }

  /// A geometry that stands alone is the whole file.
  static bool stands_alone(const OGRFeature& feature) { return feature.GetNativeData() == nullptr; }
  std::string text_of(const OGRFeature& feature) const {
    return stands_alone(feature) ? read_text_file(path_) : feature.GetNativeData();
  }

  FeatureProperties properties_of(const Item& item, const GeoJsonText* json) const {
    if (!out_.options().keep_properties) return {};
    if (json != nullptr && (item.feature == nullptr || !stands_alone(*item.feature))) return json->properties();
    return datasets::properties_of(*item.feature, driver() == "GPKG");
  }

  /// GDAL says nothing of a geometry that it cannot make out, or of the parts of one.
  std::optional<DataError> lost_geometry(const OGRFeature& feature, const GeoJsonText* json,
                                         const std::string& place) const {
    if (json != nullptr) return lost_from_geojson(feature, *json, place);
    return driver() == "CSV" ? lost_from_csv(feature, place) : std::nullopt;
  }

  std::optional<DataError> lost_from_geojson(const OGRFeature& feature, const GeoJsonText& json,
                                             const std::string& place) const {
    const OGRGeometry* shape = feature.GetGeometryRef();
    const std::optional<GeoJsonFault> fault = json.fault(shape != nullptr && !shape->IsEmpty());
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
  GeoJsonParsing geojson_parsing_;
  GdalComplaints complaints_;
  std::string malformed_;            ///< GDAL's words of a geometry of GeoJSON
  bool has_told_malformed_ = false;  ///< in words of our own, with the feature
  std::unique_ptr<GDALDataset> data_;
  OGRLayer* layer_ = nullptr;
  LayerPlane plane_;
  std::string reason_;  ///< why the layer's units are what they are
  std::optional<GeoJsonScan> scan_;
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
