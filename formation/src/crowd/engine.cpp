// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/engine.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "crowd/edge_pack.h"
#include "crowd/hard_level.h"
#include "crowd/one_robot.h"
#include "crowd/packs.h"
#include "exactvo/vo/lp/batch.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// A preference beyond it is refused.
constexpr double kFastestPreference = 0x1p20;

void add(StepReport& sum, const StepReport& more) {
  using R = StepReport;
  for (const auto count : {&R::robots, &R::neighbours, &R::relaxed, &R::touching, &R::widened, &R::nudged, &R::edges,
                           &R::bodies, &R::stopped, &R::overlapping, &R::cut_short, &R::reserved})
    sum.*count += more.*count;
}

void add(CrowdPhases& sum, const CrowdPhases& more) {
  using P = CrowdPhases;
  for (const auto phase : {&P::sort, &P::search, &P::edges, &P::lines, &P::solve, &P::finish, &P::hard})
    sum.*phase += more.*phase;
}

}  // namespace

/// Rows of half-planes of a group: those of edges and bodies at rest and of wheels, those of robots, those of bodies
/// that move.
constexpr std::size_t kMostHard = kMostEdges + kMostWheelRows;
constexpr std::size_t kRows = kMostHard + kMostNeighbours + kMostMoving;
constexpr std::size_t kRobotRows = kMostHard * kSlots, kEdgeRows = kMostEdges * kSlots;

/// Buffers of a thread.
template <class T>
struct CrowdScratch {
  PackBuffers found;
  alignas(64) T x[kSlots * kRows], y[kSlots * kRows], c[kSlots * kRows];
  alignas(64) T px[kSlots], py[kSlots], disc[kSlots], vx[kSlots], vy[kSlots], violation[kSlots];
  std::uint8_t status[kSlots];
  Vec2 preferred[kSlots];
  std::int32_t hard[kSlots];    ///< lines that are never relaxed
  std::int32_t moving[kSlots];  ///< lines against bodies that move
  OneRobotBuffers<T> one;
  alignas(64) T edge_x[kEdgeRows], edge_y[kEdgeRows], edge_c[kEdgeRows];  ///< of a group, by number and slot
  alignas(64) T moving_x[kMostMoving * kSlots], moving_y[kMostMoving * kSlots], moving_c[kMostMoving * kSlots];
  HardBuffers hard_level;
  StepReport counts;
  CrowdPhases phases;
};

template <class T>
class CrowdEngine final : public CrowdCore {
 public:
  explicit CrowdEngine(const CrowdOptions& given) : CrowdCore(given) { take_kinds(); }

  void take_kinds() override {
    table_ = kind_table<T>(options, kinds);
    hard_.take_kinds();
    wheels.take_kinds(kinds, options);
    for (auto* column : {&polygon_x_, &polygon_y_, &polygon_c_})
      column->assign(wheels.most_rows() * kinds.size(), column == &polygon_c_ ? kNever : 0.0);
    for (std::size_t kind = 0; kind < kinds.size(); ++kind)
      for (std::size_t k = 0; k < wheels.polygon(kind).size(); ++k) {
        const geometry::HalfPlane& edge = wheels.polygon(kind)[k];
        const std::size_t at = k * kinds.size() + kind;
        polygon_x_[at] = edge.normal.x;
        polygon_y_[at] = edge.normal.y;
        polygon_c_[at] = static_cast<double>(one_.row_offset(edge.offset, kind));
      }
  }

  void set_preferred(const std::vector<Vec2>& by_id) override {
    for (std::size_t i = 0; i < robots.size(); ++i)
      require_preference(by_id[static_cast<std::size_t>(robots.id[i])], i);
    preferred_.resize(2 * by_id.size());
    for (std::size_t i = 0; i < robots.size(); ++i) {
      const auto id = static_cast<std::size_t>(robots.id[i]);
      preferred_[2 * id] = static_cast<T>(by_id[id].x);
      preferred_[2 * id + 1] = static_cast<T>(by_id[id].y);
    }
  }

