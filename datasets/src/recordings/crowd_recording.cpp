// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/crowd_recording.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string_view>
#include <tuple>

#include "exactvo/geometry/require.h"
#include "exactvo/geometry/shape_numbers.h"

namespace exactvo::datasets {
namespace {

/// Of recordings without bodies, and with.
constexpr std::string_view kMark = "EXACTVR1", kMarkOfBodies = "EXACTVR2";
constexpr char kRow = 'R', kEnd = 'E';
constexpr std::uint32_t kMostKinds = 1U << 14U, kMostRobots = 1U << 30U, kMostEdges = 1U << 24U;
constexpr std::size_t kLongestName = 1000;
constexpr std::int64_t kFarthestBody = std::int64_t{1} << 52;

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash;
}

template <class T>
void append(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

/// Zigzag, seven bits a byte, the lowest first.
void append_difference(std::string& to, std::int64_t difference) {
  auto left = (static_cast<std::uint64_t>(difference) << 1U) ^ static_cast<std::uint64_t>(difference >> 63);
  for (; left >= 0x80; left >>= 7U) to.push_back(static_cast<char>(left | 0x80U));
  to.push_back(static_cast<char>(left));
}

/// Bytes of a row or head that has been checked.
class Bytes {
 public:
  Bytes(std::string_view left, const std::string& file, std::uint64_t at) : left_(left), file_(file), at_(at) {}

  template <class T>
  T get() {
    need(sizeof(T));
    T value{};
    std::memcpy(&value, left_.data(), sizeof value);
    skip(sizeof value);
    return value;
  }
  std::string text(std::size_t size) {
    need(size);
    std::string out(left_.substr(0, size));
    skip(size);
    return out;
  }
  std::int64_t difference() {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = get<std::uint8_t>();
      if (shift >= 63) refuse("a number of more than nine bytes");
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80) break;
    }
    return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
  }
  void require_end() const {
    if (!left_.empty()) refuse("more bytes than it needs");
  }
  void require(bool holds, const char* found) const {
    if (!holds) refuse(found);
  }
  [[noreturn]] void refuse(const std::string& found) const {
    throw DataError(DataCode::format_syntax, file_, "byte " + std::to_string(at_), found,
                    "what simulate --record has written");
  }

 private:
  void need(std::size_t size) const {
    if (left_.size() < size) refuse("its end too early");
  }
  void skip(std::size_t size) {
    left_.remove_prefix(size);
    at_ += size;
  }

  std::string_view left_;
  const std::string& file_;
  std::uint64_t at_;
};

CrowdBodyRecord get_body(Bytes& in) {
  CrowdBodyRecord body;
  const auto moves = in.get<std::uint8_t>(), kind = in.get<std::uint8_t>();
  const auto count = in.get<std::uint32_t>();
  in.require(moves <= 1, "a body that neither moves nor rests");
  std::vector<double> v;
  for (std::uint32_t k = 0; k < count; ++k) {
    v.push_back(in.get<double>());
    in.require(std::isfinite(v.back()), "a body that is nowhere");
  }
  const std::optional<geometry::ConvexShape> shape = geometry::shape_of(kind, v);
  in.require(shape && geometry::is_valid(*shape), "a body of no shape");
  body.moves = moves == 1;
  body.shape = *shape;
  return body;
}

std::string to_bytes(const CrowdRecordingHead& head) {
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
  if (head.bodies.empty()) return out;
  append(out, static_cast<std::uint32_t>(head.bodies.size()));
  for (const CrowdBodyRecord& body : head.bodies) {
    append(out, static_cast<std::uint8_t>(body.moves));
    append(out, static_cast<std::uint8_t>(body.shape.index()));
    const std::vector<double> numbers = geometry::numbers_of(body.shape);
    append(out, static_cast<std::uint32_t>(numbers.size()));
    for (const double v : numbers) append(out, v);
  }
  return out;
}

/// Of all blocks so far, and of one more.
std::uint64_t chained(std::uint64_t sum, std::uint64_t next) {
  std::string both;
  append(both, sum);
  append(both, next);
  return checksum(both);
}

bool is_positive(double v) {
  return std::isfinite(v) && v > 0.0;
}

