// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/crowd_recording_format.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <unordered_set>
#include <utility>
#include <vector>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/shape_numbers.h"
#include "exactvo/geometry/told_apart.h"
#include "files/text_file.h"
#include "json/json_text.h"

namespace exactvo::datasets {

namespace {

constexpr std::uint32_t kMostKinds = 1U << 14U, kMostRobots = 1U << 30U, kMostEdges = 1U << 24U;
constexpr std::size_t kLongestName = 1000;

CrowdBodyRecord get_body(CrowdBytes& in) {
  CrowdBodyRecord body;
  const auto moves = in.get<std::uint8_t>(), kind = in.get<std::uint8_t>();
  const auto count = in.get<std::uint32_t>();
  in.require(moves <= 1, "a body that neither moves nor rests");
  std::vector<double> v;
  for (std::uint32_t k = 0; k < count; ++k) v.push_back(in.number("a number of a body"));
  const std::optional<geometry::ConvexShape> shape = geometry::shape_of(kind, v);
  in.require(shape && geometry::is_valid(*shape), "a body of no shape");
  body.moves = moves == 1;
  body.shape = *shape;
  return body;
}

constexpr std::int64_t kFarthestRobot = std::int64_t{1} << 30;
constexpr std::int64_t kFarthestBody = std::int64_t{1} << 52;

}  // namespace

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

std::uint64_t chained(std::uint64_t sum, std::uint64_t next) {
  std::string both;
  append(both, sum);
  append(both, next);
  return checksum(both);
}

void append_difference(std::string& to, std::int64_t difference) {
  auto left = (static_cast<std::uint64_t>(difference) << 1U) ^ static_cast<std::uint64_t>(difference >> 63);
  for (; left >= 0x80; left >>= 7U) to.push_back(static_cast<char>(left | 0x80U));
  to.push_back(static_cast<char>(left));
}

void CrowdBytes::refuse(const std::string& found) const {
  throw DataError(DataCode::format_syntax, file_, "byte " + std::to_string(at_), found,
                  "what simulate --record has written");
}

void CrowdBytes::require_in_range(double value, double factor, const char* what) const {
  const double found = std::fabs(value) * factor;
  if (!(found <= kLargestCoordinate))
    throw DataError(
        DataCode::out_of_range, file_, "byte " + std::to_string(at_),
        what + (" of " + geometry::lossless(value)) + (factor == 1.0 ? "" : " times " + geometry::lossless(factor)),
        "no more than 2^100");
}

unsigned crowd_version(std::string_view mark) {
  const auto* found = std::find(std::begin(kCrowdMarks), std::end(kCrowdMarks), mark);
  return found == std::end(kCrowdMarks) ? 0 : static_cast<unsigned>(found - std::begin(kCrowdMarks)) + 1;
}

void append_id(std::string& to, std::string_view id, std::string_view before) {
  const auto ends = std::mismatch(id.begin(), id.end(), before.begin(), before.end());
  const auto shared = static_cast<std::size_t>(ends.first - id.begin());
  append_difference(to, static_cast<std::int64_t>(shared));
  append_difference(to, static_cast<std::int64_t>(id.size() - shared));
  to += id.substr(shared);
}

unsigned version_of(const CrowdRecordingHead& head, bool has_ids) {
  const bool has_names = !head.obstacles.empty() || std::any_of(head.bodies.begin(), head.bodies.end(),
                                                                [](const auto& body) { return !body.id.empty(); });
  if (has_names || !head.half_headings.empty() || head.tracking > 0.0) return 5;
  return has_ids ? 3 : 2;
}

namespace {

void append_bodies_and_wheels(std::string& out, const CrowdRecordingHead& head) {
  append(out, head.tracking);
  for (const CrowdKindRecord& kind : head.kinds) {
    append(out, kind.body_radius);
    append(out, static_cast<std::uint8_t>(kind.wheels.has_value()));
    if (!kind.wheels) continue;
    const formation::CrowdWheels& w = *kind.wheels;
    for (const double v :
         {w.reference, w.wheel_separation, w.max_wheel_acceleration, w.max_angular_speed, w.max_backward_speed})
      append(out, v);
  }
  for (std::size_t i = 0; i < head.half_headings.size(); ++i)
    if (head.kinds[head.kind_of[i]].wheels) append(out, head.half_headings[i].x), append(out, head.half_headings[i].y);
}

void append_obstacle_ids(std::string& out, const CrowdRecordingHead& head) {
  append(out, static_cast<std::uint32_t>(head.obstacles.size()));
  std::string_view before;
  const auto append_next = [&](std::string_view id) { append_id(out, id, std::exchange(before, id)); };
  for (const CrowdObstacleRecord& obstacle : head.obstacles) append(out, obstacle.edges), append_next(obstacle.id);
  for (const CrowdBodyRecord& body : head.bodies) append_next(body.id);
}

}  // namespace

std::string to_bytes(const CrowdRecordingHead& head, std::string_view ids) {
  std::string out;
  append(out, static_cast<std::uint32_t>(head.scenario.size()));
  out += head.scenario;
  append(out, head.time_step);
  append(out, head.position_step);
  append(out, head.every);
  append(out, static_cast<std::uint32_t>(head.kinds.size()));
  for (const CrowdKindRecord& kind : head.kinds) append(out, kind.radius), append(out, kind.max_speed);
  append(out, static_cast<std::uint32_t>(head.kind_of.size()));
  for (const std::uint16_t kind : head.kind_of) append(out, kind);
  append(out, static_cast<std::uint32_t>(head.edges.size()));
  for (const geometry::Segment& e : head.edges)
    for (const double v : {e.a.x, e.a.y, e.b.x, e.b.y}) append(out, v);
  append(out, static_cast<std::uint32_t>(head.bodies.size()));
  for (const CrowdBodyRecord& body : head.bodies) {
    append(out, static_cast<std::uint8_t>(body.moves));
    append(out, static_cast<std::uint8_t>(body.shape.index()));
    const std::vector<double> numbers = geometry::numbers_of(body.shape);
    append(out, static_cast<std::uint32_t>(numbers.size()));
    for (const double v : numbers) append(out, v);
  }
  if (version_of(head, !ids.empty()) < 5) return out += ids;
  append_bodies_and_wheels(out, head);
  append(out, static_cast<std::uint8_t>(!ids.empty()));
  out += ids;
  append_obstacle_ids(out, head);
  return out;
}

namespace {

/// The id behind `id`, as `append_id` writes it.
void get_next_id(CrowdBytes& in, std::string& id) {
  constexpr std::int64_t kLongest = 1 << 16;
  const std::int64_t shared = in.difference(), rest = in.difference();
  in.require(shared >= 0 && shared <= static_cast<std::int64_t>(id.size()) && rest >= 0 && rest <= kLongest,
             "an id of no length");
  id = id.substr(0, static_cast<std::size_t>(shared)) + in.text(static_cast<std::size_t>(rest));
  in.require(id.size() <= kLongest, "an id of more than 2^16 bytes");
}

void get_ids(CrowdBytes& in, CrowdRecordingHead& head) {
  std::string id;
  std::unordered_set<std::string_view> seen;  // of ids, whose texts stay where they are: memory is reserved
  head.ids.reserve(head.kind_of.size());
  while (head.ids.size() < head.kind_of.size()) {
    get_next_id(in, id);
    head.ids.push_back(id);
    in.require(seen.insert(head.ids.back()).second, "an id that another robot has");
  }
}

void get_obstacle_ids(CrowdBytes& in, CrowdRecordingHead& head) {
  std::string id;
  std::uint64_t edges = 0;
  const auto obstacles = in.get<std::uint32_t>();
  in.require(obstacles <= kMostEdges, "more than 2^24 obstacles");
  for (std::uint32_t k = 0; k < obstacles; ++k) {
    const auto count = in.get<std::uint32_t>();
    get_next_id(in, id);
    head.obstacles.push_back({id, count});
    edges += count;
  }
  in.require(edges == head.edges.size(), "obstacles of another number of edges than there are");
  for (CrowdBodyRecord& body : head.bodies) {
    get_next_id(in, id);
    body.id = id;
  }
}

/// A limit that may be infinite.
double limit_of(CrowdBytes& in) {
  const auto value = in.get<double>();
  in.require(value >= 0.0, "a limit of wheels that is no number");
  if (std::isfinite(value)) in.require_in_range(value, 1.0, "a limit of wheels");
  return value;
}

void get_wheels(CrowdBytes& in, bool has_bodies, CrowdRecordingHead& head) {
  const auto length = [&](const char* what) {
    const double value = has_bodies ? in.number(what) : 0.0;
    in.require(value >= 0.0, "a length below 0");
    return value;
  };
  head.tracking = length("a tracking error");
  bool any = false;
  for (CrowdKindRecord& kind : head.kinds) {
    kind.body_radius = length("a radius of a body");
    const auto has_wheels = in.get<std::uint8_t>();
    in.require(has_wheels <= 1, "a kind that neither has wheels nor has none");
    if (has_wheels == 0) continue;
    any = true;
    formation::CrowdWheels& w = kind.wheels.emplace();
    w.reference = in.number("a reference");
    w.wheel_separation = in.number("a wheel separation");
    in.require(w.reference > 0.0 && w.wheel_separation > 0.0 && 16.0 * w.reference >= w.wheel_separation,
               "wheels that no crowd has");
    for (double* limit : {&w.max_wheel_acceleration, &w.max_angular_speed, &w.max_backward_speed})
      *limit = limit_of(in);
  }
  if (!any) return;
  for (const std::uint16_t kind : head.kind_of) {
    geometry::Vec2& half = head.half_headings.emplace_back(geometry::Vec2{1.0, 0.0});
    if (!head.kinds[kind].wheels) continue;
    half = {in.number("a heading"), in.number("a heading")};
    const double size = geometry::squared_norm(half);
    in.require(size > 0.5 && size < 4.0, "a heading of no direction");
  }
}

}  // namespace

CrowdRecordingHead to_head(CrowdBytes in, unsigned version) {
  CrowdRecordingHead head;
  const auto length = in.get<std::uint32_t>();
  in.require(length <= kLongestName, "a name of more than 1000 bytes");
  head.scenario = in.text(length);
  head.time_step = in.number("a time step");
  head.position_step = in.number("a lattice step", static_cast<double>(kFarthestRobot));
  in.require(head.time_step > 0.0 && head.position_step > 0.0, "a step that is not positive");
  head.every = in.get<std::uint32_t>();
  in.require(head.every > 0, "a row every 0 steps");
  const auto kinds = in.get<std::uint32_t>();
  in.require(kinds <= kMostKinds, "more than 2^14 kinds");
  for (std::uint32_t k = 0; k < kinds; ++k) {
    const double radius = in.number("a radius"), speed = in.number("a greatest speed");
    in.require(radius > 0.0 && speed > 0.0, "a kind that no crowd has");
    head.kinds.push_back({radius, speed});
  }
  const auto robots = in.get<std::uint32_t>();
  in.require(robots <= kMostRobots, "more than 2^30 robots");
  for (std::uint32_t i = 0; i < robots; ++i) {
    head.kind_of.push_back(in.get<std::uint16_t>());
    in.require(head.kind_of.back() < kinds, "a robot of an unknown kind");
  }
  const auto edges = in.get<std::uint32_t>();
  in.require(edges <= kMostEdges, "more than 2^24 edges");
  for (std::uint32_t k = 0; k < edges; ++k) {
    double v[4];
    for (double& number : v) number = in.number("a coordinate of an edge");
    head.edges.push_back({{v[0], v[1]}, {v[2], v[3]}});
  }
  if (version >= 2) {
    const auto bodies = in.get<std::uint32_t>();
    in.require(bodies <= kMostEdges, "more than 2^24 bodies");
    for (std::uint32_t k = 0; k < bodies; ++k) head.bodies.push_back(get_body(in));
  }
  if (version >= 4) get_wheels(in, version >= 5, head);
  const std::uint8_t has_ids = version >= 4 ? in.get<std::uint8_t>() : version == 3;
  in.require(has_ids <= 1, "robots that neither have ids nor have none");
  if (has_ids == 1) get_ids(in, head);
  if (version >= 5) get_obstacle_ids(in, head);
  in.require_end();
  return head;
}

struct CrowdRecordingReader::Parts {
  std::string name;
  std::ifstream in;
  CrowdRecordingHead head;
  CrowdRow row;  ///< the last one
  std::string block;
  std::uint64_t at = 0, block_at = 0;  ///< bytes read, and before the block
  std::uint64_t rows = 0, sum = 0;     ///< of the blocks read
  bool cut_off = false, ended = false;