  void forget_preference(RobotId robot) override {
    const std::size_t at = 2 * static_cast<std::size_t>(robot);
    if (at < preferred_.size()) preferred_[at] = preferred_[at + 1] = T(0);
  }

  std::vector<Vec2> preferred() const override {
    std::vector<Vec2> by_id(preferred_.size() / 2);
    for (std::size_t id = 0; id < by_id.size(); ++id)
      by_id[id] = {static_cast<double>(preferred_[2 * id]), static_cast<double>(preferred_[2 * id + 1])};
    return by_id;
  }

  StepReport decide() override { return decide_as(ranks()); }

  CrowdExplanation explain(std::size_t robot) override {
    if (!decided || steering) {  // not what a step finds out for the next one
      const Array<std::int32_t> hints = robots.hint;
      const CrowdPhases spent = phases;
      decide_as(nullptr);
      robots.hint = hints;
      phases = spent;
    }
    Scratch& s = *scratch_[0];
    const Vec2 preferred = preferred_of(robot, s);
    CrowdExplanation words;
    words.robot = static_cast<RobotId>(robots.id[robot]);
    words.position = position_of(robot);
    words.velocity = velocity_of(robots.mx[robot], robots.my[robot]);
    words.preferred = {static_cast<double>(static_cast<T>(preferred.x)),
                       static_cast<double>(static_cast<T>(preferred.y))};
    const CrowdDecision decision = one_.decide(robot, words.preferred, s.one, &words);
    words.widened = decision.counts.widened > 0;
    words.reserved = decision.motion.reserved;
    words.ways = s.one.capsule_lines.size();
    words.wish = velocity_of(robots.wish_mx[robot], robots.wish_my[robot]);
    words.chosen = velocity_of(robots.next_mx[robot], robots.next_my[robot]);
    words.kept = (robots.next_kept[robot] & Robots::kIsKept) != 0;
    return words;
  }

  std::size_t bytes() const override {
    std::size_t lists = 0;
    for (const NearLists& l : near_lists_) lists += l.bytes();
    return robots.bytes() + wheels.bytes() + preferred_.capacity() * sizeof(T) + lists;
  }

 private:
  using Scratch = CrowdScratch<T>;

  Ranks* ranks() const { return options.ranks; }

  /// `ranks`: null where this process decides for all robots.
  StepReport decide_as(Ranks* ranks) {
    while (scratch_.size() < static_cast<std::size_t>(tasks.threads())) scratch_.push_back(std::make_unique<Scratch>());
    for (const auto& s : scratch_) s->counts = {}, s->phases = {};
    const std::vector<std::size_t> ends = share_ends(robots.size(), ranks ? ranks->size() : 1);
    const std::size_t own = ranks ? static_cast<std::size_t>(ranks->rank()) : 0, begin = own > 0 ? ends[own - 1] : 0;
    lay_out_capsules();
    near_lists_.resize(ranges_of(ends[own] - begin));
    for_own_ranges(begin, ends[own], [&](std::size_t first, std::size_t last, Scratch& s) {
      decide_range(first, last, near_lists_of(first - begin, ends[own] - begin), s);
    });
    share(ranks, ends, {&robots.wish_mx, &robots.wish_my, &robots.hint});
    if (options.certified) {
      certify(begin, ends[own], 0, robots.safe_mx, robots.safe_my);
      share(ranks, ends, {&robots.safe_mx, &robots.safe_my});
      certify(begin, ends[own], 1, robots.next_mx, robots.next_my);
    } else {
      robots.next_mx = robots.wish_mx;
      robots.next_my = robots.wish_my;
    }
    StepReport report;
    for (const auto& s : scratch_) add(report, s->counts), add(phases, s->phases);
    share(ranks, ends, {&robots.next_mx, &robots.next_my});
    if (ranks) share_report(*ranks, ends, report);
    decided = true;
    return report;
  }