CrowdRecordingHead to_head(Bytes in, bool has_bodies) {
  CrowdRecordingHead head;
  const auto length = in.get<std::uint32_t>();
  in.require(length <= kLongestName, "a name of more than 1000 bytes");
  head.scenario = in.text(length);
  head.time_step = in.get<double>();
  head.position_step = in.get<double>();
  in.require(is_positive(head.time_step) && is_positive(head.position_step), "a step that is not positive");
  head.every = in.get<std::uint32_t>();
  in.require(head.every > 0, "a row every 0 steps");
  const auto kinds = in.get<std::uint32_t>();
  in.require(kinds <= kMostKinds, "more than 2^14 kinds");
  for (std::uint32_t k = 0; k < kinds; ++k) {
    const auto radius = in.get<double>(), speed = in.get<double>();
    in.require(is_positive(radius) && is_positive(speed), "a kind that no crowd has");
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
    for (double& number : v) {
      number = in.get<double>();
      in.require(std::isfinite(number), "an edge that is nowhere");
    }
    head.edges.push_back({{v[0], v[1]}, {v[2], v[3]}});
  }
  if (has_bodies) {
    const auto bodies = in.get<std::uint32_t>();
    in.require(bodies <= kMostEdges, "more than 2^24 bodies");
    for (std::uint32_t k = 0; k < bodies; ++k) head.bodies.push_back(get_body(in));
  }
  in.require_end();
  return head;
}

}  // namespace

CrowdRecorder::CrowdRecorder(const std::filesystem::path& path, const formation::Scenario& scenario,
                             std::uint32_t every, Unfinished unfinished)
    : file_(path, MissingFolder::is_made, unfinished) {
  EXACTVO_REQUIRE(every > 0, "every 0");
  head_.scenario = scenario.name;
  head_.every = every;
  for (const formation::SceneObstacle& o : scenario.obstacles) {
    const std::vector<geometry::Segment> edges = geometry::edges_of(o.shape);
    head_.edges.insert(head_.edges.end(), edges.begin(), edges.end());
  }
}

void CrowdRecorder::put(const std::string& bytes) {
  file_.write(bytes);
  bytes_ += bytes.size();
}

/// Takes the head and what follows from it.
std::string CrowdRecorder::head_of(const formation::Crowd& crowd) {
  head_.time_step = crowd.options().time_step;
  head_.position_step = crowd.options().position_step;
  const std::size_t robots = crowd.id_end();
  std::size_t kinds = 0;
  for (std::size_t i = 0; i < robots; ++i) {
    head_.kind_of.push_back(crowd.kind_of(static_cast<formation::RobotId>(i)));
    kinds = std::max<std::size_t>(kinds, head_.kind_of.back() + 1U);
  }
  for (std::size_t k = 0; k < kinds; ++k) {
    const formation::CrowdKind& kind = crowd.kind(static_cast<formation::KindId>(k));
    head_.kinds.push_back({kind.radius, kind.max_speed});
  }
  for (const formation::CrowdBodyState& body : crowd.bodies()) {
    head_.bodies.push_back({body.shape, body.moves});
    body_ids_.push_back(body.id);
    body_start_.push_back(body.displacement);
  }
  row_.body_x.assign(head_.bodies.size(), 0);
  last_body_x_ = last_body_y_ = row_.body_y = row_.body_x;
  row_.x.assign(robots, 0);
  row_.y.assign(robots, 0);
  last_x_ = last_y_ = row_.x;
  row_.kept.assign(robots, 1);
  const std::string head = to_bytes(head_);
  std::string out(head_.bodies.empty() ? kMark : kMarkOfBodies);
  append(out, static_cast<std::uint64_t>(head.size()));
  head_sum_ = sum_ = checksum(head);
  append(out, sum_);
  return out + head;
}

void CrowdRecorder::begin(const formation::Crowd& crowd) {
  file_.continue_behind(0);
  put(head_of(crowd));
  take(crowd);
  write_row();
}

// What a row is the difference from, and what will be in the next one. The positions of that one come with its step.

void CrowdRecorder::save(std::ostream& to) {
  file_.sync();
  std::string out;
  for (const std::uint64_t number : {head_sum_, bytes_, rows_, sum_, std::uint64_t{row_.step}, std::uint64_t{is_due_}})
    append(out, number);
  for (const geometry::Vec2 start : body_start_) append(out, start);
  for (const auto* all : {&last_x_, &last_y_, &row_.x, &row_.y})
    for (const std::int32_t number : *all) append(out, number);
  for (const auto* all : {&last_body_x_, &last_body_y_, &row_.body_x, &row_.body_y})
    for (const std::int64_t number : *all) append(out, number);
  for (const std::uint8_t kept : row_.kept) append(out, kept);
  to.write(out.data(), static_cast<std::streamsize>(out.size()));
}

