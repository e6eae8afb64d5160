// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/part.h"

#include <algorithm>
#include <array>

#include "batch/formats/bytes.h"
#include "batch/formats/picture.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/require.h"
#include "exactvo/vo/velocity_obstacle.h"
#include "json/json_text.h"
#include "obstacles/obstacle_record_json.h"

namespace exactvo::datasets::batch {
namespace {

using geometry::ConvexShape;
using geometry::Vec2;

// --- Half-planes of the batch's robot ---

/// Whether there is one.
bool append_half_plane(JsonWriter& json, const ConvexShape& shape, Vec2 position, const BatchRobot& robot) {
  const geometry::GrownShape grown{shape, position, robot.radius};
  const auto half_plane = vo::half_plane(grown, robot.time_horizon, robot.velocity);
  if (!half_plane) {
    json.null();
    return false;
  }
  json.begin_object().member("normal", half_plane->normal).member("offset", half_plane->offset);
  json.member("certified", half_plane_is_safe(grown, robot.time_horizon, *half_plane)).end_object();
  return true;
}

bool overlaps(const ConvexShape& shape, Vec2 position, double radius) {
  return geometry::locate({shape, position, radius}, {0.0, 0.0}) != geometry::Place::outside;
}

ConvexShape hull_shape(const geometry::ConvexPolygon& hull) {
  if (hull.vertices.size() > 2) return hull;
  return geometry::Segment{hull.vertices.front(), hull.vertices.back()};
}

std::uint64_t append_position(JsonWriter& json, const geometry::ObstacleShapes& shapes, Vec2 position,
                              const BatchRobot& robot) {
  const ConvexShape hull = hull_shape(shapes.hull);
  const bool within_hull = overlaps(hull, position, robot.radius);
  json.begin_object().member("position", position).member("of", within_hull ? "pieces" : "hull");
  json.key("half_planes").begin_array();
  std::uint64_t missing = 0;
  if (!within_hull) {
    missing += append_half_plane(json, hull, position, robot) ? 0 : 1;
  } else {
    for (const ConvexShape& piece : shapes.pieces) missing += append_half_plane(json, piece, position, robot) ? 0 : 1;
  }
  json.end_array().end_object();
  return missing;
}

/// The member "half_planes": for each position the half-plane of the obstacle's hull nearest to the robot's velocity;
/// where the robot stands within the hull, of each convex piece instead. "certified" says that the pair of doubles
/// excludes the velocity obstacle (predicate A, exact). In bare contact it is the half-plane away from the nearest
/// point, where that can be proven; null stands where the robot overlaps the shape, and within a few ulps of contact
/// where nothing could be proven. Returns how many are null.
std::uint64_t append_half_planes(JsonWriter& json, const geometry::ObstacleShapes& shapes, const BatchRobot& robot) {
  json.key("half_planes").begin_array();
  std::uint64_t missing = 0;
  for (const Vec2 position : robot.positions) missing += append_position(json, shapes, position, robot);
  json.end_array();
  return missing;
}

// --- Making ---

void append_rejection(const Chunk& chunk, const ChunkItem& item, Part& part) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("file", chunk.file).member("outcome", "rejected");
  json.member("code", code_name(item.rejected->code())).member("place", item.rejected->place());
  json.member("found", item.rejected->found()).member("expected", item.rejected->expected()).end_object();
  part.measurements += json.take() + "\n";
}

std::string record_of(const FeatureHead& head, const geometry::ObstacleShapes& shapes,
                      const BatchConfiguration& configuration, Counts& counts) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("file", head.file).member("id", head.id).member("key", head.key);
  json.member("outcome", head.outcome);
  append_measurements(json, shapes);
  append_verdicts(json, shapes);
  if (configuration.robot) counts.no_half_plane += append_half_planes(json, shapes, *configuration.robot);
  return json.end_object().take();
}

void append_features(const FeatureHead& head, const geometry::ObstacleShapes& shapes,
                     const BatchConfiguration& configuration, const Place& place, Part& part) {
  if (!configuration.geojson && !configuration.geopackage) return;
  features_of(head, shapes, [&](const Feature& feature) {
    if (configuration.geopackage) append_row(part.rows, feature);
    if (!configuration.geojson) return;
    std::string& text = part.features[feature.layer];
    if (!text.empty()) text += ",\n";
    text += to_geojson(feature, place);
  });
}

/// In metres, or in degrees on the chunk's plane.
Place place_for(const Chunk& chunk, const BatchConfiguration& configuration) {
  if (!configuration.geojson || configuration.geojson_in_metres) return [](geometry::Ring ring) { return ring; };
  return MetresToDegrees(chunk.plane, chunk.file);
}

