// SPDX-License-Identifier: GPL-3.0-or-later
#include "crowd/twists.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "crowd/twists.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using OneLane = hn::CappedTag<double, 1>;
using PackLanes = hn::CappedTag<double, kPack>;

/// What a step adds to the unknown angle: rounding K w + m conj(w), for K >= 2 |m|.
constexpr double kNewDoubt = 0x1p-46;
/// What (2) leaves out at kMostDoubt, and rounding.
constexpr double kSecondOrder = 1.0 + 0x1p-21;

/// The seventh convergent of Gauss's continued fraction, 1 / (1 + s / (3 + 4 s / (5 + 9 s / (7 + ...)))).
template <class D, class V = hn::Vec<D>>
HWY_INLINE V arc(D d, V s) {
  const auto next = [&](V rest, double term) { return hn::Add(hn::Set(d, term), hn::Mul(s, rest)); };
  const V above = next(next(next(hn::Set(d, 2304.0), 53487.0), 173250.0), 135135.0);
  const V below = next(next(next(hn::Set(d, 11025.0), 99225.0), 218295.0), 135135.0);
  return hn::Div(above, below);
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE void turn_ahead(D d, V a, V b, V& x, V& y) {
  const V aa = hn::Mul(a, a), bb = hn::Mul(b, b), shorter = hn::Div(hn::Set(d, 1.0), hn::Add(aa, bb));
  x = hn::Mul(hn::Sub(aa, bb), shorter);
  y = hn::Mul(hn::Mul(hn::Mul(hn::Set(d, 2.0), a), b), shorter);
}

template <class D>
struct Twist {
  using V = hn::Vec<D>;
  V a, b, ex, ey, doubt, was_left, was_right;  ///< of the robot
  V ahead, across, most, change, turn, back;   ///< of its kind
  V mx, my;
  V left, right;   ///< ways of the wheels, lattice steps
  V room, growth;  ///< what is unknown of the heading grows by growth / room

  HWY_INLINE Twist(D d, const TwistLanes& lanes, std::size_t at) {
    V* const of_state[] = {&a, &b, &ex, &ey, &doubt, &was_left, &was_right};
    V* const of_limits[] = {&ahead, &across, &most, &change, &turn, &back};
    for (int k = 0; k < 7; ++k) *of_state[k] = hn::Load(d, lanes.state[k] + at);
    for (int k = 0; k < 6; ++k) *of_limits[k] = hn::Load(d, lanes.limits[k] + at);
    mx = hn::Load(d, lanes.mx + at);
    my = hn::Load(d, lanes.my + at);
    const V x = hn::Add(hn::Mul(mx, ex), hn::Mul(my, ey)), y = hn::Sub(hn::Mul(my, ex), hn::Mul(mx, ey));
    const V along = hn::Add(ahead, x), t = hn::Div(y, along), its_arc = arc(d, hn::Mul(t, t));
    const V middle = hn::Add(x, hn::Mul(y, t)), aside = hn::Mul(across, t);
    left = hn::Mul(hn::Sub(middle, aside), its_arc);
    right = hn::Mul(hn::Add(middle, aside), its_arc);
    room = hn::Add(hn::Mul(along, along), hn::Mul(y, y));
    growth = hn::Sub(hn::Mul(ahead, ahead), hn::Add(hn::Mul(mx, mx), hn::Mul(my, my)));
  }

  HWY_INLINE hn::Mask<D> is_still(D d) const { return hn::And(hn::Eq(mx, hn::Zero(d)), hn::Eq(my, hn::Zero(d))); }
  HWY_INLINE V grown(D d) const { return hn::Mul(hn::Mul(doubt, growth), hn::Set(d, kSecondOrder)); }

  HWY_INLINE hn::Mask<D> is_drivable(D d) const {
    const auto within = [](V way, V limit) { return hn::Le(hn::Abs(way), limit); };
    const auto speeds = hn::And(within(left, most), within(right, most));
    const auto changes = hn::And(within(hn::Sub(left, was_left), change), within(hn::Sub(right, was_right), change));
    const auto ways = hn::And(within(hn::Sub(right, left), turn), hn::Ge(hn::Add(left, right), back));
    const auto known = hn::Le(grown(d), hn::Mul(hn::Set(d, kMostDoubt - kNewDoubt), room));
    const auto all = hn::And(hn::And(speeds, changes), hn::And(ways, known));
    return hn::Or(all, hn::Or(is_still(d), hn::Eq(ahead, hn::Zero(d))));
  }

  HWY_INLINE void drive(D d, TwistLanes& lanes, std::size_t at) const {
    // A robot that stands heads exactly where it did.
    const auto still = is_still(d);
    const V to_a = hn::Add(hn::Mul(hn::Add(ahead, mx), a), hn::Mul(my, b)),
            to_b = hn::Add(hn::Mul(hn::Sub(ahead, mx), b), hn::Mul(my, a));
    const V size = hn::Sqrt(hn::Add(hn::Mul(to_a, to_a), hn::Mul(to_b, to_b)));
    const V longer = hn::Div(hn::Set(d, 1.0), size), na = hn::Mul(longer, to_a), nb = hn::Mul(longer, to_b);
    const V unknown = hn::Add(hn::Div(grown(d), room), hn::Set(d, kNewDoubt));
    V x, y;
    turn_ahead(d, na, nb, x, y);
    const V zero = hn::Zero(d);
    const V to[] = {hn::IfThenElse(still, a, na),
                    hn::IfThenElse(still, b, nb),
                    hn::IfThenElse(still, ex, x),
                    hn::IfThenElse(still, ey, y),
                    hn::IfThenElse(still, doubt, hn::Min(unknown, hn::Set(d, kMostDoubt))),
                    hn::IfThenElse(still, zero, left),
                    hn::IfThenElse(still, zero, right)};
    for (int k = 0; k < 7; ++k) hn::Store(to[k], d, lanes.state[k] + at);
  }
};

template <class D>
std::uint32_t drivable_some(D d, const TwistLanes& lanes) {
  std::uint32_t bits = 0;
  for (std::size_t at = 0; at < (hn::MaxLanes(d) == 1 ? 1 : kPack); at += hn::Lanes(d)) {
    std::uint8_t byte[8] = {};
    hn::StoreMaskBits(d, Twist<D>(d, lanes, at).is_drivable(d), byte);
    bits |= std::uint32_t{byte[0]} << at;
  }
  return bits;
}

std::uint32_t drivable_lanes(const TwistLanes& lanes, std::size_t count) {
  return count == 1 ? drivable_some(OneLane(), lanes) : drivable_some(PackLanes(), lanes);
}

void drive_lanes(TwistLanes& lanes, std::size_t count) {
  const PackLanes d;
  for (std::size_t at = 0; at < count; at += hn::Lanes(d)) Twist<PackLanes>(d, lanes, at).drive(d, lanes, at);
}

double one_arc(double s) {
  const OneLane d;
  return hn::GetLane(arc(d, hn::Set(d, s)));
}

geometry::Vec2 one_ahead(double a, double b) {
  const OneLane d;
  auto x = hn::Zero(d), y = x;
  turn_ahead(d, hn::Set(d, a), hn::Set(d, b), x, y);
  return {hn::GetLane(x), hn::GetLane(y)};
}

template <class T>
void put_some(const PolygonQuery& q, const LineRows<T>& out) {
  const PackLanes d;
  const hn::Rebind<T, PackLanes> narrow;
  const hn::Rebind<std::int32_t, PackLanes> words;
  const hn::RebindToSigned<PackLanes> wide;
  for (std::size_t lane = 0; lane < kPack; lane += hn::Lanes(d)) {
    const auto ex = hn::Load(d, q.ahead_x + lane), ey = hn::Load(d, q.ahead_y + lane);
    for (std::size_t k = 0; k < q.rows; ++k) {
      const auto of_kind = [&](const double* table) {
        return q.kinds == 1
                   ? hn::Set(d, table[k])
                   : hn::GatherIndex(d, table + k * q.kinds, hn::PromoteTo(wide, hn::Load(words, q.kind + lane)));
      };
      const auto put = [&](hn::Vec<PackLanes> value, T* to) {
        if constexpr (sizeof(T) == 8)
          hn::Store(value, d, to + k * out.stride + lane);
        else
          hn::Store(hn::DemoteTo(narrow, value), narrow, to + k * out.stride + lane);
      };
      const auto x = of_kind(q.x), y = of_kind(q.y);
      put(hn::Sub(hn::Mul(x, ex), hn::Mul(y, ey)), out.x);
      put(hn::Add(hn::Mul(x, ey), hn::Mul(y, ex)), out.y);
      put(of_kind(q.c), out.c);
    }
  }
}

void put_floats(const PolygonQuery& query, const LineRows<float>& out) {
  put_some(query, out);
}
void put_doubles(const PolygonQuery& query, const LineRows<double>& out) {
  put_some(query, out);
}

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace exactvo::formation::crowd {

HWY_EXPORT(drivable_lanes);
HWY_EXPORT(drive_lanes);
HWY_EXPORT(one_arc);
HWY_EXPORT(one_ahead);
HWY_EXPORT(put_floats);
HWY_EXPORT(put_doubles);

std::uint32_t drivable(const TwistLanes& lanes, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(drivable_lanes)(lanes, count);
}
void drive(TwistLanes& lanes, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(drive_lanes)(lanes, count);
}
double arc_of(double s) {
  return HWY_DYNAMIC_DISPATCH(one_arc)(s);
}
geometry::Vec2 ahead_of(double a, double b) {
  return HWY_DYNAMIC_DISPATCH(one_ahead)(a, b);
}
void put_polygons(const PolygonQuery& query, const LineRows<float>& out) {
  HWY_DYNAMIC_DISPATCH(put_floats)(query, out);
}
void put_polygons(const PolygonQuery& query, const LineRows<double>& out) {
  HWY_DYNAMIC_DISPATCH(put_doubles)(query, out);
}

}  // namespace exactvo::formation::crowd
#endif  // HWY_ONCE
