// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/formats/geopackage.h"

#include <fcntl.h>
#include <ogrsf_frmts.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <vector>

#include "batch/formats/bytes.h"
#include "batch/formats/features.h"
#include "batch/formats/packed_rtree.h"
#include "batch/formats/sqlite_file.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/geometry/require.h"
#include "files/system_error.h"
#include "gdal/gdal_session.h"

namespace exactvo::datasets::batch {
namespace {

// --- The schema ---

/// By the kind of `Value`.
constexpr OGRFieldType kTypes[] = {OFTString, OFTReal, OFTInteger64};

class Schema {
 public:
  Schema(const char* name, const std::filesystem::path& path) : path_(path) {
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    need(driver != nullptr);
    data_.reset(driver->Create(name, 0, 0, 0, GDT_Unknown, nullptr));
    need(data_ != nullptr);
  }

  void describe(const std::string& provenance) {
    need(data_->SetMetadataItem("EXACTVO_PROVENANCE", provenance.c_str()) == CE_None);
  }

  void create_layer(const Layer& layer) {
    const char* const options[] = {"SPATIAL_INDEX=YES", nullptr};
    OGRSpatialReference metres;  // without one the format takes numbers for degrees
    metres.SetLocalCS("local metres");
    metres.SetLinearUnits("metre", 1.0);
    OGRLayer* made = data_->CreateLayer(layer.name, &metres, wkbUnknown, const_cast<char**>(options));
    need(made != nullptr);
    for (const Field& field : layer.fields) {
      OGRFieldDefn definition(field.name, kTypes[field.value.index()]);
      need(made->CreateField(&definition) == OGRERR_NONE);
    }
  }

  void close() {
    data_->FlushCache();
    data_.reset();
    need(true);
  }

 private:
  void need(bool done) {
    const std::string words = complaints_.take_failure();
    if (done && words.empty()) return;
    throw DataError(DataCode::file_unwritable, path_.string(), "", words.empty() ? "GDAL can't write it" : words,
                    "a place that can be written");
  }

  const std::filesystem::path& path_;
  GdalComplaints complaints_;
  std::unique_ptr<GDALDataset> data_;
};

/// The bytes of an empty GeoPackage with the layers of a batch, as GDAL makes it: tables, spatial indices, extensions,
/// metadata. The same for the same provenance: the times that the format records are those of 1970. `path` is for what
/// errors say. Throws DataError (E_FILE_UNWRITABLE).
std::string empty_package(const std::string& provenance, const std::filesystem::path& path) {
  register_gdal_once();
  const MemoryFile file(".gpkg", "1970-01-01T00:00:00.000Z");
  Schema schema(file.name(), path);
  schema.describe(provenance);
  for (const Layer& layer : layers()) schema.create_layer(layer);
  schema.close();
  return file.bytes();
}

// --- The rows ---

std::string insertion_into(const Layer& layer) {
  std::string columns = "INSERT INTO " + sql_name(layer.name) + " (fid, geom";
  std::string values = ") VALUES (?, ?";
  for (const Field& field : layer.fields) {
    columns += ", " + sql_name(field.name);
    values += ", ?";
  }
  return columns + values + ")";
}

std::int32_t reference_of(SqliteFile& file, const Layer& layer) {
  SqliteStatement find(file, "SELECT srs_id FROM gpkg_geometry_columns WHERE table_name = ?");
  const bool is_there = find.bind(0, layer.name).step();
  EXACTVO_REQUIRE(is_there, std::string("no geometries of ") + layer.name + " in the schema");
  return static_cast<std::int32_t>(find.integer(0));
}

/// Magic, version and flags.
constexpr std::string_view kFixed{"GP\0\3", 4};

class LayerTable {
 public:
  LayerTable(SqliteFile& file, const Layer& layer)
      : name_(layer.name),
        insert_(file, insertion_into(layer)),
        index_(file, "rtree_" + name_ + "_geom"),
        reference_(reference_of(file, layer)) {}