geometry::ShapeOptions options_for(const BatchConfiguration& configuration) {
  geometry::ShapeOptions options = configuration.shapes;
  options.check_validity = false;  // the reader has validated them
  if (configuration.robot) {
    options.robot_radius = configuration.robot->radius;
    const std::optional<geometry::Vec2>& goal = configuration.robot->goal;
    if (goal) options.way = geometry::StartAndGoal{configuration.robot->positions.front(), *goal};
  }
  return options;
}

// --- Bytes: the magic line, their number, the counts, then every text after its length ---

constexpr std::string_view kMagic = "EXACTVO PART 5\n";
using Number = std::uint64_t;

constexpr std::size_t kNumbers = 4;

std::array<Number*, kNumbers> numbers_of(Counts& counts) {
  return {&counts.obstacles, &counts.certified, &counts.vertices, &counts.no_half_plane};
}

/// The pictures come first: they alone are wanted again.
constexpr std::size_t kBytesBeforePictures = kMagic.size() + (kNumbers + 2) * sizeof(Number);

template <class Text>
std::vector<Text*> texts_of(PartOf<Text>& part) {
  std::vector<Text*> texts{&part.pictures, &part.measurements};
  for (Text& layer : part.features) texts.push_back(&layer);
  texts.push_back(&part.rows);
  return texts;
}

[[noreturn]] void refuse_part(const std::filesystem::path& path) {
  throw DataError(DataCode::format_syntax, path.string(), "", "no part of a batch", "what a batch has written");
}

/// This many more. A length that is no length must not be believed: what is there is taken bit by bit.
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

Counts& Counts::operator+=(const Counts& more) {
  obstacles += more.obstacles;
  certified += more.certified;
  vertices += more.vertices;
  no_half_plane += more.no_half_plane;
  nanoseconds += more.nanoseconds;
  return *this;
}

Part part_of(const Chunk& chunk, const BatchConfiguration& configuration) {
  Part part;
  part.features.resize(layers().size());
  const Place place = place_for(chunk, configuration);
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
    part.counts.vertices += shapes.measurements.vertices;
    part.measurements += record_of(head, shapes, configuration, part.counts) + "\n";
    append_features(head, shapes, configuration, place, part);
    if (pictures > 0) {
      part.pictures += picture_of(head.id, shapes);
      --pictures;
    }
  }
  return part;
}

std::string to_bytes(Part part) {
  EXACTVO_REQUIRE(part.features.size() == layers().size(), std::to_string(part.features.size()));
  const auto numbers = numbers_of(part.counts);
  const std::vector<std::string*> texts = texts_of(part);
  // To the byte, so that a part is not moved while it grows.
  std::size_t size = kMagic.size() + (1 + numbers.size() + texts.size()) * sizeof(Number);
  for (const std::string* text : texts) size += text->size();
  std::string bytes;
  bytes.reserve(size);
  bytes += kMagic;
  append_raw(bytes, static_cast<Number>(size));
  for (const Number* number : numbers) append_raw(bytes, *number);
  for (std::string* text : texts) {
    append_text<Number>(bytes, *text);
    std::string().swap(*text);  // so that it is not held twice for long
  }
  return bytes;
}

bool holds_whole_part(std::istream& bytes) {
  const auto begin = bytes.tellg();
  std::string head(kMagic.size() + sizeof(Number), '\0');
  if (!bytes.read(head.data(), static_cast<std::streamsize>(head.size())) ||
      head.compare(0, kMagic.size(), kMagic) != 0)
    return false;
  bytes.seekg(0, std::ios::end);
  std::string_view size = std::string_view(head).substr(kMagic.size());
  return static_cast<Number>(bytes.tellg() - begin) == take_raw<Number>(size);
}

PartView view_of_part(std::string_view bytes, const std::filesystem::path& path) {
  const Number all = bytes.size();
  const auto take = [&](std::size_t length) {
    if (bytes.size() < length) refuse_part(path);
    return take_bytes(bytes, length);
  };
  const auto take_number = [&] {
    std::string_view raw = take(sizeof(Number));
    return take_raw<Number>(raw);
  };
  if (take(std::min(bytes.size(), kMagic.size())) != kMagic) refuse_part(path);
  if (take_number() != all) refuse_part(path);
  PartView part;
  part.features.resize(layers().size());
  for (Number* number : numbers_of(part.counts)) *number = take_number();
  for (std::string_view* text : texts_of(part)) *text = take(take_number());
  return part;
}

std::string pictures_at_start(std::istream& bytes, const std::filesystem::path& path) {
  const std::string head = take_from(bytes, kBytesBeforePictures, path);
  if (head.compare(0, kMagic.size(), kMagic) != 0) refuse_part(path);
  std::string_view length = std::string_view(head).substr(head.size() - sizeof(Number));
  return take_from(bytes, take_raw<Number>(length), path);
}

}  // namespace exactvo::datasets::batch
