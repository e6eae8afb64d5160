// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/packs.h"

#include <algorithm>

#include "crowd/search.h"

namespace exactvo::formation::crowd {
namespace {

/// Candidates that a pack may look at in vain rather than be cut at the end of its strip.
constexpr std::size_t kWorthCutting = 48;

class PackSearch {
 public:
  PackSearch(Robots& robots, const ReachTable& table) : robots_(robots), table_(table), mixed_(table.is_mixed()) {}

  void find(std::size_t begin, std::size_t last, Pack& pack, PackBuffers& out) const {
    first_pack(begin, last, pack);
    LaneQuery query;
    query.x = &robots_.x[begin];
    query.y = &robots_.y[begin];
    query.self = out.self;
    query.ranks = ranks_sought(table_.most_neighbours + 1);
    query.mixed = mixed_;
    for (;;) {
      if (!pack.is_searched()) return give_up(pack, out);
      load_lanes(pack, out);
      collect(pack, out);
      query.lanes = pack.lanes();
      query.seen = static_cast<float>(pack.reach * pack.reach * kWholeKey);
      const std::uint32_t behind = find_nearest(out.others, query, out.limits, out.ranked, out.finds);
      if (behind != 0) {
        drop_selves(behind, query.ranks, out);
        count_neighbours(query, out.limits, out.ranked, out.finds);
      }
      if (!somebody_may_be_missing(pack, out)) break;
      pack.reach = std::min(widest_window(pack), pack.reach * kWiderReach);
      look(pack);
      halve(pack);
    }
    take_finds(pack, out);
  }

 private:
  double widest_window(const Pack& pack) const {
    if (!mixed_) return table_.window[0];
    double most = 0.0;
    for (std::size_t i = pack.begin; i < pack.end; ++i) most = std::max(most, table_.window[robots_.kind(i)]);
    return most;
  }

  void place(Pack& pack, std::size_t end) const {
    pack.end = end;
    const Extent in_x = extent_of(&robots_.x[pack.begin], pack.size());
    const Extent in_y = extent_of(&robots_.y[pack.begin], pack.size());
    pack.box = {in_x.low, in_x.high, in_y.low, in_y.high};
    const std::int32_t hint = extent_of(&robots_.hint[pack.begin], pack.size()).high;
    pack.reach = std::min(widest_window(pack), kFirstReach * hint + table_.nearby);
    look(pack);
  }

  void look(Pack& pack) const {
    pack.cells = robots_.cells_of(grown(pack.box, pack.reach));
    pack.candidates = 0;
    for (std::int64_t row = pack.cells.row0; row <= pack.cells.row1; ++row) {
      const Stretch stretch = robots_.stretch(pack.cells, row);
      const std::int64_t nth = row - pack.cells.row0;
      if (nth < Pack::kKeptStretches) pack.stretches[nth] = stretch;
      pack.candidates += stretch.to - stretch.from;
    }
  }

  /// The robots from b on that are searched for together: fewer than kPack where they have too many candidates.
  void first_pack(std::size_t b, std::size_t last, Pack& pack) const {
    pack.clear();
    pack.begin = b;
    place(pack, std::min(b + kPack, last));
    if (pack.candidates <= kWorthCutting) return;
    const std::size_t strip_end = robots_.strip_end(b);
    if (pack.end > strip_end) {
      Pack cut = pack;
      place(cut, strip_end);
      if (pack.candidates > kMostCandidates || pack.candidates > kWorthCutting + cut.candidates) pack = cut;
    }
    halve(pack);
  }

  /// Until the candidates have room in the table. One robot is decided alone if it comes to that.
  void halve(Pack& pack) const {
    while (pack.candidates > kMostCandidates && pack.size() > 1) place(pack, pack.begin + pack.size() / 2);
  }

  /// One robot among more candidates than the table has room for.
  void give_up(Pack& pack, PackBuffers& out) const {
    pack.alone = 1;
    pack.ranks = 0;
    load_lanes(pack, out);
    for (auto& row : out.ranked.key) std::copy(out.limits.none, out.limits.none + kPack, row);
    out.others.count = 0;
    out.finds.neighbours = 0;
    std::fill(pack.neighbours, pack.neighbours + kPack, 0);
  }