void CrowdRecorder::restore(const formation::Crowd& crowd, std::istream& from) {
  head_of(crowd);
  const std::string bytes{std::istreambuf_iterator<char>(from), std::istreambuf_iterator<char>()};
  const std::string name = "a snapshot";
  Bytes in(bytes, name, 0);
  in.require(in.get<std::uint64_t>() == head_sum_, "a recording of something else");
  bytes_ = in.get<std::uint64_t>();
  rows_ = in.get<std::uint64_t>();
  sum_ = in.get<std::uint64_t>();
  row_.step = static_cast<std::uint32_t>(in.get<std::uint64_t>());
  is_due_ = in.get<std::uint64_t>() != 0;
  for (geometry::Vec2& start : body_start_) start = in.get<geometry::Vec2>();
  for (auto* all : {&last_x_, &last_y_, &row_.x, &row_.y})
    for (std::int32_t& number : *all) number = in.get<std::int32_t>();
  for (auto* all : {&last_body_x_, &last_body_y_, &row_.body_x, &row_.body_y})
    for (std::int64_t& number : *all) number = in.get<std::int64_t>();
  for (std::uint8_t& kept : row_.kept) kept = in.get<std::uint8_t>();
  in.require_end();
  file_.continue_behind(bytes_);
}

void CrowdRecorder::take(const formation::Crowd& crowd) {
  crowd.positions(at_);
  for (std::size_t i = 0; i < at_.size(); ++i) {
    row_.x[i] = static_cast<std::int32_t>(at_[i].x / head_.position_step);
    row_.y[i] = static_cast<std::int32_t>(at_[i].y / head_.position_step);
  }
  for (std::size_t k = 0; k < body_ids_.size(); ++k) {
    const geometry::Vec2 at = crowd.body_displacement(body_ids_[k]) - body_start_[k];
    row_.body_x[k] = static_cast<std::int64_t>(at.x / head_.position_step);
    row_.body_y[k] = static_cast<std::int64_t>(at.y / head_.position_step);
  }
}

void CrowdRecorder::add_step(const formation::Crowd& crowd, std::size_t steps) {
  crowd.kept(kept_);
  for (std::size_t i = 0; i < kept_.size(); ++i) row_.kept[i] &= kept_[i];
  row_.step = static_cast<std::uint32_t>(steps);
  take(crowd);
  is_due_ = true;
  if (steps % head_.every == 0) write_row();
}

void CrowdRecorder::write_row() {
  std::string out;
  append(out, row_.step);
  for (auto [now, last] : {std::pair(&row_.x, &last_x_), std::pair(&row_.y, &last_y_)}) {
    for (std::size_t i = 0; i < now->size(); ++i)
      append_difference(out, std::int64_t{(*now)[i]} - std::int64_t{(*last)[i]});
    *last = *now;
  }
  for (auto [now, last] : {std::pair(&row_.body_x, &last_body_x_), std::pair(&row_.body_y, &last_body_y_)}) {
    for (std::size_t k = 0; k < now->size(); ++k) append_difference(out, (*now)[k] - (*last)[k]);
    *last = *now;
  }
  for (std::size_t first = 0; first < row_.kept.size(); first += 8) {
    unsigned bits = 0;
    for (std::size_t k = first; k < std::min(first + 8, row_.kept.size()); ++k)
      bits |= unsigned{row_.kept[k]} << (k - first);
    out.push_back(static_cast<char>(bits));
  }
  std::string before(1, kRow);
  append(before, static_cast<std::uint64_t>(out.size()));
  append(before, checksum(out));
  sum_ = chained(sum_, checksum(out));
  ++rows_;
  put(before);
  put(out);
  row_.kept.assign(row_.kept.size(), 1);
  is_due_ = false;
}

void CrowdRecorder::finish() {
  if (is_due_) write_row();
  std::string seal;
  append(seal, rows_);
  append(seal, sum_);
  std::string end(1, kEnd);
  append(end, static_cast<std::uint64_t>(seal.size()));
  append(end, checksum(seal));
  put(end + seal);
  file_.commit();
}

