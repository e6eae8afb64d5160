// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/part.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <utility>

#include "batch/formats/picture.h"
#include "batch/work/half_planes.h"
#include "exactvo/geometry/require.h"
#include "json_text.h"
#include "obstacle_record_json.h"

namespace exactvo::datasets::batch {
namespace {

/// A feature as a line of GeoJSON.
using ToGeoJson = std::function<std::string(const Feature& feature)>;

constexpr char kMagic[] = "EXACTVO PART 3\n";

// --- Making ---

void append_rejection(const Chunk& chunk, const ChunkItem& item, Part& part) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("file", chunk.file).member("outcome", "rejected");
  json.member("code", code_name(item.rejected->code())).member("place", item.rejected->place());
  json.member("found", item.rejected->found()).member("expected", item.rejected->expected()).end_object();
  part.figures += json.take() + "\n";
}

std::string record_of(const FeatureHead& head, const geometry::ObstacleShapes& shapes,
                      const BatchConfiguration& configuration, PartCounts& counts) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("file", head.file).member("id", head.id).member("key", head.key);
  json.member("outcome", head.outcome);
  append_figures(json, shapes);
  append_verdicts(json, shapes);
  if (configuration.robot) counts.no_half_plane += append_half_planes(json, shapes, *configuration.robot);
  return json.end_object().take();
}

void append_features(const FeatureHead& head, const geometry::ObstacleShapes& shapes,
                     const BatchConfiguration& configuration, const ToGeoJson& to_geojson, Part& part) {
  if (!configuration.geojson && !configuration.geopackage) return;
  features_of(head, shapes, [&](const Feature& feature) {
    if (configuration.geopackage) append_row(part.rows, feature);
    if (!configuration.geojson) return;
    std::string& text = part.features[feature.layer];
    if (!text.empty()) text += ",\n";
    text += to_geojson(feature);
  });
}

/// In metres, or in degrees on the chunk's plane.
ToGeoJson geojson_writer(const Chunk& chunk, const BatchConfiguration& configuration) {
  if (!configuration.geojson || configuration.geojson_in_metres)
    return [](const Feature& feature) { return to_geojson(feature, [](geometry::Ring ring) { return ring; }); };
  const auto to_degrees = std::make_shared<const MetresToDegrees>(chunk.plane, chunk.file);
  return [to_degrees](const Feature& feature) {
    return to_geojson(feature, [&](geometry::Ring ring) { return (*to_degrees)(std::move(ring)); });
  };
}

geometry::ShapeOptions options_for(const BatchConfiguration& configuration) {
  geometry::ShapeOptions options = configuration.shapes;
  options.check_validity = false;  // the reader has judged them
  if (configuration.robot) {
    options.robot_radius = configuration.robot->radius;
    const std::optional<geometry::Vec2>& goal = configuration.robot->goal;
    if (goal) options.way = geometry::Way{configuration.robot->positions.front(), *goal};
  }
  return options;
}

// --- Bytes: the magic line, four counts, then every text after its length ---

void append_count(std::string& bytes, std::uint64_t count) {
  char raw[sizeof count];
  std::memcpy(raw, &count, sizeof count);
  bytes.append(raw, sizeof count);
}

/// Takes the text, so that it is not held twice for long.
void append_text(std::string& bytes, std::string text) {
  append_count(bytes, text.size());
  bytes += text;
}

/// The pictures come first of the texts: they alone are wanted again.
constexpr std::size_t kCounts = 4;
constexpr std::size_t kBytesBeforePictures = sizeof kMagic - 1 + (kCounts + 1) * sizeof(std::uint64_t);

/// To the byte, so that a part is not moved while it grows.
std::size_t size_of_bytes(const Part& part) {
  constexpr std::size_t kTextsBesideLayers = 3;
  const std::size_t numbers = kCounts + kTextsBesideLayers + part.features.size();
  std::size_t size = sizeof kMagic - 1 + numbers * sizeof(std::uint64_t);
  size += part.figures.size() + part.rows.size() + part.pictures.size();
  for (const std::string& layer : part.features) size += layer.size();
  return size;
}

[[noreturn]] void refuse_part(const std::filesystem::path& path) {
  throw DataError(DataCode::format_syntax, path.string(), "", "no part of a batch", "what a batch has written");
}

