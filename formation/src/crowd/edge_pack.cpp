// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/edge_pack.h"

#include "crowd/edge_rounding.h"
#include "exactvo/geometry/infinity.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/edge_pack.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using namespace edge_rounding;

/// One double per lane.
using Doubles = hn::CappedTag<double, kPack>;
using V = hn::Vec<Doubles>;
using M = hn::Mask<Doubles>;
using Index = hn::RebindToSigned<Doubles>;
using Words = hn::Rebind<std::int32_t, Doubles>;

using geometry::kInfinity;

HWY_INLINE V set(double x) {
  return hn::Set(Doubles(), x);
}

struct Vec {
  V x, y;
};
HWY_INLINE Vec operator-(Vec a, Vec b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y)};
}
HWY_INLINE Vec operator*(V s, Vec a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y)};
}
HWY_INLINE Vec operator-(Vec a) {
  return {hn::Neg(a.x), hn::Neg(a.y)};
}
HWY_INLINE V dot(Vec a, Vec b) {
  return hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y));
}
HWY_INLINE Vec perp(Vec a) {
  return {hn::Neg(a.y), a.x};
}
HWY_INLINE Vec choose(M mask, Vec yes, Vec no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y)};
}

HWY_INLINE M is_zero(Vec a) {
  return hn::And(hn::Eq(a.x, set(0.0)), hn::Eq(a.y, set(0.0)));
}

/// 0 where there is no direction.
HWY_INLINE Vec direction(Vec a) {
  const V squared = dot(a, a);
  const M there = hn::Gt(squared, set(kNoDirection));
  const V scale = hn::IfThenElseZero(there, hn::Div(set(1.0), hn::Sqrt(squared)));
  return scale * a;
}

HWY_INLINE Vec nearest_point(Vec a, Vec b) {
  const Vec along = b - a;
  const V length = dot(along, along);
  const V at = hn::Min(hn::Max(hn::Div(hn::Neg(dot(a, along)), length), set(0.0)), set(1.0));
  const V t = hn::IfThenElseZero(hn::Gt(length, set(0.0)), at);
  return {hn::Add(a.x, hn::Mul(t, along.x)), hn::Add(a.y, hn::Mul(t, along.y))};
}

HWY_INLINE V magnitude(Vec a, Vec b) {
  return hn::Add(hn::Add(hn::Add(hn::Abs(a.x), hn::Abs(a.y)), hn::Abs(b.x)), hn::Abs(b.y));
}

/// Narrows [from, to] to where a + t (b - a) is within [-far, far].
HWY_INLINE void clip(V a, V b, V far, V& from, V& to) {
  const M same = hn::Eq(a, b);
  const V extent = hn::Sub(b, a);
  const V one = hn::Div(hn::Sub(hn::Neg(far), a), extent), other = hn::Div(hn::Sub(far, a), extent);
  from = hn::IfThenElse(same, from, hn::Max(from, hn::Min(one, other)));
  to = hn::IfThenElse(same, to, hn::Min(to, hn::Max(one, other)));
}

/// The part of an edge within |x|, |y| <= far: what is beyond the range cannot be met, and a normal that is rounded
/// turns the far end of a long wall across the way. A new end is off the edge by a rounding error of the old ones.
HWY_INLINE void cut(Vec& a, Vec& b, V far) {
  const V most = hn::Max(hn::Max(hn::Abs(a.x), hn::Abs(a.y)), hn::Max(hn::Abs(b.x), hn::Abs(b.y)));
  const M beyond = hn::Gt(most, far);
  if (HWY_LIKELY(hn::AllFalse(Doubles(), beyond))) return;
  V from = set(0.0), to = set(1.0);
  clip(a.x, b.x, far, from, to);
  clip(a.y, b.y, far, from, to);
  const M cuts = hn::And(beyond, hn::Le(from, to));
  const Vec along = b - a;
  const Vec first = {hn::Add(a.x, hn::Mul(from, along.x)), hn::Add(a.y, hn::Mul(from, along.y))};
  const Vec last = {hn::Add(a.x, hn::Mul(to, along.x)), hn::Add(a.y, hn::Mul(to, along.y))};
  const Vec whole_a = a, whole_b = b;
  a = choose(hn::And(cuts, hn::Gt(from, set(0.0))), first, whole_a);
  b = choose(hn::And(cuts, hn::Lt(to, set(1.0))), last, whole_b);
}