  /// False where the file ends before.
  bool read(char* to, std::size_t size) {
    in.read(to, static_cast<std::streamsize>(size));
    at += static_cast<std::uint64_t>(in.gcount());
    return static_cast<std::size_t>(in.gcount()) == size;
  }

  /// A block behind its size and checksum. In pieces: a size that was changed asks for no more memory than there is.
  bool read_block() {
    constexpr std::uint64_t kAtOnce = 1U << 20U;
    std::uint64_t size = 0, stated = 0;
    block.clear();
    block_at = at;
    if (!read(reinterpret_cast<char*>(&size), sizeof size) || !read(reinterpret_cast<char*>(&stated), sizeof stated))
      return false;
    block_at = at;
    while (block.size() < size) {
      const std::size_t had = block.size();
      block.resize(had + static_cast<std::size_t>(std::min(kAtOnce, size - had)));
      if (!read(block.data() + had, block.size() - had)) return false;
    }
    if (checksum(block) != stated) bytes().refuse("another checksum than its content has");
    return true;
  }
  /// Behind the last row. REQUIRES: its block was read.
  void check_end() {
    CrowdBytes seal = bytes();
    const auto all_rows = seal.get<std::uint64_t>(), all_sum = seal.get<std::uint64_t>();
    seal.require_end();
    if (all_rows != rows || all_sum != sum) bytes().refuse("an end of other rows than these");
    if (in.peek() != std::ifstream::traits_type::eof()) bytes().refuse("bytes after the end");
  }
  CrowdBytes bytes() const { return {block, name, block_at}; }
};

CrowdRecordingReader::CrowdRecordingReader(const std::filesystem::path& path) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw DataError(DataCode::file_missing, p.name, "", "no such file", "a recording of a crowd");
  p.in.open(path, std::ios::binary);
  if (!p.in)
    throw DataError(DataCode::file_unreadable, p.name, "", "a file that cannot be read", "a recording of a crowd");
  char mark[kCrowdMarkSize] = {};
  const bool whole = p.read(mark, sizeof mark);
  if (p.at == 0)
    throw DataError(DataCode::cut_off, p.name, "", "an empty file",
                    "a recording of a crowd, as simulate --record writes it");
  const unsigned version = whole ? crowd_version({mark, sizeof mark}) : 0;
  if (version == 0)
    throw DataError(DataCode::format_syntax, p.name, "byte 0", "another beginning",
                    "\"EXACTVR1\" to \"EXACTVR5\", of a recording of a crowd");
  if (!p.read_block()) p.bytes().refuse("its end within the head");
  p.head = to_head(p.bytes(), version);
  p.sum = checksum(p.block);
  p.row.x.assign(p.head.kind_of.size(), 0);
  p.row.y = p.row.x;
  p.row.body_x.assign(p.head.bodies.size(), 0);
  p.row.body_y = p.row.body_x;
  p.row.kept.resize(p.row.x.size());
}