  /// Robots a range of this many.
  std::size_t grain_of(std::size_t count) const {
    const std::size_t share = count / (8 * static_cast<std::size_t>(tasks.threads()));
    return range > 0 ? range : std::clamp<std::size_t>(share, 256, 4096);
  }
  std::size_t ranges_of(std::size_t count) const { return (count + grain_of(count) - 1) / grain_of(count); }
  /// The lists of the range that begins `before` robots after the first of `count`.
  NearLists& near_lists_of(std::size_t before, std::size_t count) { return near_lists_[before / grain_of(count)]; }

  template <class Do>
  void for_own_ranges(std::size_t begin, std::size_t end, const Do& what) {
    tasks.for_ranges(end - begin, grain_of(end - begin), [&](std::size_t first, std::size_t last, int thread) {
      what(begin + first, begin + last, *scratch_[static_cast<std::size_t>(thread)]);
    });
  }

  /// A round of the second level.
  void certify(std::size_t begin, std::size_t end, int round, Array<std::int32_t>& to_x, Array<std::int32_t>& to_y) {
    for_own_ranges(begin, end, [&](std::size_t first, std::size_t last, Scratch& s) {
      const Timed timed(options.time_phases, s.phases.hard);
      NearLists& lists = near_lists_of(first - begin, end - begin);
      hard_.decide(first, last, round, lists, s.hard_level, s.one, s.counts, robots, to_x.data(), to_y.data());
    });
  }

  void lay_out_capsules() {
    if (reserved_ways.empty()) return;
    std::vector<ReservedWays::Capsule> capsules;
    for (std::size_t i = 0; i < robots.size(); ++i)
      if (reserved_ways.holds(robots.id[i]))
        capsules.push_back({{position_of(i), reserved_ways.place(robots.id[i])}, kinds[robots.kind(i)].radius});
    reserved_ways.lay_out(std::move(capsules));
  }

  /// What each rank decided for its share, to all of them.
  static void share(Ranks* ranks, const std::vector<std::size_t>& ends,
                    std::initializer_list<Array<std::int32_t>*> columns) {
    if (!ranks) return;
    std::vector<SharedArray> arrays;
    for (auto* column : columns) arrays.push_back({column->data(), in_bytes(ends, sizeof(std::int32_t))});
    ranks->share(arrays);
  }

  void share_report(Ranks& ranks, const std::vector<std::size_t>& ends, StepReport& report) {
    std::vector<StepReport> reports(ends.size());
    reports[static_cast<std::size_t>(ranks.rank())] = report;
    ranks.share({{robots.next_kept.data(), ends},
                 {reports.data(), in_bytes(share_ends(ends.size(), ranks.size()), sizeof(StepReport))}});
    report = {};
    for (const StepReport& r : reports) add(report, r);
  }

  void require_preference(Vec2 v, std::size_t robot) const {
    if (geometry::is_finite(v) && std::max(std::fabs(v.x), std::fabs(v.y)) < kFastestPreference) return;
    const bool finite = geometry::is_finite(v);
    throw CrowdError(finite ? CrowdProblem::out_of_range : CrowdProblem::not_finite,
                     "preferred velocity of robot " + std::to_string(robots.id[robot]) + ": found (" +
                         std::to_string(v.x) + ", " + std::to_string(v.y) + "), expected numbers below 2^20 m/s");
  }

  /// What set_preferred was told, nothing: 0.
  Vec2 told(std::size_t robot) const {
    const std::size_t at = 2 * static_cast<std::size_t>(robots.id[robot]);
    if (at >= preferred_.size()) return {};
    return {static_cast<double>(preferred_[at]), static_cast<double>(preferred_[at + 1])};
  }

  Vec2 preferred_of(std::size_t robot, Scratch& s) const {
    if (!steering) return told(robot);
    ask_steering(robot, robot + 1, s);
    return s.preferred[0];
  }