/// An edge in each lane, and the search for the best normal against it.
struct Search {
  Vec a, b;
  V grown, horizon;
  Vec velocity;
  V least;  ///< minus how deep inside the velocity is, of the best so far
  Vec found;

  HWY_INLINE void try_normal(Vec n, V room, M usable) {
    const V support = hn::Add(hn::Max(dot(n, a), dot(n, b)), grown);
    const V depth = hn::Sub(support, hn::Mul(horizon, dot(n, velocity)));
    const M better = hn::And(usable, hn::And(hn::Le(support, room), hn::Lt(depth, least)));
    least = hn::IfThenElse(better, depth, least);
    found = choose(better, n, found);
  }
  HWY_INLINE void try_normal(Vec n) { try_normal(n, set(0.0), hn::Eq(grown, grown)); }

  HWY_INLINE void try_legs(Vec centre, V room) {
    const V squared = dot(centre, centre), square = hn::Sub(squared, hn::Mul(grown, grown));
    const M apart = hn::Gt(square, set(0.0));
    if (hn::AllFalse(Doubles(), apart)) return;
    const V leg = hn::Sqrt(hn::IfThenElseZero(apart, square)), scale = hn::Div(set(1.0), squared);
    for (const V side : {leg, hn::Neg(leg)}) {
      const V x = hn::Neg(hn::Add(hn::Mul(grown, centre.x), hn::Mul(side, centre.y)));
      const V y = hn::Sub(hn::Mul(side, centre.x), hn::Mul(grown, centre.y));
      try_normal(scale * Vec{x, y}, room, apart);
    }
  }
};

/// Normals as the lines hold them.
template <class T>
HWY_INLINE V as_held(V x) {
  if constexpr (sizeof(T) == 4)
    return hn::PromoteTo(Doubles(), hn::DemoteTo(hn::Rebind<float, Doubles>(), x));
  else
    return x;
}

HWY_INLINE void store_up(V value, V least, double* to) {
  hn::StoreU(hn::Max(least, value), Doubles(), to);
}

/// The least float that is not below the value.
HWY_INLINE void store_up(V value, V least, float* to) {
  const hn::Rebind<float, Doubles> floats;
  const hn::RebindToSigned<decltype(floats)> words;
  const auto nearest = hn::DemoteTo(floats, value);
  const M below_wide = hn::Lt(hn::PromoteTo(Doubles(), nearest), value);
  const auto below = hn::Ne(hn::DemoteTo(words, hn::IfThenElseZero(below_wide, set(1.0))), hn::Zero(words));
  const auto bits = hn::BitCast(words, nearest);
  const auto next =
      hn::IfThenElse(hn::Lt(bits, hn::Zero(words)), hn::Sub(bits, hn::Set(words, 1)), hn::Add(bits, hn::Set(words, 1)));
  const auto up = hn::IfThenElse(hn::Eq(hn::Add(bits, bits), hn::Zero(words)), hn::Set(words, 1), next);
  const auto rounded = hn::BitCast(floats, hn::IfThenElse(below, up, bits));
  hn::StoreU(hn::Max(hn::DemoteTo(floats, least), rounded), floats, to);
}

HWY_INLINE void store_held(V value, double* to) {
  hn::StoreU(value, Doubles(), to);
}
HWY_INLINE void store_held(V value, float* to) {
  const hn::Rebind<float, Doubles> floats;
  hn::StoreU(hn::DemoteTo(floats, value), floats, to);
}