  void add(const Row& row) {
    std::string_view rest = row.geometry;
    auto head = take_raw<GeometryHead>(rest);
    EXACTVO_REQUIRE(row.geometry.substr(0, kFixed.size()) == kFixed, "no head of a geometry");
    EXACTVO_REQUIRE(head.min_x <= head.max_x && head.min_y <= head.max_y, "a geometry without a point");
    head.reference = reference_;
    geometry_.clear();
    append_raw(geometry_, head);
    geometry_ += rest;
    insert_.bind(0, ++rows_).bind_bytes(1, geometry_);
    int column = 2;
    for (const Value& value : row.values) std::visit([&](const auto& v) { insert_.bind(column++, v); }, value);
    insert_.run();
    index_.add(rows_,
               {rounded_down(head.min_x), rounded_up(head.max_x), rounded_down(head.min_y), rounded_up(head.max_y)});
    extent_.add({head.min_x, head.min_y}, {head.max_x, head.max_y});
  }

  void finish(SqliteFile& file) {
    index_.finish();
    SqliteStatement count(file, "UPDATE gpkg_ogr_contents SET feature_count = ? WHERE table_name = ?");
    count.bind(0, rows_).bind(1, name_).run();
    if (rows_ == 0) return;
    SqliteStatement place(file,
                          "UPDATE gpkg_contents SET min_x = ?, max_x = ?, min_y = ?, max_y = ? WHERE table_name = ?");
    place.bind(0, extent_.min_x).bind(1, extent_.max_x).bind(2, extent_.min_y).bind(3, extent_.max_y);
    place.bind(4, name_).run();
  }

 private:
  std::string name_;
  SqliteStatement insert_;
  PackedRtree index_;
  std::int32_t reference_;
  std::int64_t rows_ = 0;
  GeometryHead extent_;  ///< of all
  std::string geometry_;
};

/// What keeps counts and indices up to date row by row is set aside while all rows come: each would cost as much as its
/// row, and they call functions that GDAL has and SQLite has not.
std::vector<std::string> take_triggers(SqliteFile& file) {
  std::vector<std::string> names;
  std::vector<std::string> definitions;
  SqliteStatement triggers(file, "SELECT name, sql FROM sqlite_master WHERE type = 'trigger' ORDER BY rowid");
  while (triggers.step()) {
    names.push_back(triggers.text(0));
    definitions.push_back(triggers.text(1));
  }
  for (const std::string& name : names) file.run("DROP TRIGGER " + sql_name(name));
  return definitions;
}

void write_file(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file << bytes << std::flush;
  if (!file) throw cannot_write(path, errno);
}

void sync_file(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw cannot_write(path, errno);
  const int failed = ::fsync(descriptor) != 0 ? errno : 0;
  ::close(descriptor);
  if (failed != 0) throw cannot_write(path, failed);
}

class WrittenGeoPackage final : public GeoPackage {
 public:
  /// `path` holds the schema.
  explicit WrittenGeoPackage(const std::filesystem::path& path) : path_(path), file_(path) {
    // 16 MB of pages in memory.
    file_.run("PRAGMA journal_mode = OFF; PRAGMA synchronous = OFF; PRAGMA cache_size = -16384; BEGIN");
    triggers_ = take_triggers(file_);
    for (const Layer& layer : layers()) tables_.push_back(std::make_unique<LayerTable>(file_, layer));
  }

  void add(std::string_view rows) override {
    while (!rows.empty()) {
      const Row row = read_row(rows);
      tables_[row.layer]->add(row);
    }
  }

  void finish() override {
    for (const auto& table : tables_) table->finish(file_);
    tables_.clear();
    for (const std::string& trigger : triggers_) file_.run(trigger);
    file_.run("COMMIT");
    file_.close();
    sync_file(path_);
  }

 private:
  std::filesystem::path path_;
  SqliteFile file_;
  std::vector<std::string> triggers_;
  std::vector<std::unique_ptr<LayerTable>> tables_;
};

}  // namespace

std::unique_ptr<GeoPackage> make_geopackage(const std::filesystem::path& path, const std::string& provenance) {
  write_file(path, empty_package(provenance, path));
  return std::make_unique<WrittenGeoPackage>(path);
}

}  // namespace exactvo::datasets::batch