  void load_lanes(const Pack& pack, PackBuffers& out) const {
    LaneLimits& limits = out.limits;
    if (mixed_) {
      for (std::size_t lane = 0; lane < kPack; ++lane) {
        const std::size_t kind = lane < pack.size() ? robots_.kind(pack.begin + lane) : 0;
        limits.kind[lane] = static_cast<std::int32_t>(kind);
        limits.none[lane] = table_.none[kind];
        limits.reach[lane] = table_.reach[kind];
        limits.wanted[lane] = table_.neighbours[kind];
        limits.window[lane] = table_.whole_window[kind];
      }
    } else {
      std::fill(limits.kind, limits.kind + kPack, 0);
      std::fill(limits.none, limits.none + kPack, table_.none[0]);
      std::fill(limits.reach, limits.reach + kPack, table_.reach[0]);
      std::fill(limits.wanted, limits.wanted + kPack, table_.neighbours[0]);
      std::fill(limits.window, limits.window + kPack, table_.whole_window[0]);
    }
    for (std::size_t lane = pack.size(); lane < kPack; ++lane) limits.none[lane] = 0.0F;
  }

  void collect(const Pack& pack, PackBuffers& out) const {
    const Window w = grown(pack.box, pack.reach);
    const auto within = [](std::int64_t y) {
      return static_cast<std::int32_t>(std::clamp<std::int64_t>(y, -kLatticeEnd, kLatticeEnd));
    };
    const RobotColumns columns{robots_.x.data(), robots_.y.data(), robots_.mx.data(), robots_.my.data(),
                               robots_.tag.data()};
    const CandidateRule rule{pack.begin, pack.end, within(w.y0), within(w.y1), mixed_};
    CandidateStretch some[Pack::kKeptStretches];
    std::size_t count = 0;
    out.others.count = 0;
    for (std::int64_t row = pack.cells.row0; row <= pack.cells.row1; ++row) {
      const std::int64_t nth = row - pack.cells.row0;
      const Stretch stretch = nth < Pack::kKeptStretches ? pack.stretches[nth] : robots_.stretch(pack.cells, row);
      if (stretch.from == stretch.to) continue;
      // A strip that reaches beyond the window: robots farther from the box in y than the pack looks are left out.
      some[count++] = {stretch.from, stretch.to, row == pack.cells.row0 || row == pack.cells.row1};
      if (count < Pack::kKeptStretches) continue;
      add_candidates(columns, rule, some, count, out.others, out.self);
      count = 0;
    }
    add_candidates(columns, rule, some, count, out.others, out.self);
  }

  /// A robot is the first of its own list, unless others stand in its place.
  void drop_selves(std::uint32_t behind, int ranks, PackBuffers& out) const {
    for (std::size_t lane = 0; behind != 0; ++lane, behind >>= 1U)
      if (behind & 1U) drop_self(lane, ranks, out);
  }

  void drop_self(std::size_t lane, int ranks, PackBuffers& out) const {
    const std::int32_t none = bits_of(out.limits.none[lane]);
    int at = ranks - 1;  // the last one, where as many others stand in its place
    for (int r = 0; r < ranks; ++r) {
      const std::int32_t key = bits_of(out.ranked.key[r][lane]);
      if (key < none && (key & kIndexBits) == out.self[lane]) at = r;
    }
    for (int r = at; r > 0; --r) out.ranked.key[r][lane] = out.ranked.key[r - 1][lane];
  }

  /// Whether a robot outside the window could be nearer than the last neighbour of a lane.
  bool somebody_may_be_missing(const Pack& pack, const PackBuffers& found) const {
    std::uint32_t unseen = found.finds.unseen & pack.lanes();
    for (std::size_t lane = 0; unseen != 0; ++lane, unseen >>= 1U)
      if ((unseen & 1U) && pack.reach < table_.window[static_cast<std::size_t>(found.limits.kind[lane])]) return true;
    return false;
  }

  /// The robots that the next step will ask how far, and those with more in reach than neighbours.
  void take_finds(Pack& pack, const PackBuffers& found) const {
    std::int32_t* const hints = robots_.hint.data() + pack.begin;
    if (pack.size() == kPack)
      std::copy(found.finds.hint, found.finds.hint + kPack, hints);
    else
      std::copy(found.finds.hint, found.finds.hint + pack.size(), hints);
    std::copy(found.finds.have, found.finds.have + kPack, pack.neighbours);
    pack.alone = found.finds.crowded & pack.lanes();
    pack.ranks = found.finds.most;
  }

  Robots& robots_;
  const ReachTable& table_;
  bool mixed_;
};

}  // namespace

void find_pack(Robots& robots, const ReachTable& table, std::size_t begin, std::size_t last, Pack& pack,
               PackBuffers& out) {
  PackSearch(robots, table).find(begin, last, pack, out);
}

}  // namespace exactvo::formation::crowd