/// Some lanes of a pack.
template <class T>
class EdgeLanes {
 public:
  HWY_INLINE EdgeLanes(const EdgePackQuery<T>& query, EdgePackTable& table, std::size_t lane)
      : query_(query), table_(table), lane_(lane) {
    const Doubles d;
    place_ = {hn::LoadU(d, query.x + lane), hn::LoadU(d, query.y + lane)};
    radius_ = hn::LoadU(d, query.radius + lane);
    horizon_ = hn::LoadU(d, query.horizon + lane);
    velocity_ = {hn::LoadU(d, query.vx + lane), hn::LoadU(d, query.vy + lane)};
    if constexpr (sizeof(T) == 4)
      least_ = hn::PromoteTo(d, hn::LoadU(hn::Rebind<float, Doubles>(), query.least + lane));
    else
      least_ = hn::LoadU(d, query.least + lane);
    for (std::size_t k = 0; k < hn::Lanes(d); ++k)
      count_ = HWY_MAX(count_, static_cast<std::size_t>(query.count[lane + k]));
  }

  /// Bits of these lanes: those that need more lines than there is room for.
  HWY_INLINE std::uint32_t run(const EdgePackLines<T>& out) {
    const Doubles d;
    V lines = set(0.0);
    M overflow = hn::MaskFromVec(hn::Zero(d));
    if (count_ > 0) {
      while (!gather()) table_.double_rows();
      for (std::size_t k = 0;; ++k) {
        M at_work = hn::Lt(best_squared_, set(kInfinity));
        if (hn::AllFalse(d, at_work)) break;
        if (k == out.room) {
          overflow = at_work;
          break;
        }
        lines = hn::IfThenElse(at_work, set(static_cast<double>(k + 1)), lines);
        const std::size_t to = k * out.stride + lane_;
        make_line(out.x + to, out.y + to, out.c + to);
        if (out.edge) name_edges(out.edge + to, out.touching + to);
        drop_excluded();
      }
    }
    lines = hn::IfThenElse(overflow, set(0.0), lines);
    hn::StoreU(hn::DemoteTo(Words(), lines), Words(), out.lines + lane_);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, overflow, bytes);
    return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8) << lane_;
  }

 private:
  enum Field { kAx, kAy, kBx, kBy, kError, kSquared };
  HWY_INLINE double* cell(Field field, std::size_t row_at) const {
    return cells_ + row_at + static_cast<std::size_t>(field) * hn::Lanes(Doubles());
  }

  HWY_INLINE std::uint32_t number_of(std::size_t lane, std::size_t row) const {
    return query_.items[HWY_MIN(first_[lane] + row, last_[lane])];
  }

  /// The edges of the last lines, and whether they touch.
  HWY_INLINE void name_edges(std::uint32_t* edge, std::uint8_t* touching) const {
    alignas(64) double row[kPack], threshold[kPack];
    hn::Store(best_row_, Doubles(), row);
    hn::Store(threshold_, Doubles(), threshold);
    for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) {
      const std::size_t nth = static_cast<std::size_t>(row[lane]) / (EdgePackTable::kFields * hn::Lanes(Doubles()));
      edge[lane] = number_of(lane, table_.row_in_cell[nth]);
      touching[lane] = threshold[lane] == -kInfinity;
    }
  }

  /// The edges of a row as seen from the robots: that of each lane's cell, its last where it has fewer, any where it
  /// has none. An edge is one load, and four by four they are transposed: processors take gathers apart, number by
  /// number.
  HWY_INLINE void edges_of_row(std::size_t row, Vec& a, Vec& b) const {
    const Doubles d;
    static_assert(sizeof(Segment) == 4 * sizeof(double));
    const auto edge_of = [&](std::size_t lane) { return &query_.edges[number_of(lane, row)].a.x; };
#if HWY_CAP_GE256
    if constexpr (hn::MaxLanes(Doubles()) >= 4) {
      V v[4];
      for (std::size_t k = 0; k < 4; ++k) {
        const hn::CappedTag<double, 4> four;
        if constexpr (hn::MaxLanes(Doubles()) == 8)
          v[k] = hn::Combine(d, hn::LoadU(four, edge_of(k + 4)), hn::LoadU(four, edge_of(k)));
        else
          v[k] = hn::LoadU(d, edge_of(k));
      }
      const V x01 = hn::InterleaveLower(d, v[0], v[1]), x23 = hn::InterleaveLower(d, v[2], v[3]);
      const V y01 = hn::InterleaveUpper(d, v[0], v[1]), y23 = hn::InterleaveUpper(d, v[2], v[3]);
      a = {hn::OddEvenBlocks(hn::SwapAdjacentBlocks(x23), x01), hn::OddEvenBlocks(hn::SwapAdjacentBlocks(y23), y01)};
      b = {hn::OddEvenBlocks(x23, hn::SwapAdjacentBlocks(x01)), hn::OddEvenBlocks(y23, hn::SwapAdjacentBlocks(y01))};
      a = a - place_;
      b = b - place_;
      return;
    }
#endif
    alignas(64) double ends[4][kPack];
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane)
      for (std::size_t k = 0; k < 4; ++k) ends[k][lane] = edge_of(lane)[k];
    a = Vec{hn::Load(d, ends[0]), hn::Load(d, ends[1])} - place_;
    b = Vec{hn::Load(d, ends[2]), hn::Load(d, ends[3])} - place_;
  }

  /// The edges of the lanes' cells that are within range, as seen from the robots, by row; the nearest of each lane.
  /// False where the table has too few rows.
  HWY_INLINE bool gather() {
    const Doubles d;
    cells_ = table_.cells.data();
    row_at_ = table_.row_at.data();
    row_number_ = table_.row_number.data();
    std::uint32_t* const row_in_cell = table_.row_in_cell.data();
    const std::size_t room = table_.row_at.size();
    used_ = 0;
    const V count = hn::PromoteTo(d, hn::LoadU(Words(), query_.count + lane_));
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) {  // of a lane without edges, `first` may be past the end
      const auto edges = static_cast<std::size_t>(query_.count[lane_ + lane]);
      first_[lane] = edges > 0 ? static_cast<std::size_t>(query_.first[lane_ + lane]) : 0;
      last_[lane] = edges > 0 ? first_[lane] + edges - 1 : 0;
    }
    const V max_speed = hn::LoadU(d, query_.max_speed + lane_);
    const V range = hn::Mul(hn::Add(hn::Mul(horizon_, max_speed), radius_), set(kWiden));
    const V far = hn::Mul(set(kCutRanges), range), squared_range = hn::Mul(range, range);
    best_squared_ = set(kInfinity);
    best_row_ = set(0.0);
    for (std::size_t row = 0; row < count_; ++row) {
      Vec a, b;
      edges_of_row(row, a, b);
      const Vec nearest = nearest_point(a, b);
      V squared = dot(nearest, nearest);
      const M row_there = hn::Lt(set(static_cast<double>(row)), count);
      const M within = hn::And(row_there, hn::Le(squared, squared_range));
      if (hn::AllFalse(d, within)) continue;
      if (HWY_UNLIKELY(used_ == room)) return false;
      squared = hn::IfThenElse(within, squared, set(kInfinity));
      const V error = hn::Mul(set(kSupportError), hn::Add(magnitude(a, b), radius_));
      cut(a, b, far);
      const std::size_t to = used_ * EdgePackTable::kFields * hn::Lanes(d);
      hn::Store(a.x, d, cell(kAx, to));
      hn::Store(a.y, d, cell(kAy, to));
      hn::Store(b.x, d, cell(kBx, to));
      hn::Store(b.y, d, cell(kBy, to));
      hn::Store(error, d, cell(kError, to));
      hn::Store(squared, d, cell(kSquared, to));
      row_in_cell[used_] = static_cast<std::uint32_t>(row);
      row_at_[used_] = static_cast<std::uint32_t>(to);
      row_number_[used_++] = static_cast<double>(to);
      take_if_nearer(squared, set(static_cast<double>(to)));
    }
    return true;
  }

  HWY_INLINE void take_if_nearer(V squared, V row) {
    const M nearer = hn::Lt(squared, best_squared_);
    best_squared_ = hn::IfThenElse(nearer, squared, best_squared_);
    best_row_ = hn::IfThenElse(nearer, row, best_row_);
  }

  HWY_INLINE V support_above(Vec n, V length, Vec a, Vec b, V error) const {
    const V most = hn::Max(dot(n, a), dot(n, b));
    return hn::Add(hn::Add(most, hn::Mul(radius_, length)), error);
  }

  /// Against the nearest edge of each lane; of lanes that have none, anything.
  HWY_INLINE void make_line(T* x, T* y, T* c) {
    const Doubles d;
    const Index index;
    const auto at = hn::Add(hn::PromoteTo(index, hn::DemoteTo(Words(), best_row_)), hn::Iota(index, 0));
    Search search;
    search.a = {hn::GatherIndex(d, cell(kAx, 0), at), hn::GatherIndex(d, cell(kAy, 0), at)};
    search.b = {hn::GatherIndex(d, cell(kBx, 0), at), hn::GatherIndex(d, cell(kBy, 0), at)};
    const V error = hn::GatherIndex(d, cell(kError, 0), at);
    hn::ScatterIndex(set(kInfinity), d, cell(kSquared, 0), at);  // it has its line
    constexpr double u = sizeof(T) == 4 ? 0x1p-24 : kUnit;
    const V room = hn::Mul(set(kRoundingRoom * u), hn::Add(magnitude(search.a, search.b), radius_));
    const V size = hn::Mul(error, set(1.0 / kSupportError));
    search.grown = hn::Add(hn::Add(radius_, room), hn::Mul(set(kSupportRoom), size));
    search.horizon = horizon_;
    search.velocity = velocity_;
    search.least = set(kInfinity);
    search.found = {set(0.0), set(0.0)};
    const Vec way = horizon_ * velocity_;
    search.try_normal(direction(way - search.a));
    search.try_normal(direction(way - search.b));
    const Vec across = direction(perp(search.b - search.a));
    search.try_normal(across);
    search.try_normal(-across);
    search.try_legs(search.a, error);
    search.try_legs(search.b, error);
    normal_ = {as_held<T>(search.found.x), as_held<T>(search.found.y)};
    length_ = hn::Sqrt(dot(normal_, normal_));
    const V support = support_above(normal_, length_, search.a, search.b, error);
    const M parts = hn::And(hn::Lt(search.least, set(kInfinity)), hn::Le(support, set(0.0)));
    const V above = hn::Add(support, hn::Mul(set(kSharedVertex), error));
    V offset = hn::Min(set(0.0), hn::Mul(hn::Div(above, horizon_), set(kTowardsZero)));
    threshold_ = hn::Mul(hn::Mul(horizon_, offset), set(kAwayFromZero));
    if (HWY_UNLIKELY(!hn::AllTrue(d, parts))) {
      const Vec facing = face(search.a, search.b, across);
      normal_ = choose(parts, normal_, facing);
      length_ = hn::Sqrt(dot(normal_, normal_));
      offset = hn::IfThenElseZero(parts, offset);
      const M apart = hn::Le(support_above(normal_, length_, search.a, search.b, error), set(0.0));
      threshold_ = hn::IfThenElse(parts, threshold_, hn::IfThenElse(apart, set(0.0), set(-kInfinity)));
    }
    store_held(normal_.x, x);
    store_held(normal_.y, y);
    store_up(hn::Add(offset, set(static_cast<double>(query_.slack))), least_, c);
  }

  /// Away from the nearest point of the edge; across an edge that the robot stands on.
  static HWY_INLINE Vec face(Vec a, Vec b, Vec across) {
    Vec n = direction(-nearest_point(a, b));
    const V zero = set(0.0);
    n = choose(is_zero(n), across, n);
    n = choose(is_zero(n), Vec{set(1.0), zero}, n);
    return {as_held<T>(n.x), as_held<T>(n.y)};
  }

  /// The last edge and all that its half-plane excludes; the nearest of those that are left.
  HWY_INLINE void drop_excluded() {
    const Doubles d;
    best_squared_ = set(kInfinity);
    best_row_ = set(0.0);
    const std::size_t used = used_;
    used_ = 0;
    for (std::size_t k = 0; k < used; ++k) {
      const std::size_t at = row_at_[k];
      const double number = row_number_[k];
      const Vec a = {hn::Load(d, cell(kAx, at)), hn::Load(d, cell(kAy, at))};
      const Vec b = {hn::Load(d, cell(kBx, at)), hn::Load(d, cell(kBy, at))};
      const V support = support_above(normal_, length_, a, b, hn::Load(d, cell(kError, at)));
      const M excluded = hn::Le(support, threshold_);
      const V squared = hn::IfThenElse(excluded, set(kInfinity), hn::Load(d, cell(kSquared, at)));
      hn::Store(squared, d, cell(kSquared, at));
      take_if_nearer(squared, set(number));
      row_at_[used_] = static_cast<std::uint32_t>(at);
      row_number_[used_] = number;
      used_ += hn::AllFalse(d, hn::Lt(squared, set(kInfinity))) ? 0 : 1;
    }
  }

  const EdgePackQuery<T>& query_;
  EdgePackTable& table_;
  double* cells_;          ///< of the table, by row, field and lane
  std::uint32_t* row_at_;  ///< where rows begin that a lane still has an edge in
  double* row_number_;     ///< the same as numbers, to be broadcast
  std::size_t lane_, count_ = 0, used_ = 0;
  std::size_t first_[kPack], last_[kPack];  ///< of each lane's cell in the query's items
  Vec place_, velocity_;
  V radius_, horizon_, least_;
  V best_squared_, best_row_;  ///< of the nearest edge that is left; infinite: none
  Vec normal_;                 ///< of the last lines
  V length_;                   ///< |normal|
  V threshold_;  ///< edges with support values up to it are excluded; minus infinity where the robot touches
};