struct CrowdRecordingReader::Parts {
  std::string name;
  std::ifstream in;
  CrowdRecordingHead head;
  std::vector<std::int32_t> x, y;
  std::vector<std::int64_t> body_x, body_y;
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
    Bytes seal = bytes();
    const auto all_rows = seal.get<std::uint64_t>(), all_sum = seal.get<std::uint64_t>();
    seal.require_end();
    if (all_rows != rows || all_sum != sum) bytes().refuse("an end of other rows than these");
    if (in.peek() != std::ifstream::traits_type::eof()) bytes().refuse("bytes after the end");
  }
  Bytes bytes() const { return {block, name, block_at}; }
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
  char mark[kMark.size()] = {};
  const bool whole = p.read(mark, sizeof mark), has_bodies = std::string_view(mark, sizeof mark) == kMarkOfBodies;
  if (!whole || (!has_bodies && std::string_view(mark, sizeof mark) != kMark))
    throw DataError(DataCode::format_syntax, p.name, "byte 0", "another beginning",
                    "\"EXACTVR1\" or \"EXACTVR2\", of a recording of a crowd");
  if (!p.read_block()) p.bytes().refuse("its end within the head");
  p.head = to_head(p.bytes(), has_bodies);
  p.sum = checksum(p.block);
  p.x.assign(p.head.kind_of.size(), 0);
  p.y = p.x;
  p.body_x.assign(p.head.bodies.size(), 0);
  p.body_y = p.body_x;
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
  if (!p.read(&tag, 1) || ((tag == kRow || tag == kEnd) && !p.read_block())) {
    p.cut_off = p.ended = true;
    return false;
  }
  if (tag == kEnd) {
    p.check_end();
    p.ended = true;
    return false;
  }
  if (tag != kRow) p.bytes().refuse("what begins neither a row nor the end");
  Bytes in = p.bytes();
  row.step = in.get<std::uint32_t>();
  for (std::vector<std::int32_t>* column : {&p.x, &p.y})
    for (std::int32_t& value : *column) {
      const std::int64_t next = value + in.difference();
      in.require(std::abs(next) <= std::int64_t{1} << 30, "a position beyond the lattice");
      value = static_cast<std::int32_t>(next);
    }
  for (std::vector<std::int64_t>* column : {&p.body_x, &p.body_y})
    for (std::int64_t& value : *column) {
      const std::int64_t difference = in.difference();
      in.require(std::abs(difference) <= kFarthestBody && std::abs(value + difference) <= kFarthestBody,
                 "a body beyond the lattice");
      value += difference;
    }
  row.x = p.x;
  row.y = p.y;
  row.body_x = p.body_x;
  row.body_y = p.body_y;
  row.kept.resize(p.x.size());
  for (std::size_t first = 0; first < row.kept.size(); first += 8) {
    const auto bits = in.get<std::uint8_t>();
    for (std::size_t k = first; k < std::min(first + 8, row.kept.size()); ++k) row.kept[k] = bits >> (k - first) & 1U;
  }
  in.require_end();
  p.sum = chained(p.sum, checksum(p.block));
  ++p.rows;
  return true;
}

bool begins_crowd_recording(std::string_view bytes) {
  return bytes.substr(0, kMark.size()) == kMark || bytes.substr(0, kMark.size()) == kMarkOfBodies;
}

CrowdTable write_crowd_csv(const std::filesystem::path& from, AtomicFile& to) {
  CrowdRecordingReader reader(from);
  const CrowdRecordingHead& head = reader.head();
  to.write("step,time,robot,x,y,kept\n");
  CrowdRow row;
  CrowdTable table;
  for (; reader.next(row); ++table.rows) {
    char line[160];
    for (std::size_t i = 0; i < row.x.size(); ++i) {
      const int size =
          std::snprintf(line, sizeof line, "%u,%.17g,%zu,%.17g,%.17g,%u\n", row.step, row.step * head.time_step, i,
                        head.position_step * row.x[i], head.position_step * row.y[i], unsigned{row.kept[i]});
      to.write({line, static_cast<std::size_t>(size)});
    }
  }
  table.cut_off = reader.is_cut_off();
  return table;
}

}  // namespace exactvo::datasets
