// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/turning_judge.h"

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <boost/multiprecision/mpfr.hpp>
#include <cmath>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/predicates.h"

namespace exactvo::test {
namespace {

using geometry::Encounter;
using geometry::hex_text;
using geometry::Obstacle;
using geometry::Polygon;
using geometry::Polyline;
using geometry::RigidBody;
using geometry::RoundedPolygon;
using geometry::TurningMotion;
using geometry::Twist;
using geometry::Vec2;

// --- The oracle ---

using Precise =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<50, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

template <class Number>
struct Far {
  Number x, y;
};
template <class Number>
Far<Number> operator-(const Far<Number>& a, const Far<Number>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <class Number>
Number dot(const Far<Number>& a, const Far<Number>& b) {
  return a.x * b.x + a.y * b.y;
}
template <class Number>
Far<Number> left_of(const Far<Number>& a) {
  return {-a.y, a.x};
}

/// One convex part and one convex piece, seen from the centre of the turn (or from anywhere without a turn).
template <class Number>
struct OraclePair {
  std::vector<Far<Number>> turning, standing;
  Number reach;
};

template <class Number>
OraclePair<double> in_doubles(const OraclePair<Number>& pair) {
  OraclePair<double> rounded;
  const auto copy = [](const std::vector<Far<Number>>& from, std::vector<Far<double>>& to) {
    for (const Far<Number>& p : from) to.push_back({static_cast<double>(p.x), static_cast<double>(p.y)});
  };
  copy(pair.turning, rounded.turning);
  copy(pair.standing, rounded.standing);
  rounded.reach = static_cast<double>(pair.reach);
  return rounded;
}

template <class Number>
std::vector<Far<Number>> turned(const std::vector<Far<Number>>& points, const Number& angle) {
  using std::cos, std::sin;
  const Number c = cos(angle), s = sin(angle);
  std::vector<Far<Number>> all;
  for (const Far<Number>& p : points) all.push_back({c * p.x - s * p.y, s * p.x + c * p.y});
  return all;
}

/// The greatest gap over all directions that count, less the reach.
template <class Number>
Number gap_of(const std::vector<Far<Number>>& a, const std::vector<Far<Number>>& b, const Number& reach) {
  using std::sqrt;
  Number most = -1e300;
  const auto along = [&](const Far<Number>& n) {
    const Number length = sqrt(dot(n, n));
    if (length == 0) return;
    Number least = 1e300, greatest = -1e300;
    for (const Far<Number>& p : a) least = std::min<Number>(least, dot(n, p));
    for (const Far<Number>& p : b) greatest = std::max<Number>(greatest, dot(n, p));
    most = std::max<Number>(most, (least - greatest) / length);
  };
  for (const auto* set : {&a, &b})
    for (const Far<Number>& p : *set)
      for (const Far<Number>& r : *set) along(left_of(p - r));
  for (const Far<Number>& p : a)
    for (const Far<Number>& r : b) along(p - r);
  if (most == Number(-1e300)) most = 0;
  return most - reach;
}

/// Angles from 0 to `end` at which a cos + b sin + c is 0 or turns round.
template <class Number>
void add_events(const Number& a, const Number& b, const Number& c, const Number& end, std::vector<Number>& events) {
  using std::abs, std::acos, std::atan2, std::sqrt;
  const Number size = sqrt(a * a + b * b);
  if (size == 0) return;
  const Number turn = 2 * boost::math::constants::pi<Number>(), middle = atan2(b, a);
  std::vector<Number> found{middle, middle + turn / 2};
  if (abs(c) <= size) {
    const Number off = acos(Number(-c / size));
    found.push_back(middle + off);
    found.push_back(middle - off);
  }
  for (Number angle : found) {
    while (angle >= 0) angle -= turn;
    for (angle += turn; angle <= end; angle += turn) events.push_back(angle);
  }
}

/// The least gap over all moments that count.
template <class Number>
Number least_gap(const OraclePair<Number>& pair, const Number& end) {
  using std::sqrt;
  std::vector<Number> events{Number(0), end};
  const auto with_edges = [&](const std::vector<Far<Number>>& hull, const std::vector<Far<Number>>& points,
                              bool hull_turns) {
    for (std::size_t k = 0; k < hull.size() && hull.size() > 1; ++k) {
      const Far<Number> e = hull[(k + 1) % hull.size()] - hull[k], n = left_of(e);
      const Number length = sqrt(dot(e, e));
      for (const Far<Number>& p : points) {
        // (R p - hull_k).n, or (p - R hull_k).(R n): of both the zero, the reach to both sides, and along the edge.
        const Far<Number>& moving = hull_turns ? n : p;
        const Far<Number>& rests = hull_turns ? p : n;
        const Number a = dot(moving, rests), b = dot(left_of(moving), rests), c = -dot(n, hull[k]);
        for (const Number& off : {Number(0), Number(pair.reach), Number(-pair.reach)})
          add_events(a, b, c + off * length, end, events);
        const Far<Number>& along = hull_turns ? e : p;
        const Far<Number>& other = hull_turns ? p : e;
        for (const Number& far : {Number(0), Number(length * length)})
          add_events(dot(along, other), dot(left_of(along), other), -dot(e, hull[k]) - far, end, events);
      }
    }
  };
  with_edges(pair.standing, pair.turning, false);
  with_edges(pair.turning, pair.standing, true);
  for (const Far<Number>& p : pair.turning)
    for (const Far<Number>& q : pair.standing)
      add_events(-2 * dot(p, q), -2 * dot(left_of(p), q), dot(p, p) + dot(q, q) - pair.reach * pair.reach, end, events);
  std::sort(events.begin(), events.end());
  const std::size_t count = events.size();
  for (std::size_t k = 1; k < count; ++k) events.push_back((events[k - 1] + events[k]) / 2);
  // In doubles first: a gap that is far from the least of them is not the least.
  const OraclePair<double> rounded = in_doubles(pair);
  std::vector<double> about;
  double size = 0.0, nearest = 1e300;
  for (const auto* set : {&rounded.turning, &rounded.standing})
    for (const Far<double>& p : *set) size = std::max({size, std::fabs(p.x), std::fabs(p.y)});
  for (const Number& angle : events) {
    about.push_back(gap_of(turned(rounded.turning, static_cast<double>(angle)), rounded.standing, rounded.reach));
    nearest = std::min(nearest, about.back());
  }
  Number least = 1e300;
  for (std::size_t k = 0; k < events.size(); ++k)
    if (about[k] <= nearest + 1e-7 * size)
      least = std::min<Number>(least, gap_of(turned(pair.turning, events[k]), pair.standing, pair.reach));
  return least;
}

template <class Number>
struct SeenTurn {
  OraclePair<Number> pair;
  Number end;  ///< rad
};

/// A part and a piece from the centre of the turn. A turn to the right is one to the left in a mirror. REQUIRES: it
/// turns.
template <class Number>
SeenTurn<Number> seen(const TurningMotion& m, const RoundedPolygon& part, const RoundedPolygon& piece) {
  const Number w(m.twist.turn), mirror = w < 0 ? -1 : 1;
  const Far<Number> at{Number(m.at.x), Number(m.at.y)};
  const Far<Number> centre{-Number(m.twist.velocity.y) / w, Number(m.twist.velocity.x) / w};  // from `at`
  SeenTurn<Number> turn;
  for (const Vec2 c : part.corners)
    turn.pair.turning.push_back({Number(c.x) - centre.x, mirror * (Number(c.y) - centre.y)});
  for (const Vec2 c : piece.corners)
    turn.pair.standing.push_back({(Number(c.x) - at.x) - centre.x, mirror * ((Number(c.y) - at.y) - centre.y)});
  turn.pair.reach = Number(part.radius) + Number(piece.radius);
  turn.end = mirror * w * (Number(m.end) - Number(m.start));
  return turn;
}

/// In doubles where their errors are nothing beside the gap, else in 50 digits.
Encounter judged(const TurningMotion& m, const RoundedPolygon& part, const RoundedPolygon& piece) {
  const SeenTurn<double> rounded = seen<double>(m, part, piece);
  double size = rounded.pair.reach;
  for (const auto* set : {&rounded.pair.turning, &rounded.pair.standing})
    for (const Far<double>& p : *set) size = std::max({size, std::fabs(p.x), std::fabs(p.y)});
  const double about = least_gap(rounded.pair, rounded.end);
  if (std::fabs(about) > 1e-7 * size) return about < 0.0 ? Encounter::overlap : Encounter::clear;
  const SeenTurn<Precise> precise = seen<Precise>(m, part, piece);
  const Precise least = least_gap(precise.pair, precise.end), nothing = ldexp(Precise(1), -100);
  return least < -nothing ? Encounter::overlap : least > nothing ? Encounter::clear : Encounter::contact;
}

Encounter oracle(const TurningCase& c) {
  Encounter worst = Encounter::clear;
  for (const RoundedPolygon& part : c.body) worst = std::max(worst, judged(c.motion, part, c.piece));
  return worst;
}

// --- Cases ---

/// What stands there: a wall, a convex polygon or a disc, up to 3 m from a place.
RoundedPolygon random_piece(SeededRandom& random, Vec2 at) {
  std::vector<Vec2> corners = random_hull(random, 1, 5, 1.5);
  const Vec2 shift = at + random.in_box(3.0);
  for (Vec2& p : corners) p += shift;
  return {corners, corners.size() == 1 || random.integer(0, 4) == 0 ? random.uniform(0.05, 0.5) : 0.0};
}

Vec2 random_place(SeededRandom& random) {
  return random.integer(0, 3) == 0 ? random.in_box(1e6) : Vec2{};
}

/// A body of one part with an interior; some are needles.
RigidBody random_part(SeededRandom& random) {
  std::vector<Vec2> corners = random_hull(random, 1, 5, 0.8);
  if (random.integer(0, 6) == 0) corners = {{-2.0, 0.0}, {2.0, -1e-6}, {2.0, 1e-6}};
  return {{corners, corners.size() < 3 || random.integer(0, 1) ? random.uniform(0.05, 0.5) : 0.0}};
}

TurningCase random_twist(SeededRandom& random) {
  const Vec2 at = random_place(random);
  const double start = random.uniform(-1.0, 1.0);
  return {{start, start + random.uniform(0.0, 4.0), at, {random.in_box(1.5), random.uniform(-2.5, 2.5)}},
          random_part(random),
          random_piece(random, at)};
}

/// A box with its axle behind the middle, which drives ahead or back; some turn so little that their circle is as wide
/// as the earth.
TurningCase random_drive(SeededRandom& random) {
  const Vec2 at = random_place(random), ahead = random.direction();
  const double back = random.uniform(0.1, 0.5), front = random.uniform(0.3, 1.2), side = random.uniform(0.1, 0.4);
  const double radius = random.integer(0, 2) ? 0.0 : 0.05;
  RoundedPolygon box{{}, radius};
  for (const Vec2 c : {Vec2{-back, -side}, Vec2{front, -side}, Vec2{front, side}, Vec2{-back, side}})
    box.corners.push_back(c.x * ahead + c.y * geometry::perp(ahead));
  const double speed = random.uniform(-1.5, 2.0);
  const double turn = random.uniform(-2.0, 2.0) * (random.integer(0, 3) ? 1.0 : std::pow(10.0, random.uniform(-12, 0)));
  return {{0.0, random.uniform(0.1, 3.0), at, {speed * ahead, turn}}, {box}, random_piece(random, at)};
}

/// Pairs of whole numbers and their distance from the origin, which is one too.
constexpr int kTriples[][3] = {{3, 4, 5}, {5, 12, 13}, {8, 15, 17}, {7, 24, 25}, {20, 21, 29}, {5, 0, 5}};

Vec2 quarter_turned(SeededRandom& random, Vec2 p) {
  for (int k = random.integer(0, 3); k > 0; --k) p = geometry::perp(p);
  return p;
}

/// The far corner of a disc or a triangle comes past a wall, or the end of one, that it touches exactly, misses or
/// overlaps by an ulp.
TurningCase grazing_turn(SeededRandom& random, bool is_polygon, bool is_full) {
  const int* triple = kTriples[random.integer(0, 5)];
  const double scale = std::ldexp(1.0, -random.integer(2, 5)), size = scale * triple[2];
  // From the centre of the turn: the far corner.
  const Vec2 r = quarter_turned(random, {scale * triple[0], scale * triple[1]});
  const double radius = is_polygon ? 0.0 : 0.25 * random.integer(1, 4);
  const Vec2 centre{0.25 * random.integer(-8, 8), 0.25 * random.integer(-8, 8)};
  const double turn = (random.integer(0, 2) ? 1.0 : -1.0) * std::ldexp(1.0, random.integer(-2, 1));
  const Vec2 at = random.integer(0, 3) ? Vec2{0.5, 0.25} : Vec2{1048576.0, -524288.0};
  // J v / w = centre.
  const Twist twist{-turn * geometry::perp(centre), turn};
  std::vector<Vec2> corners{centre + r};
  if (is_polygon) {
    corners.push_back(centre + 0.5 * geometry::perp(r));
    corners.push_back(centre - 0.25 * r);
  }
  const Vec2 outward = quarter_turned(random, {1.0, 0.0}), touched = (size + radius) * outward;
  const double nudge = random.integer(-1, 1);
  std::vector<Vec2> wall =
      random.integer(0, 4) == 0
          ? std::vector<Vec2>{touched, 2.0 * touched + geometry::perp(outward)}
          : std::vector<Vec2>{touched + 3.0 * geometry::perp(outward), touched - 2.0 * geometry::perp(outward)};
  for (Vec2& p : wall) {
    p += centre + at;
    // Near 0 an ulp is nothing that the oracle sees.
    double& across = outward.x != 0.0 ? p.x : p.y;
    const double way = nudge * (outward.x + outward.y);
    across = across == 0.0 ? way * 0x1p-60 : std::nextafter(across, across + way);
  }
  const double once = 2.0 * geometry::kPi / std::fabs(turn);
  const double duration = is_full ? once * random.uniform(0.99, 3.0) : random.uniform(0.02, 1.1) * once;
  return {{0.0, duration, at, twist}, {{corners, radius}}, {wall, 0.0}};
}

/// Once round and more, beside something: at random, on the spot, or grazing.
TurningCase random_full_turn(SeededRandom& random) {
  if (random.integer(0, 1)) return grazing_turn(random, random.integer(0, 1) != 0, true);
  TurningCase c = random_twist(random);
  if (random.integer(0, 1)) c.motion.twist.velocity = {};
  const double turn = random.uniform(0.5, 3.0);
  c.motion.twist.turn = random.integer(0, 1) ? turn : -turn;
  // To an ulp once round, or more.
  const double once = 2.0 * geometry::kPi / turn;
  c.motion.start = 0.0;
  c.motion.end =
      random.integer(0, 3) ? once * random.uniform(1.0, 4.0) : std::nextafter(once, random.integer(0, 1) * 9.0);
  return c;
}

/// A polygon, or two, that turns beside a polygon or a wall.
TurningCase random_turning_polygon(SeededRandom& random) {
  if (random.integer(0, 1)) return grazing_turn(random, true, false);
  TurningCase c = random_twist(random);
  c.body.clear();
  for (int k = random.integer(1, 2); k > 0; --k) {
    const Vec2 shift = random.in_box(0.6);
    std::vector<Vec2> corners{{0.3, 0.0}, {0.0, 0.2}, {-0.1, -0.1}};
    for (int i = random.integer(0, 4); i > 0; --i) corners.push_back(random.in_box(0.7));
    for (Vec2& p : corners) p += shift;
    c.body.push_back({geometry::convex_hull(corners).vertices, 0.0});
  }
  return c;
}

std::string text_of(const RoundedPolygon& part) {
  return " " + hex_text(part.radius) + " " + geometry::to_string(part.corners);
}

}  // namespace

std::vector<Vec2> random_hull(SeededRandom& random, int least, int most, double size) {
  std::vector<Vec2> points;
  const int n = random.integer(least, most);
  for (int i = 0; i < n; ++i) points.push_back(random.in_box(size));
  return geometry::convex_hull(points).vertices;
}

std::string line_of(const TurningCase& c) {
  const TurningMotion& m = c.motion;
  std::string text = "turning " + hex_text(m.start) + " " + hex_text(m.end) + " at " +
                     geometry::to_string({m.at, m.twist.velocity}) + " turn " + hex_text(m.twist.turn) + " body";
  for (const RoundedPolygon& part : c.body) text += text_of(part);
  return text + " beside" + text_of(c.piece);
}

const char* name_of(TurningKind kind) {
  static const char* const kNames[] = {"twists", "drives", "turning-polygons", "full-turns"};
  return kNames[static_cast<int>(kind)];
}

TurningCase random_turning_case(SeededRandom& random, TurningKind kind) {
  switch (kind) {
    case TurningKind::twists:
      return random.integer(0, 3) ? random_twist(random) : grazing_turn(random, false, false);
    case TurningKind::drives:
      return random_drive(random);
    case TurningKind::turning_polygons:
      return random_turning_polygon(random);
    case TurningKind::full_turns:
      return random_full_turn(random);
  }
  throw std::logic_error("unknown kind");
}

void judge_turning(const TurningCase& c, MotionCampaign& campaign, bool proof_too) {
  const auto wrong = [&](const std::string& text) { campaign.failures.push_back(text + ":\n" + line_of(c)); };
  const Encounter expected = oracle(c);
  campaign.count(expected);
  const auto judge = [&](const char* as, Encounter found) {
    if (found != expected) wrong(std::string(as) + ": expected " + word(expected) + ", found " + word(found));
  };
  const bool is_obstacle = c.piece.radius == 0.0 && c.piece.corners.size() > 1;
  geometry::reset_stage_counts();
  if (!is_obstacle) {
    judge("a body", encounter(c.motion, c.body, RigidBody{c.piece}, Vec2{}));
  } else {
    const Obstacle obstacle =
        c.piece.corners.size() == 2 ? Obstacle(Polyline{c.piece.corners}) : Obstacle(Polygon{c.piece.corners, {}});
    judge("an obstacle", encounter(c.motion, c.body, obstacle));
    if (c.piece.corners.size() > 2) judge("a body", encounter(c.motion, c.body, RigidBody{c.piece}, Vec2{}));
    const bool is_short = std::fabs(c.motion.twist.turn) * (c.motion.end - c.motion.start) < 63.0;
    if (proof_too && is_short) {
      const auto certificate = certify(c.motion, c.body, obstacle);
      if (certificate && expected != Encounter::clear) wrong("a certificate of what is not clear");
      if (certificate && !proves_clear(*certificate, c.motion, c.body, obstacle))
        wrong("a certificate that proves nothing");
      campaign.clearances += certificate ? 1 : 0;
    }
  }
  campaign.by_filter += geometry::stage_counts().filter;
  campaign.exactly += geometry::stage_counts().exact;
}

MotionCampaign judge_turnings(TurningKind kind, std::size_t count, std::uint64_t seed, std::size_t proof_of_each) {
  return judge_cases([&](SeededRandom& random) { return random_turning_case(random, kind); }, count, seed,
                     proof_of_each, &judge_turning);
}

}  // namespace exactvo::test