template <class T>
std::uint32_t all_lanes(const EdgePackQuery<T>& query, EdgePackTable& table, const EdgePackLines<T>& out) {
  std::uint32_t overflow = 0;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(Doubles()))
    overflow |= EdgeLanes<T>(query, table, lane).run(out);
  return overflow;
}

std::uint32_t float_edges(const EdgePackQuery<float>& query, EdgePackTable& table, const EdgePackLines<float>& out) {
  return all_lanes(query, table, out);
}
std::uint32_t double_edges(const EdgePackQuery<double>& query, EdgePackTable& table, const EdgePackLines<double>& out) {
  return all_lanes(query, table, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(float_edges);
HWY_EXPORT(double_edges);

void EdgePackTable::double_rows() {
  const std::size_t rows = std::max<std::size_t>(16, 2 * row_at.size());
  cells.resize(rows * kFields * kPack);
  row_number.resize(rows);
  row_in_cell.resize(rows);
  row_at.resize(rows);
}

std::uint32_t make_edge_lines(const EdgePackQuery<float>& query, EdgePackTable& table,
                              const EdgePackLines<float>& out) {
  return HWY_DYNAMIC_DISPATCH(float_edges)(query, table, out);
}
std::uint32_t make_edge_lines(const EdgePackQuery<double>& query, EdgePackTable& table,
                              const EdgePackLines<double>& out) {
  return HWY_DYNAMIC_DISPATCH(double_edges)(query, table, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