  /// Into s.preferred, from `first` on.
  void ask_steering(std::size_t first, std::size_t last, Scratch& s) const {
    const std::size_t count = last - first;
    std::fill(s.preferred, s.preferred + count, Vec2{});
    CrowdSlice slice;
    slice.count_ = count;
    slice.id_ = robots.id.data() + first;
    slice.x_ = robots.x.data() + first;
    slice.y_ = robots.y.data() + first;
    slice.mx_ = robots.mx.data() + first;
    slice.my_ = robots.my.data() + first;
    slice.tag_ = robots.tag.data() + first;
    slice.step_ = options.position_step;
    slice.time_step_ = options.time_step;
    slice.preferred_ = s.preferred;
    steering(slice);
    for (std::size_t k = 0; k < count; ++k) require_preference(s.preferred[k], first + k);
  }

  /// Into s.px, s.py, s.disc, by slot; 0 of lanes without a robot.
  void put_preferred(const Pack* packs, std::size_t count, Scratch& s) const {
    if (steering) ask_steering(packs[0].begin, packs[count - 1].end, s);
    for (std::size_t p = 0; p < count; ++p) {
      const std::size_t slot = p * kPack, begin = packs[p].begin, size = packs[p].size();
      for (std::size_t lane = 0; lane < size; ++lane) {
        const Vec2 v = steering ? s.preferred[begin - packs[0].begin + lane] : told(begin + lane);
        s.px[slot + lane] = static_cast<T>(v.x);
        s.py[slot + lane] = static_cast<T>(v.y);
      }
      for (std::size_t lane = size; lane < kPack; ++lane) s.px[slot + lane] = s.py[slot + lane] = T(0);
      put_by_kind(packs[p], table_.disc, T(1), s.disc + slot);
    }
  }

  /// Puts into each lane the table's value for its kind; `otherwise` into lanes without a robot.
  template <class Value>
  void put_by_kind(const Pack& pack, const std::vector<Value>& table, Value otherwise, Value* by_lane) const {
    std::fill(by_lane, by_lane + kPack, table[0]);
    for (std::size_t lane = 0; table_.is_mixed() && lane < pack.size(); ++lane)
      by_lane[lane] = table[robots.kind(pack.begin + lane)];
    for (std::size_t lane = pack.size(); lane < kPack; ++lane) by_lane[lane] = otherwise;
  }

  // --- Packs ---

  void decide_range(std::size_t first, std::size_t last, NearLists& lists, Scratch& s) {
    Pack packs[kGroupPacks];
    lists.clear();
    for (std::size_t b = first; b < last;) {
      std::size_t count = 0;
      for (; b < last && count < kGroupPacks; b = packs[count++].end) {
        find(b, last, packs[count], s);
        if (options.certified) list_near(packs[count], s, lists);
        lines_of(packs[count], count * kPack, s);
      }
      put_preferred(packs, count, s);
      const std::size_t hard = hard_of(packs, count, s);
      const std::size_t ranks = level_ranks(packs, count, s);
      const std::size_t lines = hard + ranks + moving_of(count, kRobotRows + ranks * kSlots, s);
      solve(count, hard, lines, s);
      finish(packs, count, hard, lines, s);
    }
    s.counts.robots += last - first;
  }

  void find(std::size_t begin, std::size_t last, Pack& pack, Scratch& s) {
    const Timed timed(options.time_phases, s.phases.search);
    find_pack(robots, table_, begin, last, pack, s.found);
    wheels.fetch(robots, pack.begin, pack.end);
  }