class PartReader {
 public:
  PartReader(std::string_view bytes, const std::filesystem::path& path) : bytes_(bytes), path_(path) {
    if (bytes_.substr(0, sizeof kMagic - 1) != kMagic) refuse();
    bytes_.remove_prefix(sizeof kMagic - 1);
  }

  std::uint64_t count() {
    std::uint64_t value = 0;
    if (bytes_.size() < sizeof value) refuse();
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }

  std::string_view text() {
    const std::uint64_t length = count();
    if (bytes_.size() < length) refuse();
    const std::string_view taken = bytes_.substr(0, length);
    bytes_.remove_prefix(length);
    return taken;
  }

 private:
  [[noreturn]] void refuse() const { refuse_part(path_); }

  std::string_view bytes_;
  const std::filesystem::path& path_;
};

PartCounts counts_of(PartReader& reader) {
  PartCounts counts;
  counts.obstacles = reader.count();
  counts.certified = reader.count();
  counts.vertices = reader.count();
  counts.no_half_plane = reader.count();
  return counts;
}

/// So many more. A length that is no length must not be believed: what is there is taken bit by bit.
std::string take_from(std::istream& bytes, std::uint64_t length, const std::filesystem::path& path) {
  std::string taken;
  char block[1 << 14];
  while (taken.size() < length) {
    const std::uint64_t wanted = std::min<std::uint64_t>(sizeof block, length - taken.size());
    if (!bytes.read(block, static_cast<std::streamsize>(wanted))) refuse_part(path);
    taken.append(block, wanted);
  }
  return taken;
}

}  // namespace

Part part_of(const Chunk& chunk, const BatchConfiguration& configuration) {
  Part part;
  part.features.resize(layers().size());
  const ToGeoJson to_geojson = geojson_writer(chunk, configuration);
  const geometry::ShapeOptions options = options_for(configuration);
  std::size_t pictures = chunk.number == 0 && configuration.pictures ? kPicturesOfInput : 0;
  for (std::size_t k = 0; k < chunk.items.size(); ++k) {
    const ChunkItem& item = chunk.items[k];
    if (item.rejected) {
      append_rejection(chunk, item, part);
      continue;
    }
    const geometry::ObstacleShapes shapes = shapes_of(item.obstacle.shape, options);
    const FeatureHead head{chunk.file, item.obstacle.id, chunk.file + "#" + std::to_string(chunk.first + k),
                           item.repaired ? "repaired" : "done"};
    ++part.counts.obstacles;
    part.counts.certified += shapes.certified() ? 1 : 0;
    part.counts.vertices += shapes.figures.vertices;
    part.figures += record_of(head, shapes, configuration, part.counts) + "\n";
    append_features(head, shapes, configuration, to_geojson, part);
    if (pictures > 0) {
      part.pictures += picture_of(head.id, shapes);
      --pictures;
    }
  }
  return part;
}

std::string to_bytes(Part part) {
  EXACTVO_REQUIRE(part.features.size() == layers().size(), std::to_string(part.features.size()));
  std::string bytes;
  bytes.reserve(size_of_bytes(part));
  bytes += kMagic;
  const PartCounts& counts = part.counts;
  for (const std::uint64_t count : {counts.obstacles, counts.certified, counts.vertices, counts.no_half_plane})
    append_count(bytes, count);
  append_text(bytes, std::move(part.pictures));
  append_text(bytes, std::move(part.figures));
  for (std::string& layer : part.features) append_text(bytes, std::move(layer));
  append_text(bytes, std::move(part.rows));
  return bytes;
}

PartView view_of_part(std::string_view bytes, const std::filesystem::path& path) {
  PartReader reader(bytes, path);
  PartView part;
  part.counts = counts_of(reader);
  part.pictures = reader.text();
  part.figures = reader.text();
  for (std::size_t k = 0; k < layers().size(); ++k) part.features.push_back(reader.text());
  part.rows = reader.text();
  return part;
}

std::string pictures_at_start(std::istream& bytes, const std::filesystem::path& path) {
  const std::string head = take_from(bytes, kBytesBeforePictures, path);
  PartReader reader(head, path);
  counts_of(reader);
  return take_from(bytes, reader.count(), path);
}

}  // namespace exactvo::datasets::batch