CrowdRecordingReader::~CrowdRecordingReader() = default;

const CrowdRecordingHead& CrowdRecordingReader::head() const {
  return parts_->head;
}

bool CrowdRecordingReader::is_cut_off() const {
  return parts_->cut_off;
}

bool CrowdRecordingReader::next(CrowdRow& row) {
  Parts& p = *parts_;
  if (p.ended) return false;
  char tag = 0;
  if (!p.read(&tag, 1) || ((tag == kCrowdRow || tag == kCrowdEnd) && !p.read_block())) {
    p.cut_off = p.ended = true;
    return false;
  }
  if (tag == kCrowdEnd) {
    p.check_end();
    p.ended = true;
    return false;
  }
  if (tag != kCrowdRow) p.bytes().refuse("what begins neither a row nor the end");
  CrowdBytes in = p.bytes();
  p.row.step = in.get<std::uint32_t>();
  in.require_in_range(p.head.time_step, p.row.step, "a time");
  for (std::vector<std::int32_t>* column : {&p.row.x, &p.row.y})
    for (std::int32_t& value : *column) {
      const std::int64_t next = value + in.difference();
      in.require(std::abs(next) <= kFarthestRobot, "a position beyond the lattice");
      value = static_cast<std::int32_t>(next);
    }
  for (std::vector<std::int64_t>* column : {&p.row.body_x, &p.row.body_y})
    for (std::int64_t& value : *column) {
      const std::int64_t difference = in.difference();
      in.require(std::abs(difference) <= kFarthestBody && std::abs(value + difference) <= kFarthestBody,
                 "a body beyond the lattice");
      value += difference;
    }
  std::vector<std::uint8_t>& kept = p.row.kept;
  for (std::size_t first = 0; first < kept.size(); first += 8) {
    const auto bits = in.get<std::uint8_t>();
    for (std::size_t k = first; k < std::min(first + 8, kept.size()); ++k) kept[k] = bits >> (k - first) & 1U;
  }
  in.require_end();
  p.sum = chained(p.sum, checksum(p.block));
  ++p.rows;
  row = p.row;
  return true;
}