  /// The robots that stand so near to those of a pack that the second level looks at the pair.
  void list_near(const Pack& pack, Scratch& s, NearLists& lists) const {
    const Timed timed(options.time_phases, s.phases.hard);
    alignas(64) float meeting[kPack] = {};
    alignas(64) std::int32_t most[kPack];
    put_by_kind(pack, table_.meeting, 0.0F, meeting);
    put_by_kind(pack, table_.neighbours, 0, most);
    std::uint32_t unknown = 0;
    const auto look_at_lanes = [&](std::size_t count, std::uint32_t bits) {
      for (std::size_t lane = 0; lane < count; ++lane)
        if (!pack.is_searched() || most[lane] == 0 || meeting[lane] > s.found.limits.none[lane])
          unknown |= bits << lane;
    };
    table_.is_mixed() ? look_at_lanes(pack.size(), 1U) : look_at_lanes(1, pack.lanes());
    for (std::uint32_t lanes = unknown; lanes != 0; lanes &= lanes - 1) meeting[__builtin_ctz(lanes)] = 0.0F;
    lists.add(pack.begin, pack.size(), s.found.others, s.found.ranked, meeting, most, unknown);
  }

  void lines_of(Pack& pack, std::size_t slot, Scratch& s) {
    const Timed timed(options.time_phases, s.phases.lines);
    LineQuery query;
    query.others = &s.found.others;
    query.ranked = &s.found.ranked;
    query.none = s.found.limits.none;
    query.end_rank = pack.ranks + 1;
    query.x = &robots.x[pack.begin];
    query.y = &robots.y[pack.begin];
    query.mx = &robots.mx[pack.begin];
    query.my = &robots.my[pack.begin];
    query.kind = s.found.limits.kind;
    const std::size_t at = kRobotRows + slot;
    const LineFlags flags = make_lines(table_, query, LineRows<T>{s.x + at, s.y + at, s.c + at, kSlots});
    const std::uint32_t lanes = pack.lanes();
    pack.alone |= flags.coincident & lanes;
    pack.touching = flags.touching & lanes & ~pack.alone;
    s.counts.touching += static_cast<std::size_t>(__builtin_popcount(pack.touching));
    s.counts.neighbours += static_cast<std::size_t>(s.found.finds.neighbours);
    for (std::uint32_t alone = pack.alone; alone != 0; alone &= alone - 1)
      s.counts.neighbours -= static_cast<std::size_t>(pack.neighbours[__builtin_ctz(alone)]);
  }

  // --- Edges ---

  static std::size_t most_of(const std::int32_t* counts, std::size_t packs) {
    return static_cast<std::size_t>(*std::max_element(counts, counts + packs * kPack));
  }

