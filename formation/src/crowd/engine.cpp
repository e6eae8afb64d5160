// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>

#include "crowd/edge_pack.h"
#include "crowd/search.h"
#include "exactvo/vo/lp/batch.h"

namespace exactvo::formation {

using namespace crowd;

namespace {

/// A preference beyond it is refused.
constexpr double kFastestPreference = 0x1p20;

/// Farther from the optimum no lattice point is tried that keeps all half-planes.
constexpr int kNudge = 3;

/// How much farther than the last neighbour of the step before a search goes at first; how much farther after that.
constexpr double kFirstReach = 1.04, kWiderReach = 1.35;

/// Cutting the number's bits lowers a squared distance by 2^-15 of it at most.
constexpr double kWholeKey = 1.0 - 0x1p-13;

/// Of a squared reach: above what squared distances in float are rounded by.
constexpr double kFarthest = 1.0 + 0x1p-16;

/// Candidates that a pack may look at in vain rather than be cut at the end of its strip.
constexpr std::size_t kWorthCutting = 48;

std::int32_t bits_of(float value) {
  std::int32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

float float_of(std::int32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

Window grown(const Window& w, double by) {
  const auto g = static_cast<std::int64_t>(by) + 2;
  return {w.x0 - g, w.x1 + g, w.y0 - g, w.y1 + g};
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void add(StepReport& sum, const StepReport& more) {
  sum.robots += more.robots;
  sum.neighbours += more.neighbours;
  sum.relaxed += more.relaxed;
  sum.touching += more.touching;
  sum.widened += more.widened;
  sum.nudged += more.nudged;
  sum.edges += more.edges;
  sum.bodies += more.bodies;
  sum.stopped += more.stopped;
}

void add(CrowdPhases& sum, const CrowdPhases& more) {
  sum.sort += more.sort;
  sum.search += more.search;
  sum.edges += more.edges;
  sum.lines += more.lines;
  sum.solve += more.solve;
  sum.finish += more.finish;
}

/// Adds the time it lives to a phase, where phases are timed.
class Timed {
 public:
  Timed(bool on, double& phase) : phase_(on ? &phase : nullptr), start_(on ? seconds() : 0.0) {}
  ~Timed() {
    if (phase_) *phase_ += seconds() - start_;
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  double* phase_;
  double start_;
};

/// A robot near another, by cut squared distance and place in the sorted order.
struct Near {
  float squared;
  std::int32_t robot;
  bool operator<(const Near& o) const { return squared != o.squared ? squared < o.squared : robot < o.robot; }
};

}  // namespace

/// Rows of half-planes of a group: those of edges and bodies at rest, those of robots, those of bodies that move.
constexpr std::size_t kRows = kMostEdges + kMostNeighbours + kMostMoving;
constexpr std::size_t kRobotRows = kMostEdges * kSlots;

/// Buffers of a thread.
template <class T>
struct CrowdScratch {
  Candidates others;
  Ranked ranked;
  alignas(64) T x[kSlots * kRows], y[kSlots * kRows], c[kSlots * kRows];
  alignas(64) T px[kSlots], py[kSlots], disc[kSlots], vx[kSlots], vy[kSlots], violation[kSlots];
  LaneLimits limits;
  LaneFinds finds;
  alignas(64) std::int32_t self[kPack];
  std::uint8_t status[kSlots];
  Vec2 preferred[kSlots];
  std::int32_t hard[kSlots];    ///< lines that are never relaxed
  std::int32_t moving[kSlots];  ///< lines against bodies that move
  std::vector<Near> near;
  std::vector<NearEdge> near_edges;
  std::vector<EdgeLine> edge_lines;
  std::vector<std::uint32_t> near_bodies;
  std::vector<BodyLine> body_lines;
  std::size_t still = 0;  ///< of body_lines: against bodies at rest
  EdgePackQuery<T> edge_query;
  EdgePackTable edge_table;
  alignas(64) T edge_x[kRobotRows], edge_y[kRobotRows], edge_c[kRobotRows];  ///< of a group, by number and slot
  alignas(64) T moving_x[kMostMoving * kSlots], moving_y[kMostMoving * kSlots], moving_c[kMostMoving * kSlots];
  Array<T> rows_x, rows_y, rows_c;
  StepReport counts;
  CrowdPhases phases;
};

template <class T>
class CrowdEngine final : public CrowdCore {
 public:
  explicit CrowdEngine(const CrowdOptions& given) : CrowdCore(given) { take_kinds(); }

  void take_kinds() override {
    table_ = kind_table<T>(options, kinds);
    rule_.position_step = static_cast<T>(options.position_step);
    rule_.velocity_step = static_cast<T>(table_.velocity_step);
    rule_.inverse_step = static_cast<T>(1.0 / table_.velocity_step);
    rule_.inverse_time = static_cast<T>(1.0 / options.time_step);
    rule_.lattice_slack = table_.lattice_slack;
    rule_.certified = options.certified;
    rule_.mixed = kinds.size() > 1;
    rule_.radius = table_.radius.data();
    rule_.inverse_horizon = table_.inverse_horizon.data();
    rule_.least_offset = table_.least_offset.data();
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

  StepReport decide() override {
    while (scratch_.size() < static_cast<std::size_t>(tasks.threads())) scratch_.push_back(std::make_unique<Scratch>());
    for (const auto& s : scratch_) s->counts = {}, s->phases = {};
    const std::vector<std::size_t> ends = share_ends(robots.size(), ranks() ? ranks()->size() : 1);
    const std::size_t own = ranks() ? static_cast<std::size_t>(ranks()->rank()) : 0,
                      begin = own > 0 ? ends[own - 1] : 0;
    const std::size_t count = ends[own] - begin, share = count / (4 * static_cast<std::size_t>(tasks.threads()));
    const std::size_t grain = range > 0 ? range : std::clamp<std::size_t>(share, 256, 4096);
    tasks.for_ranges(count, grain, [&](std::size_t first, std::size_t last, int thread) {
      decide_range(begin + first, begin + last, *scratch_[static_cast<std::size_t>(thread)]);
    });
    StepReport report;
    for (const auto& s : scratch_) add(report, s->counts), add(phases, s->phases);
    if (ranks()) exchange(ends, report);
    return report;
  }

  CrowdExplanation explain(std::size_t robot) override {
    if (scratch_.empty()) scratch_.push_back(std::make_unique<Scratch>());
    Scratch& s = *scratch_[0];
    read_preferred(robot, robot + 1, s);
    CrowdExplanation words;
    words.robot = static_cast<RobotId>(robots.id[robot]);
    words.position = {options.position_step * robots.x[robot], options.position_step * robots.y[robot]};
    words.velocity = velocity_of(robots.mx[robot], robots.my[robot]);
    words.preferred = {static_cast<double>(static_cast<T>(s.preferred[0].x)),
                       static_cast<double>(static_cast<T>(s.preferred[0].y))};
    const Decision d = decide_alone(robot, words.preferred, s, &words);
    words.chosen = velocity_of(d.mx, d.my);
    words.kept = d.kept;
    words.widened = d.widened;
    return words;
  }

  std::size_t bytes() const override { return robots.bytes() + preferred_.capacity() * sizeof(T); }

 private:
  using Scratch = CrowdScratch<T>;

  struct Decision {
    std::int32_t mx, my;
    std::int32_t hint;
    bool kept, nudged, touching, widened, stopped;
    std::size_t neighbours, edges, bodies;
  };

  static constexpr std::int64_t kKeptStretches = 8;

  /// A pack and what its search has found.
  struct Pack {
    std::size_t begin, end;
    Window box;
    double reach;  ///< lattice steps, how far it looks
    Cells cells;
    Stretch stretches[kKeptStretches];  ///< of the first rows of cells
    std::size_t candidates;
    int ranks = 0;               ///< the last at which a lane has somebody
    std::uint32_t alone = 0;     ///< lanes that are decided alone
    std::uint32_t touching = 0;  ///< lanes that touch another robot
    std::uint8_t neighbours[kPack] = {};

    std::size_t size() const { return end - begin; }
  };

  Ranks* ranks() const { return options.ranks; }

  /// What the ranks decided, each for its share, to all of them.
  void exchange(const std::vector<std::size_t>& ends, StepReport& report) {
    std::vector<SharedArray> arrays;
    for (auto* field : {&robots.next_mx, &robots.next_my, &robots.hint})
      arrays.push_back({field->data(), in_bytes(ends, sizeof(std::int32_t))});
    arrays.push_back({robots.next_kept.data(), ends});
    std::vector<StepReport> reports(ends.size());
    reports[static_cast<std::size_t>(ranks()->rank())] = report;
    arrays.push_back({reports.data(), in_bytes(share_ends(ends.size(), ranks()->size()), sizeof(StepReport))});
    ranks()->share(arrays);
    report = {};
    for (const StepReport& r : reports) add(report, r);
  }

  Vec2 velocity_of(std::int32_t mx, std::int32_t my) const {
    return {options.position_step * mx / options.time_step, options.position_step * my / options.time_step};
  }

  std::size_t kind_of(std::size_t robot) const { return robots.tag[robot] & Robots::kKind; }

  void require_preference(Vec2 v, std::size_t robot) const {
    if (geometry::is_finite(v) && std::max(std::fabs(v.x), std::fabs(v.y)) < kFastestPreference) return;
    const bool finite = geometry::is_finite(v);
    throw CrowdError(finite ? CrowdProblem::out_of_range : CrowdProblem::not_finite,
                     "preferred velocity of robot " + std::to_string(robots.id[robot]) + ": found (" +
                         std::to_string(v.x) + ", " + std::to_string(v.y) + "), expected numbers below 2^20 m/s");
  }

  /// Into s.preferred, from `first` on.
  void read_preferred(std::size_t first, std::size_t last, Scratch& s) const {
    const std::size_t count = last - first;
    if (!steering) {
      for (std::size_t k = 0; k < count; ++k) {
        const auto id = 2 * static_cast<std::size_t>(robots.id[first + k]);
        s.preferred[k] = id < preferred_.size()
                             ? Vec2{static_cast<double>(preferred_[id]), static_cast<double>(preferred_[id + 1])}
                             : Vec2{};
      }
      return;
    }
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

  // --- Packs ---

  void decide_range(std::size_t first, std::size_t last, Scratch& s) {
    Pack packs[kGroupPacks];
    for (std::size_t b = first; b < last;) {
      std::size_t count = 0;
      for (; b < last && count < kGroupPacks; b = packs[count++].end) {
        packs[count] = search(b, last, s);
        lines_of(packs[count], count * kPack, s);
      }
      read_preferred(packs[0].begin, b, s);
      const std::size_t hard = obstacles_of(packs, count, s);
      const std::size_t ranks = level_ranks(packs, count, s);
      const std::size_t lines = hard + ranks + moving_of(count, kRobotRows + ranks * kSlots, s);
      solve(packs, count, hard, lines, s);
      finish(packs, count, hard, lines, s);
    }
    s.counts.robots += last - first;
  }

  Window box_of(std::size_t begin, std::size_t end, double& hint) const {
    const std::int32_t *x = robots.x.data(), *y = robots.y.data(), *hints = robots.hint.data();
    std::int32_t x0 = x[begin], x1 = x0, y0 = y[begin], y1 = y0, farthest = 0;
    for (std::size_t i = begin; i < end; ++i) {
      x0 = std::min(x0, x[i]);
      x1 = std::max(x1, x[i]);
      y0 = std::min(y0, y[i]);
      y1 = std::max(y1, y[i]);
      farthest = std::max(farthest, hints[i]);
    }
    hint = farthest;
    return {x0, x1, y0, y1};
  }

  double widest_window(const Pack& pack) const {
    if (!rule_.mixed) return table_.window[0];
    double most = 0.0;
    for (std::size_t i = pack.begin; i < pack.end; ++i) most = std::max(most, table_.window[kind_of(i)]);
    return most;
  }

  void place(Pack& pack, std::size_t end) const {
    double hint = 0.0;
    pack.end = end;
    pack.box = box_of(pack.begin, end, hint);
    pack.reach = std::min(widest_window(pack), kFirstReach * hint + 0.01 / options.position_step);
    look(pack);
  }

  void look(Pack& pack) const {
    pack.cells = robots.cells_of(grown(pack.box, pack.reach));
    pack.candidates = 0;
    for (std::int64_t row = pack.cells.row0; row <= pack.cells.row1; ++row) {
      const Stretch stretch = robots.stretch(pack.cells, row);
      const std::int64_t nth = row - pack.cells.row0;
      if (nth < kKeptStretches) pack.stretches[nth] = stretch;
      pack.candidates += stretch.to - stretch.from;
    }
  }

  /// The robots from b on that are searched for together: fewer than kPack where they have too many candidates.
  Pack first_pack(std::size_t b, std::size_t last) const {
    Pack pack{};
    pack.begin = b;
    place(pack, std::min(b + kPack, last));
    if (pack.candidates <= kWorthCutting) return pack;
    const std::size_t strip_end = robots.strip_end(b);
    if (pack.end > strip_end) {
      Pack cut = pack;
      place(cut, strip_end);
      if (pack.candidates > kMostCandidates || pack.candidates > kWorthCutting + cut.candidates) pack = cut;
    }
    halve(pack);
    return pack;
  }

  /// Until the candidates have room in the table. One robot is decided alone if it comes to that.
  void halve(Pack& pack) const {
    while (pack.candidates > kMostCandidates && pack.size() > 1) place(pack, pack.begin + pack.size() / 2);
  }

  Pack search(std::size_t b, std::size_t last, Scratch& s) {
    const Timed timed(options.time_phases, s.phases.search);
    Pack pack = first_pack(b, last);
    const int ranks = ranks_sought(table_.most_neighbours + 1);
    for (;;) {
      if (pack.candidates > kMostCandidates) return give_up(pack, s);
      load_lanes(pack, s);
      collect(pack, s);
      find_nearest(s.others, &robots.x[pack.begin], &robots.y[pack.begin], s.limits.none, ranks, s.ranked);
      drop_selves(pack, ranks, s);
      const auto seen = static_cast<float>(pack.reach * pack.reach * kWholeKey);
      count_neighbours(s.limits, seen, ranks, rule_.mixed, s.ranked, s.finds);
      if (!somebody_may_be_missing(pack, s)) break;
      pack.reach = std::min(widest_window(pack), pack.reach * kWiderReach);
      look(pack);
      halve(pack);
    }
    read_ranks(pack, s);
    return pack;
  }

  /// One robot among more candidates than the table has room for.
  Pack give_up(Pack pack, Scratch& s) const {
    pack.alone = 1;
    pack.ranks = 0;
    load_lanes(pack, s);
    for (auto& row : s.ranked.key) std::copy(s.limits.none, s.limits.none + kPack, row);
    s.others.count = 0;
    return pack;
  }

  void load_lanes(const Pack& pack, Scratch& s) const {
    LaneLimits& limits = s.limits;
    if (rule_.mixed) {
      for (std::size_t lane = 0; lane < kPack; ++lane)
        limits.kind[lane] = lane < pack.size() ? static_cast<std::int32_t>(kind_of(pack.begin + lane)) : 0;
      for (std::size_t lane = 0; lane < kPack; ++lane) limit(limits, lane, static_cast<std::size_t>(limits.kind[lane]));
    } else {
      std::fill(limits.kind, limits.kind + kPack, 0);
      for (std::size_t lane = 0; lane < kPack; ++lane) limit(limits, lane, 0);
    }
    for (std::size_t lane = pack.size(); lane < kPack; ++lane) limits.none[lane] = 0.0F;
  }

  void limit(LaneLimits& limits, std::size_t lane, std::size_t kind) const {
    limits.none[lane] = table_.none[kind];
    limits.reach[lane] = table_.reach[kind];
    limits.wanted[lane] = table_.neighbours[kind];
    limits.window[lane] = table_.whole_window[kind];
  }

  static void copy(const std::int32_t* from, std::size_t count, std::int32_t* to) {
    for (std::size_t k = 0; k < count; k += kPack) std::memcpy(to + k, from + k, kPack * sizeof *to);
  }

  void collect(const Pack& pack, Scratch& s) const {
    s.others.count = 0;
    for (std::int64_t row = pack.cells.row0; row <= pack.cells.row1; ++row) {
      const std::int64_t nth = row - pack.cells.row0;
      const Stretch stretch = nth < kKeptStretches ? pack.stretches[nth] : robots.stretch(pack.cells, row);
      const bool is_own = stretch.from < pack.end && pack.begin < stretch.to;
      const bool is_outermost = row == pack.cells.row0 || row == pack.cells.row1;
      if (is_outermost && !is_own && !rule_.mixed)
        collect_near(pack, stretch, s);
      else
        collect_all(pack, stretch, s);
    }
  }

  void collect_all(const Pack& pack, const Stretch& stretch, Scratch& s) const {
    const std::size_t count = stretch.to - stretch.from, at = s.others.count;
    copy(robots.x.data() + stretch.from, count, s.others.x + at);
    copy(robots.y.data() + stretch.from, count, s.others.y + at);
    copy(robots.mx.data() + stretch.from, count, s.others.mx + at);
    copy(robots.my.data() + stretch.from, count, s.others.my + at);
    if (rule_.mixed)
      for (std::size_t k = 0; k < count; ++k)
        s.others.kind[at + k] = static_cast<std::int32_t>(kind_of(stretch.from + k));
    const std::size_t first = std::max(pack.begin, stretch.from), last = std::min(pack.end, stretch.to);
    for (std::size_t i = first; i < last; ++i)
      s.self[i - pack.begin] = static_cast<std::int32_t>(at + i - stretch.from);
    s.others.count += count;
  }

  /// Of a strip that reaches beyond the window: those that are not farther from the box in y than the pack looks.
  void collect_near(const Pack& pack, const Stretch& stretch, Scratch& s) const {
    const Window w = grown(pack.box, pack.reach);
    const auto within = [](std::int64_t y) {
      return static_cast<std::int32_t>(std::clamp<std::int64_t>(y, -kLatticeEnd, kLatticeEnd));
    };
    const RobotColumns some{robots.x.data() + stretch.from, robots.y.data() + stretch.from,
                            robots.mx.data() + stretch.from, robots.my.data() + stretch.from};
    add_between(some, stretch.to - stretch.from, within(w.y0), within(w.y1), s.others);
  }

  /// A robot is the first of its own list, unless others stand in its place.
  void drop_selves(const Pack& pack, int ranks, Scratch& s) const {
    std::uint32_t behind = lanes_behind_others(s.ranked, s.self) & lanes_of(pack);
    for (std::size_t lane = 0; behind != 0; ++lane, behind >>= 1U)
      if (behind & 1U) drop_self(lane, ranks, s);
  }

  void drop_self(std::size_t lane, int ranks, Scratch& s) const {
    const std::int32_t none = bits_of(s.limits.none[lane]);
    int at = ranks - 1;  // the last one, where as many others stand in its place
    for (int r = 0; r < ranks; ++r) {
      const std::int32_t key = bits_of(s.ranked.key[r][lane]);
      if (key < none && (key & kIndexBits) == s.self[lane]) at = r;
    }
    for (int r = at; r > 0; --r) s.ranked.key[r][lane] = s.ranked.key[r - 1][lane];
  }

  static std::uint32_t lanes_of(const Pack& pack) { return (1U << pack.size()) - 1U; }

  /// Whether a robot outside the window could be nearer than the last neighbour of a lane.
  bool somebody_may_be_missing(const Pack& pack, const Scratch& s) const {
    std::uint32_t unseen = s.finds.unseen & lanes_of(pack);
    for (std::size_t lane = 0; unseen != 0; ++lane, unseen >>= 1U)
      if ((unseen & 1U) && pack.reach < table_.window[static_cast<std::size_t>(s.limits.kind[lane])]) return true;
    return false;
  }

  std::int32_t hint_of(float key, std::size_t kind) const {
    const double most = table_.window[kind];
    if (!(key < table_.none[kind])) return static_cast<std::int32_t>(std::min(most, 0x1p30));
    const double distance = static_cast<double>(std::sqrt(float_of(bits_of(key) & ~kIndexBits)));
    return static_cast<std::int32_t>(std::min({distance, most, 0x1p30}));
  }

  /// Who has how many, whom the next step will ask how far, and who has more in reach than neighbours.
  void read_ranks(Pack& pack, Scratch& s) {
    std::copy(s.finds.hint, s.finds.hint + pack.size(), robots.hint.data() + pack.begin);
    for (std::size_t lane = 0; lane < kPack; ++lane)
      pack.neighbours[lane] = static_cast<std::uint8_t>(s.finds.have[lane]);
    pack.alone |= s.finds.crowded & lanes_of(pack);
    pack.ranks = s.finds.most;
  }

  void lines_of(Pack& pack, std::size_t slot, Scratch& s) {
    const Timed timed(options.time_phases, s.phases.lines);
    LineQuery query;
    query.others = &s.others;
    query.ranked = &s.ranked;
    query.none = s.limits.none;
    query.end_rank = pack.ranks + 1;
    query.x = &robots.x[pack.begin];
    query.y = &robots.y[pack.begin];
    query.mx = &robots.mx[pack.begin];
    query.my = &robots.my[pack.begin];
    query.kind = s.limits.kind;
    const LineFlags flags = make_lines(rule_, query, robot_rows(s, slot));
    const std::uint32_t lanes = lanes_of(pack);
    pack.alone |= flags.coincident & lanes;
    pack.touching = flags.touching & lanes & ~pack.alone;
    s.counts.touching += static_cast<std::size_t>(__builtin_popcount(pack.touching));
    for (std::size_t lane = 0; lane < pack.size(); ++lane)
      if (!(pack.alone >> lane & 1U)) s.counts.neighbours += pack.neighbours[lane];
  }

  static LineRows<T> robot_rows(Scratch& s, std::size_t slot) {
    const std::size_t at = kRobotRows + slot;
    return {s.x + at, s.y + at, s.c + at, kSlots};
  }

  // --- Edges ---

  /// Into s.edge_lines.
  void lines_of_edges(std::size_t robot, Scratch& s) const {
    const CrowdKind& kind = kinds[kind_of(robot)];
    EdgeQuery query;
    query.position = {options.position_step * robots.x[robot], options.position_step * robots.y[robot]};
    query.velocity = velocity_of(robots.mx[robot], robots.my[robot]);
    query.radius = kind.radius;
    query.horizon = edge_horizon(kind);
    query.max_speed = kind.max_speed;
    query.float_normals = sizeof(T) == 4;
    edge_lines(edges, query, s.near_edges, s.edge_lines);
  }

  /// An EdgeLine or a BodyLine.
  template <class Line>
  void put(const Line& line, T& x, T& y, T& c, T least) const {
    x = static_cast<T>(line.normal.x);
    y = static_cast<T>(line.normal.y);
    c = std::max(least, rounded_up<T>(line.offset + static_cast<double>(table_.lattice_slack)));
  }

  /// Of a group, by number and slot.
  struct GroupLines {
    const T *x, *y, *c;
  };

  static std::size_t most_of(const std::int32_t* counts, std::size_t packs) {
    return static_cast<std::size_t>(*std::max_element(counts, counts + packs * kPack));
  }

  /// Into the rows at `first` and after; slots with fewer lines get some that hold everywhere.
  static void put_rows(const GroupLines& from, const std::int32_t* counts, std::size_t rows, std::size_t first,
                       std::size_t packs, Scratch& s) {
    for (std::size_t k = 0; k < rows; ++k) {
      const std::size_t to = first + k * kSlots, row = k * kSlots;
      for (std::size_t slot = 0; slot < packs * kPack; ++slot) {
        const bool there = static_cast<std::int32_t>(k) < counts[slot];
        s.x[to + slot] = there ? from.x[row + slot] : T(1);
        s.y[to + slot] = there ? from.y[row + slot] : T(0);
        s.c[to + slot] = there ? from.c[row + slot] : static_cast<T>(kNever);
      }
    }
  }

  /// The half-planes of a group against edges and bodies at rest, in the last rows before those of robots; how many
  /// rows.
  std::size_t obstacles_of(Pack* packs, std::size_t count, Scratch& s) {
    if (edges.empty() && bodies.empty()) return 0;
    const Timed timed(options.time_phases, s.phases.edges);
    std::fill(s.hard, s.hard + count * kPack, 0);
    if (!edges.empty())
      for (std::size_t p = 0; p < count; ++p) edges_of_pack(packs[p], p * kPack, s);
    if (!bodies.empty())
      for (std::size_t p = 0; p < count; ++p)
        for (std::size_t lane = 0; lane < kPack; ++lane) bodies_of_lane(packs[p], lane, p * kPack + lane, s);
    const std::size_t rows = most_of(s.hard, count);
    put_rows({s.edge_x, s.edge_y, s.edge_c}, s.hard, rows, kRobotRows - rows * kSlots, count, s);
    return rows;
  }

  /// Into s.edge_x and so on, their number into s.hard.
  void edges_of_pack(Pack& pack, std::size_t slot, Scratch& s) {
    std::int32_t* const lines = s.hard + slot;
    if (!ask_edges(pack, s)) return;
    const EdgePackLines<T> out{s.edge_x + slot, s.edge_y + slot, s.edge_c + slot, kSlots, lines};
    const std::uint32_t overflow = make_edge_lines(s.edge_query, s.edge_table, out);
    for (std::size_t lane = 0; lane < pack.size(); ++lane) {
      if (overflow >> lane & 1U) be_alone(pack, lane, s);
      s.counts.edges += static_cast<std::size_t>(lines[lane]);
    }
  }

  /// Into s.body_lines.
  void lines_of_bodies(std::size_t robot, Scratch& s) const {
    const CrowdKind& kind = kinds[kind_of(robot)];
    BodyQuery query;
    query.x = robots.x[robot];
    query.y = robots.y[robot];
    query.velocity = velocity_of(robots.mx[robot], robots.my[robot]);
    query.radius = kind.radius;
    query.still_horizon = edge_horizon(kind);
    query.horizon = kind.time_horizon;
    query.max_speed = kind.max_speed;
    query.float_normals = sizeof(T) == 4;
    s.still = bodies.lines(query, s.near_bodies, s.body_lines);
  }

  /// Behind the lines of its edges in s.edge_x and so on, those of bodies that move into s.moving_x and so on.
  void bodies_of_lane(Pack& pack, std::size_t lane, std::size_t slot, Scratch& s) const {
    s.moving[slot] = 0;
    if (lane >= pack.size() || (pack.alone >> lane & 1U)) return;
    const std::size_t robot = pack.begin + lane;
    lines_of_bodies(robot, s);
    const auto hard = static_cast<std::size_t>(s.hard[slot]), moving = s.body_lines.size() - s.still;
    if (hard + s.still > kMostEdges || moving > kMostMoving) {
      s.counts.edges -= hard;
      s.hard[slot] = 0;
      return be_alone(pack, lane, s);
    }
    const T least = table_.least_offset[kind_of(robot)];
    for (std::size_t k = 0; k < s.still; ++k) {
      const std::size_t to = (hard + k) * kSlots + slot;
      put(s.body_lines[k], s.edge_x[to], s.edge_y[to], s.edge_c[to], least);
    }
    for (std::size_t k = 0; k < moving; ++k) {
      const std::size_t to = k * kSlots + slot;
      put(s.body_lines[s.still + k], s.moving_x[to], s.moving_y[to], s.moving_c[to], least);
    }
    s.hard[slot] += static_cast<std::int32_t>(s.still);
    s.moving[slot] = static_cast<std::int32_t>(moving);
    s.counts.bodies += s.body_lines.size();
  }

  /// The half-planes of a group against bodies that move, in the rows from `first` on; how many rows.
  std::size_t moving_of(std::size_t count, std::size_t first, Scratch& s) const {
    if (bodies.empty()) return 0;
    const std::size_t rows = most_of(s.moving, count);
    put_rows({s.moving_x, s.moving_y, s.moving_c}, s.moving, rows, first, count, s);
    return rows;
  }

  /// Writes s.edge_query; whether a lane has edges nearby. Whoever has too many for a pack is decided alone.
  bool ask_edges(Pack& pack, Scratch& s) const {
    EdgePackQuery<T>& query = s.edge_query;
    query.edges = edges.edges().data();
    query.items = edges.items().data();
    query.slack = table_.lattice_slack;
    std::uint32_t any = 0;
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      const std::size_t robot = pack.begin + std::min(lane, pack.size() - 1), kind = kind_of(robot);
      const Vec2 velocity = velocity_of(robots.mx[robot], robots.my[robot]);
      query.x[lane] = options.position_step * robots.x[robot];
      query.y[lane] = options.position_step * robots.y[robot];
      query.vx[lane] = velocity.x;
      query.vy[lane] = velocity.y;
      query.radius[lane] = kinds[kind].radius;
      query.horizon[lane] = edge_horizon(kinds[kind]);
      query.max_speed[lane] = kinds[kind].max_speed;
      query.least[lane] = table_.least_offset[kind];
      query.first[lane] = query.count[lane] = 0;
      if (lane >= pack.size() || (pack.alone >> lane & 1U)) continue;
      const EdgeGrid::Range near = edges.near({query.x[lane], query.y[lane]});
      if (near.last - near.first > kMostPackEdges) {
        be_alone(pack, lane, s);
        continue;
      }
      query.first[lane] = static_cast<std::int32_t>(near.first);
      query.count[lane] = static_cast<std::int32_t>(near.last - near.first);
      any |= near.last - near.first;
    }
    return any != 0;
  }

  /// Takes a robot out of its pack, and what was counted of it.
  void be_alone(Pack& pack, std::size_t lane, Scratch& s) const {
    pack.alone |= 1U << lane;
    s.counts.neighbours -= pack.neighbours[lane];
    s.counts.touching -= pack.touching >> lane & 1U;
  }

  /// No velocity may lead onto an edge or a body at rest, also where half-planes against robots had to give: another
  /// place of the lattice nearby, or none. REQUIRES: the first `hard` lines are theirs.
  void keep_off_edges(std::size_t robot, Answers<T> in, std::size_t hard, Decision& d) const {
    if (hard == 0 || !options.certified) return;
    in.lines = hard;
    if (keeps(in, d.mx, d.my, kinds[kind_of(robot)].max_speed) || nudge(robot, in, d.mx, d.my)) return;
    d.mx = d.my = 0;
    d.stopped = true;
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

  void solve(const Pack* packs, std::size_t count, std::size_t hard, std::size_t lines, Scratch& s) const {
    const Timed timed(options.time_phases, s.phases.solve);
    for (std::size_t p = 0; p < count; ++p)
      for (std::size_t lane = 0; lane < kPack; ++lane) {
        const std::size_t slot = p * kPack + lane, robot = packs[p].begin + lane;
        const bool there = lane < packs[p].size();
        const Vec2 v = there ? s.preferred[robot - packs[0].begin] : Vec2{};
        s.px[slot] = static_cast<T>(v.x);
        s.py[slot] = static_cast<T>(v.y);
        s.disc[slot] = there ? table_.disc[rule_.mixed ? kind_of(robot) : 0] : T(1);
      }
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
    Rounded<T> rounded;
    for (std::size_t p = 0; p < count; ++p) {
      const std::size_t slot = p * kPack, at = kRobotRows - hard * kSlots + slot;
      const Answers<T> in{s.vx + slot, s.vy + slot, s.x + at, s.y + at, s.c + at, lines, kSlots};
      round_to_lattice(rule_, in, rounded);
      for (std::size_t lane = 0; lane < packs[p].size(); ++lane) {
        const std::size_t robot = packs[p].begin + lane;
        if (packs[p].alone >> lane & 1U) {
          take(robot, decide_alone(robot, s.preferred[robot - packs[0].begin], s, nullptr), s);
          continue;
        }
        Decision d{};
        d.mx = rounded.mx[lane];
        d.my = rounded.my[lane];
        d.kept = is_kept(rounded.excess[lane], s.status[slot + lane], robot);
        if (!d.kept) settle(robot, offset(in, lane), s.status[slot + lane], hard > 0 ? s.hard[slot + lane] : 0, d);
        robots.next_mx[robot] = d.mx;
        robots.next_my[robot] = d.my;
        robots.next_kept[robot] = d.kept;
        s.counts.relaxed += !d.kept;
        s.counts.nudged += d.nudged;
        s.counts.stopped += d.stopped;
      }
    }
  }

  /// A velocity that, once rounded, does not keep all half-planes.
  void settle(std::size_t robot, const Answers<T>& in, std::uint8_t status, std::int32_t hard, Decision& d) const {
    if (!options.certified) return;
    if (status == 0) d.kept = d.nudged = nudge(robot, in, d.mx, d.my);
    if (!d.kept) keep_off_edges(robot, in, static_cast<std::size_t>(hard), d);
  }

  void take(std::size_t robot, const Decision& d, Scratch& s) {
    robots.next_mx[robot] = d.mx;
    robots.next_my[robot] = d.my;
    robots.next_kept[robot] = d.kept;
    robots.hint[robot] = d.hint;
    s.counts.relaxed += !d.kept;
    s.counts.nudged += d.nudged;
    s.counts.touching += d.touching;
    s.counts.widened += d.widened;
    s.counts.neighbours += d.neighbours;
    s.counts.edges += d.edges;
    s.counts.bodies += d.bodies;
    s.counts.stopped += d.stopped;
  }

  bool is_kept(T excess, std::uint8_t status, std::size_t robot) const {
    if (!options.certified) return status == 0;
    return excess <= table_.allowed[rule_.mixed ? kind_of(robot) : 0];
  }

  static Answers<T> offset(Answers<T> a, std::size_t lane) {
    a.vx += lane, a.vy += lane, a.x += lane, a.y += lane, a.c += lane;
    return a;
  }

  /// Whether a motion keeps all lines. In double, where a line is off by at most 2^-48 V.
  bool keeps(const Answers<T>& in, double mx, double my, double max_speed) const {
    const double unit = table_.velocity_step, allowed = table_.spare - 0x1p-46 * max_speed;
    for (std::size_t k = 0; k < in.lines; ++k) {
      const std::size_t at = k * in.stride;
      const double met = unit * mx * static_cast<double>(in.x[at]) + unit * my * static_cast<double>(in.y[at]);
      if (static_cast<double>(in.c[at]) - met > allowed) return false;
    }
    return true;
  }

  /// The place of the lattice nearest to the answer, among those about, that keeps all lines.
  bool nudge(std::size_t robot, const Answers<T>& in, std::int32_t& mx, std::int32_t& my) const {
    const double speed = kinds[kind_of(robot)].max_speed, unit = table_.velocity_step;
    const double limit = speed * speed * (1.0 - 0x1p-46);
    const double x0 = static_cast<double>(in.vx[0]) / unit, y0 = static_cast<double>(in.vy[0]) / unit;
    double least = std::numeric_limits<double>::infinity();
    const std::int32_t from_x = mx, from_y = my;
    for (int j = -kNudge; j <= kNudge; ++j)
      for (int i = -kNudge; i <= kNudge; ++i) {
        const double x = from_x + i, y = from_y + j, away = (x - x0) * (x - x0) + (y - y0) * (y - y0);
        if (!(away < least) || (x * x + y * y) * unit * unit > limit || !keeps(in, x, y, speed)) continue;
        least = away;
        mx = from_x + i;
        my = from_y + j;
      }
    return least < std::numeric_limits<double>::infinity();
  }

  // --- One robot ---

  /// Everybody nearer than `reach` (lattice steps), and maybe some beyond, by the order of neighbours.
  void everybody_near(std::size_t robot, double reach, std::vector<Near>& near) const {
    const Window at{robots.x[robot], robots.x[robot], robots.y[robot], robots.y[robot]};
    const Cells cells = robots.cells_of(grown(at, reach));
    const auto farthest = static_cast<float>(reach * reach * kFarthest);
    near.clear();
    for (std::int64_t row = cells.row0; row <= cells.row1; ++row) {
      const Stretch stretch = robots.stretch(cells, row);
      for (std::size_t j = stretch.from; j < stretch.to; ++j) {
        if (j == robot) continue;
        const auto dx = static_cast<float>(robots.x[j] - robots.x[robot]),
                   dy = static_cast<float>(robots.y[j] - robots.y[robot]);
        const float squared = without_number(dx * dx + dy * dy);
        if (squared <= farthest) near.push_back({squared, static_cast<std::int32_t>(j)});
      }
    }
    std::sort(near.begin(), near.end());
  }

  /// Its neighbours, nearest first: those of its kind's number, and all that can be met within the step.
  bool gather(std::size_t robot, std::vector<Near>& near, float& last) const {
    const std::size_t kind = kind_of(robot);
    const auto most = static_cast<std::size_t>(table_.neighbours[kind]);
    double reach = std::min(table_.window[kind], kFirstReach * robots.hint[robot] + 0.01 / options.position_step);
    reach = std::max(reach, std::sqrt(static_cast<double>(table_.reach[kind])) * (1.0 + 0x1p-10));
    for (;; reach = std::min(table_.window[kind], reach * kWiderReach)) {
      everybody_near(robot, reach, near);
      const bool full = near.size() >= most && static_cast<double>(near[most - 1].squared) <= reach * reach * kWholeKey;
      if (full || reach >= table_.window[kind]) break;
    }
    last = near.size() >= most ? near[most - 1].squared : table_.none[kind];
    std::size_t count = 0;
    while (count < near.size() && near[count].squared < table_.none[kind] &&
           (count < most || near[count].squared < table_.reach[kind]))
      ++count;
    near.resize(count);
    return count > most || (count == most && last < table_.reach[kind]);
  }

  Decision decide_alone(std::size_t robot, Vec2 preferred, Scratch& s, CrowdExplanation* words) {
    Decision d{};
    float last = 0;
    d.widened = gather(robot, s.near, last);
    d.hint = hint_of(last, kind_of(robot));
    d.neighbours = s.near.size();
    lines_of_edges(robot, s);
    d.edges = s.edge_lines.size();
    s.body_lines.clear();
    s.still = 0;
    if (!bodies.empty()) lines_of_bodies(robot, s);
    d.bodies = s.body_lines.size();
    const std::size_t mandatory = d.edges + s.still, lines = d.edges + d.bodies + d.neighbours,
                      rows = std::max<std::size_t>(1, lines);
    s.rows_x.assign(rows * kPack, T(1));
    s.rows_y.assign(rows * kPack, T(0));
    s.rows_c.assign(rows * kPack, static_cast<T>(kNever));
    for (std::size_t k = 0; k < d.edges; ++k) {
      const EdgeLine& line = s.edge_lines[k];
      const std::size_t to = k * kPack;
      put(line, s.rows_x[to], s.rows_y[to], s.rows_c[to], table_.least_offset[kind_of(robot)]);
      if (!words) continue;
      const geometry::HalfPlane h{line.normal, static_cast<double>(s.rows_c[to]) - table_.spare};
      words->edges.push_back({edges.edges()[line.edge], h, line.touching});
    }
    for (std::size_t k = 0; k < d.bodies; ++k) {
      const BodyLine& line = s.body_lines[k];
      const std::size_t to = (d.edges + k + (k < s.still ? 0 : d.neighbours)) * kPack;
      put(line, s.rows_x[to], s.rows_y[to], s.rows_c[to], table_.least_offset[kind_of(robot)]);
      if (!words) continue;
      const geometry::HalfPlane h{line.normal, static_cast<double>(s.rows_c[to]) - table_.spare};
      words->bodies.push_back({bodies.all()[line.body].id, h, line.touching});
    }
    for (std::size_t k = 0; k < s.near.size(); k += kPack) d.touching |= lines_alone(robot, k, s, words);
    alignas(64) T vx[kPack] = {}, vy[kPack] = {}, violation[kPack] = {}, px[kPack], py[kPack], disc[kPack];
    std::uint8_t status[kPack] = {};
    std::fill(px, px + kPack, static_cast<T>(preferred.x));
    std::fill(py, py + kPack, static_cast<T>(preferred.y));
    std::fill(disc, disc + kPack, table_.disc[kind_of(robot)]);
    lp::BatchProblems<T> in;
    in.count = 1;
    const std::int32_t hard[kPack] = {static_cast<std::int32_t>(mandatory)};
    in.lines = lines;
    in.block = kPack;
    in.hard = mandatory > 0 ? hard : nullptr;
    in.normal_x = s.rows_x.data();
    in.normal_y = s.rows_y.data();
    in.offset = s.rows_c.data();
    in.preferred_x = px;
    in.preferred_y = py;
    in.disc = disc;
    lp::BatchAnswers<T> out;
    out.velocity_x = vx;
    out.velocity_y = vy;
    out.violation = violation;
    out.status = status;
    out.stride = kPack;
    lp::solve_batch(in, out, 0, 1);
    const Answers<T> answer{vx, vy, s.rows_x.data(), s.rows_y.data(), s.rows_c.data(), lines, kPack};
    Rounded<T> rounded;
    round_to_lattice(rule_, answer, rounded);
    d.mx = rounded.mx[0];
    d.my = rounded.my[0];
    d.kept = is_kept(rounded.excess[0], status[0], robot);
    if (!d.kept) settle(robot, answer, status[0], hard[0], d);
    return d;
  }

  /// The lines of neighbours k to k + 15, one per lane; whether one of them touches.
  bool lines_alone(std::size_t robot, std::size_t k, Scratch& s, CrowdExplanation* words) const {
    const std::size_t count = std::min(kPack, s.near.size() - k);
    Candidates others;
    others.count = kPack;
    std::int32_t own[5][kPack];
    alignas(64) float none[kPack];
    Ranked ranked;
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      const auto j = static_cast<std::size_t>(s.near[k + std::min(lane, count - 1)].robot);
      others.x[lane] = robots.x[j];
      others.y[lane] = robots.y[j];
      others.mx[lane] = robots.mx[j];
      others.my[lane] = robots.my[j];
      others.kind[lane] = static_cast<std::int32_t>(kind_of(j));
      own[0][lane] = robots.x[robot];
      own[1][lane] = robots.y[robot];
      own[2][lane] = robots.mx[robot];
      own[3][lane] = robots.my[robot];
      own[4][lane] = static_cast<std::int32_t>(kind_of(robot));
      none[lane] = std::numeric_limits<float>::infinity();
      ranked.key[0][lane] = float_of(static_cast<std::int32_t>(lane));
    }
    const LineQuery query{&others, &ranked, none, 0, 1, own[0], own[1], own[2], own[3], own[4]};
    alignas(64) T x[kPack], y[kPack], c[kPack];
    const LineFlags flags = make_lines(rule_, query, LineRows<T>{x, y, c, kPack});
    for (std::size_t lane = 0; lane < count; ++lane) {
      const auto other = static_cast<std::size_t>(s.near[k + lane].robot);
      if (flags.coincident >> lane & 1U) part(robot, other, x[lane], y[lane], c[lane]);
      const std::size_t to = (s.edge_lines.size() + s.still + k + lane) * kPack;
      s.rows_x[to] = x[lane];
      s.rows_y[to] = y[lane];
      s.rows_c[to] = c[lane];
      if (!words) continue;
      const geometry::HalfPlane h{{static_cast<double>(x[lane]), static_cast<double>(y[lane])},
                                  static_cast<double>(c[lane]) - table_.spare};
      words->neighbours.push_back({static_cast<RobotId>(robots.id[other]), h, (flags.touching >> lane & 1U) != 0});
    }
    return (flags.touching & ((1U << count) - 1U)) != 0;
  }

  /// Two robots in one place, as fast as each other: the lower id leaves to the left (-x), the other to the right.
  void part(std::size_t robot, std::size_t other, T& x, T& y, T& c) const {
    x = robots.id[robot] < robots.id[other] ? T(-1) : T(1);
    y = T(0);
    const double radius = static_cast<double>(table_.radius[kind_of(robot)]) + table_.radius[kind_of(other)];
    const double own = static_cast<double>(x) * robots.mx[robot] * table_.velocity_step;
    const double half = radius / (2.0 * options.time_step) * (1.0 + 0x1p-50);
    c = rounded_up<T>(own + half + static_cast<double>(table_.lattice_slack));
  }

  KindTable<T> table_;
  LineRule<T> rule_;
  Array<T> preferred_;
  std::vector<std::unique_ptr<Scratch>> scratch_;
};

std::unique_ptr<CrowdCore> make_float_core(const CrowdOptions& options) {
  return std::make_unique<CrowdEngine<float>>(options);
}
std::unique_ptr<CrowdCore> make_double_core(const CrowdOptions& options) {
  return std::make_unique<CrowdEngine<double>>(options);
}

}  // namespace exactvo::formation