bool begins_crowd_recording(std::string_view bytes) {
  return crowd_version(bytes.substr(0, kCrowdMarkSize)) > 0;
}

CrowdTable write_crowd_csv(const std::filesystem::path& from, AtomicFile& to) {
  CrowdRecordingReader reader(from);
  const CrowdRecordingHead& head = reader.head();
  to.write(head.ids.empty() ? "step,time,robot,x,y,kept\n" : "step,time,robot,x,y,kept,id\n");
  std::vector<std::string> ends;
  for (const std::string& id : head.ids) ends.push_back("," + csv_quoted(id) + "\n");
  CrowdRow row;
  CrowdTable table;
  GrowingText text;
  for (; reader.next(row); ++table.rows) {
    const std::string time = std::to_string(row.step) + "," + number_text(row.step * head.time_step) + ",";
    for (std::size_t i = 0; i < row.x.size(); ++i) {
      text.clear();
      const geometry::Vec2 place = head.place(row, i);
      text.add(time);
      text.add(std::to_string(i));
      for (const double number : {place.x, place.y}) text.add(','), text.add_number(number);
      text.add(row.kept[i] ? ",1" : ",0");
      text.add(ends.empty() ? std::string_view("\n") : std::string_view(ends[i]));
      to.write(text.view());
    }
  }
  table.cut_off = reader.is_cut_off();
  return table;
}

}  // namespace exactvo::datasets