  /// Into the rows at `first` and after; slots with fewer lines get some that hold everywhere.
  static void put_rows(const LineRows<T>& from, const std::int32_t* counts, std::size_t rows, std::size_t first,
                       std::size_t packs, Scratch& s) {
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t to = first + k * kSlots, row = k * from.stride;
      for (std::size_t slot = 0; slot < packs * kPack; ++slot) {
        const bool there = static_cast<std::int32_t>(k) < counts[slot];
        s.x[to + slot] = there ? from.x[row + slot] : T(1);
        s.y[to + slot] = there ? from.y[row + slot] : T(0);
        s.c[to + slot] = there ? from.c[row + slot] : static_cast<T>(kNever);
      }
    }
  }

  /// The half-planes of a group against edges and bodies at rest, then those of wheels, in the last rows before those
  /// of robots; how many rows.
  std::size_t hard_of(Pack* packs, std::size_t count, Scratch& s) {
    const bool has_obstacles = !edges.empty() || one_.has_bodies();
    if (!has_obstacles && wheels.empty()) return 0;
    const Timed timed(options.time_phases, s.phases.edges);
    const std::size_t of_wheels = wheels.most_rows();
    std::fill(s.hard, s.hard + count * kPack, 0);
    if (!edges.empty())
      for (std::size_t p = 0; p < count; ++p) edges_of_pack(packs[p], p * kPack, s);
    if (one_.has_bodies())
      for (std::size_t p = 0; p < count; ++p)
        for (std::size_t lane = 0; lane < kPack; ++lane) bodies_of_lane(packs[p], lane, p * kPack + lane, s);
    const std::size_t rows = has_obstacles ? most_of(s.hard, count) : 0;
    const std::size_t first = kRobotRows - (rows + of_wheels) * kSlots;
    put_rows({s.edge_x, s.edge_y, s.edge_c, kSlots}, s.hard, rows, first, count, s);
    if (of_wheels == 0) return rows;
    for (std::size_t p = 0; p < count; ++p) put_wheels(packs[p], first + rows * kSlots + p * kPack, s);
    std::fill(s.hard, s.hard + count * kPack, static_cast<std::int32_t>(rows + of_wheels));
    return rows + of_wheels;
  }

  void put_wheels(const Pack& pack, std::size_t at, Scratch& s) const {
    alignas(64) double ahead_x[kPack], ahead_y[kPack];
    alignas(64) std::int32_t kind[kPack];
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      const std::size_t robot = pack.begin + std::min(lane, pack.size() - 1), its = robots.kind(robot);
      const Vec2 ahead = wheels.has(its) ? wheels.state(robots.id[robot]).ahead : Vec2{1.0, 0.0};
      ahead_x[lane] = ahead.x;
      ahead_y[lane] = ahead.y;
      kind[lane] = static_cast<std::int32_t>(its);
    }
    put_polygons({wheels.most_rows(), kinds.size(), polygon_x_.data(), polygon_y_.data(), polygon_c_.data(), ahead_x,
                  ahead_y, kind},
                 LineRows<T>{s.x + at, s.y + at, s.c + at, kSlots});
  }

  /// Into s.edge_x and so on, their number into s.hard.
  void edges_of_pack(Pack& pack, std::size_t slot, Scratch& s) {
    std::int32_t* const lines = s.hard + slot;
    if (!ask_edges(pack, s)) return;
    const EdgePackLines<T> out{s.edge_x + slot, s.edge_y + slot, s.edge_c + slot, kSlots, lines};
    const std::uint32_t overflow = make_edge_lines(s.one.edge_query, s.one.edge_table, out);
    for (std::size_t lane = 0; lane < pack.size(); ++lane) {
      if (overflow >> lane & 1U) be_alone(pack, lane, s);
      s.counts.edges += static_cast<std::size_t>(lines[lane]);
    }
  }

  /// Behind the lines of its edges in s.edge_x and so on, those of bodies that move into s.moving_x and so on.
  void bodies_of_lane(Pack& pack, std::size_t lane, std::size_t slot, Scratch& s) const {
    s.moving[slot] = 0;
    if (lane >= pack.size() || (pack.alone >> lane & 1U)) return;
    const std::size_t robot = pack.begin + lane;
    one_.lines_of_bodies(robot, s.one);
    const auto hard = static_cast<std::size_t>(s.hard[slot]), moving = s.one.body_lines.size() - s.one.still;
    if (hard + s.one.still > kMostEdges || moving > kMostMoving) {
      s.counts.edges -= hard;
      s.hard[slot] = 0;
      return be_alone(pack, lane, s);
    }
    for (std::size_t k = 0; k < s.one.still; ++k) {
      const std::size_t to = (hard + k) * kSlots + slot;
      one_.put(s.one.body_lines[k], robot, s.edge_x[to], s.edge_y[to], s.edge_c[to]);
    }
    for (std::size_t k = 0; k < moving; ++k) {
      const std::size_t to = k * kSlots + slot;
      one_.put(s.one.body_lines[s.one.still + k], robot, s.moving_x[to], s.moving_y[to], s.moving_c[to]);
    }
    s.hard[slot] += static_cast<std::int32_t>(s.one.still);
    s.moving[slot] = static_cast<std::int32_t>(moving);
    s.counts.bodies += s.one.body_lines.size() - s.one.capsule_lines.size();
  }

  /// The half-planes of a group against bodies that move, in the rows from `first` on; how many rows.
  std::size_t moving_of(std::size_t count, std::size_t first, Scratch& s) const {
    if (!one_.has_bodies()) return 0;
    const std::size_t rows = most_of(s.moving, count);
    put_rows({s.moving_x, s.moving_y, s.moving_c, kSlots}, s.moving, rows, first, count, s);
    return rows;
  }

  /// Writes s.one.edge_query; whether a lane has edges nearby.
  bool ask_edges(const Pack& pack, Scratch& s) const {
    EdgePackQuery<T>& query = s.one.edge_query;
    std::int32_t any = 0;
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      query.count[lane] = 0;
      if (lane < pack.size() && !(pack.alone >> lane & 1U)) one_.ask_edges(pack.begin + lane, lane, query);
      any |= query.count[lane];
    }
    return any != 0;
  }

  /// Takes a robot out of its pack, and what was counted of it.
  void be_alone(Pack& pack, std::size_t lane, Scratch& s) const {
    pack.alone |= 1U << lane;
    s.counts.neighbours -= static_cast<std::size_t>(pack.neighbours[lane]);
    s.counts.touching -= pack.touching >> lane & 1U;
  }

  /// The ranks that a pack of the group has; those of the others are filled up.
  std::size_t level_ranks(const Pack* packs, std::size_t count, Scratch& s) const {
    int most = 0;
    for (std::size_t p = 0; p < count; ++p) most = std::max(most, packs[p].ranks);
    for (std::size_t p = 0; p < count; ++p)
      for (int r = packs[p].ranks; r < most; ++r) {
        const std::size_t at = kRobotRows + static_cast<std::size_t>(r) * kSlots + p * kPack;
        std::fill(s.x + at, s.x + at + kPack, T(1));
        std::fill(s.y + at, s.y + at + kPack, T(0));
        std::fill(s.c + at, s.c + at + kPack, static_cast<T>(kNever));
      }
    return static_cast<std::size_t>(most);
  }

  void solve(std::size_t count, std::size_t hard, std::size_t lines, Scratch& s) const {
    const Timed timed(options.time_phases, s.phases.solve);
    lp::BatchProblems<T> in;
    in.count = count * kPack;
    in.lines = lines;
    in.block = kSlots;
    const std::size_t first = kRobotRows - hard * kSlots;
    in.normal_x = s.x + first;
    in.normal_y = s.y + first;
    in.offset = s.c + first;
    in.hard = hard > 0 ? s.hard : nullptr;
    in.preferred_x = s.px;
    in.preferred_y = s.py;
    in.disc = s.disc;
    lp::solve_batch(in, answers(s), 0, in.count);
  }

  static lp::BatchAnswers<T> answers(Scratch& s) {
    lp::BatchAnswers<T> out;
    out.velocity_x = s.vx;
    out.velocity_y = s.vy;
    out.violation = s.violation;
    out.status = s.status;
    out.stride = kSlots;
    return out;
  }

  void finish(const Pack* packs, std::size_t count, std::size_t hard, std::size_t lines, Scratch& s) {
    const Timed timed(options.time_phases, s.phases.finish);
    Rounded rounded;
    alignas(64) T allowed[kPack];
    for (std::size_t p = 0; p < count; ++p) {
      const Pack& pack = packs[p];
      const std::size_t slot = p * kPack, at = kRobotRows - hard * kSlots + slot;
      put_by_kind(pack, table_.allowed, T(0), allowed);
      const Answers<T> in{s.vx + slot, s.vy + slot, s.x + at,        s.y + at, s.c + at,
                          lines,       kSlots,      s.status + slot, allowed};
      const std::uint32_t reserved = reserved_lanes(pack);
      const std::uint32_t kept =
          round_to_lattice(table_, in, rounded) & ~pack.alone & ~reserved & driven(pack, rounded);
      take_all(pack, rounded, kept);
      for (std::uint32_t rest = pack.lanes() & ~kept; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(__builtin_ctz(rest));
        const std::size_t robot = pack.begin + lane;
        if (pack.alone >> lane & 1U) {
          const Vec2 preferred{static_cast<double>(s.px[slot + lane]), static_cast<double>(s.py[slot + lane])};
          take(robot, one_.decide(robot, preferred, s.one, nullptr), s);
          continue;
        }
        if (reserved >> lane & 1U) {
          const Vec2 preferred{static_cast<double>(s.px[slot + lane]), static_cast<double>(s.py[slot + lane])};
          const auto own = static_cast<std::size_t>(hard > 0 ? s.hard[slot + lane] : 0);
          take(robot, one_.straight(robot, preferred, offset(in, lane), own), s);
          continue;
        }
        if (hard == 0 && s.status[slot + lane] != 0) {  // relaxed: there is nothing to try
          ++s.counts.relaxed;
          continue;
        }
        const CrowdMotion m{rounded.mx[lane], rounded.my[lane], false};
        take(robot, one_.settled(robot, offset(in, lane), s.status[slot + lane], hard > 0 ? s.hard[slot + lane] : 0, m),
             s);
      }
    }
  }

  /// Bit `lane`: its wheels allow the motion.
  std::uint32_t driven(const Pack& pack, const Rounded& motions) const {
    if (wheels.empty()) return pack.lanes();
    return pack.lanes() & wheels.allow(robots, pack.begin, pack.size(), motions.mx, motions.my);
  }

  /// Bit `lane`: drives straight to a reserved place.
  std::uint32_t reserved_lanes(const Pack& pack) const {
    std::uint32_t lanes = 0;
    for (std::size_t lane = 0; !reserved_ways.empty() && lane < pack.size(); ++lane)
      lanes |= std::uint32_t{reserved_ways.holds(robots.id[pack.begin + lane])} << lane;
    return lanes;
  }

  /// The motions of a pack. Bits of `kept`: lanes.
  void take_all(const Pack& pack, const Rounded& motions, std::uint32_t kept) {
    const std::size_t size = pack.size();
    std::memcpy(&robots.wish_mx[pack.begin], motions.mx, size * sizeof(std::int32_t));
    std::memcpy(&robots.wish_my[pack.begin], motions.my, size * sizeof(std::int32_t));
    for (std::size_t lane = 0; lane < size; ++lane)
      robots.next_kept[pack.begin + lane] = static_cast<std::uint8_t>(kept >> lane & 1U);
  }

  void take(std::size_t robot, const CrowdMotion& m, Scratch& s) {
    robots.wish_mx[robot] = m.mx;
    robots.wish_my[robot] = m.my;
    robots.next_kept[robot] = m.kept;
    s.counts.relaxed += !m.kept && !m.reserved;
    s.counts.reserved += m.reserved;
    s.counts.nudged += m.nudged;
    s.counts.stopped += m.stopped;
  }

  void take(std::size_t robot, const CrowdDecision& d, Scratch& s) {
    take(robot, d.motion, s);
    robots.hint[robot] = d.hint;
    add(s.counts, d.counts);
  }

  static Answers<T> offset(Answers<T> a, std::size_t lane) {
    a.vx += lane, a.vy += lane, a.x += lane, a.y += lane, a.c += lane;
    return a;
  }

  KindTable<T> table_;
  const OneRobot<T> one_{*this, table_};
  HardLevel<T> hard_{*this, table_, one_};
  Array<T> preferred_;
  std::vector<double> polygon_x_, polygon_y_, polygon_c_;  ///< m/s, of edge and kind, offsets as rows have them
  std::vector<NearLists> near_lists_;                      ///< of each range of robots
  std::vector<std::unique_ptr<Scratch>> scratch_;
};

std::unique_ptr<CrowdCore> make_core(const CrowdOptions& options) {
  if (options.precision == CrowdPrecision::float_lines) return std::make_unique<CrowdEngine<float>>(options);
  return std::make_unique<CrowdEngine<double>>(options);
}

}  // namespace exactvo::formation
