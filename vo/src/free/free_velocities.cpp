// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/free_velocities.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "exactvo/geometry/hull.h"
#include "exactvo/geometry/pi.h"
#include "exactvo/geometry/require.h"
#include "exactvo/geometry/rounding.h"
#include "exactvo/vo/certificate.h"

namespace exactvo::vo::detail {
namespace {

// --- Polygons inside and outside a shifted cone, and the same of a disc of velocities ---

/// Where the polygons are wanted: |v| <= speed, the curves followed to `tolerance` m/s.
struct Window {
  double speed;
  double tolerance;
};

/// The square that holds every region: its half-width is this many speeds.
inline constexpr double kReach = 1.5;
using geometry::GrownShape;
using geometry::kUnitRoundoff;
using geometry::Region;

Vec2 at_angle(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// A regular polygon of this many corners stays within the tolerance of its circle: 1 - cos(pi/k) <= (pi/k)^2 / 2.
int corners_of_circle(const Window& window) {
  const double asked = geometry::kPi / std::sqrt(2.0 * window.tolerance / window.speed);
  constexpr double kFewest = 16.0;
  return static_cast<int>(std::ceil(std::max(asked, kFewest)));
}

// --- The normals at which a cone is touched ---

/// m/s: points farther out are left out, so that what is built of them stays within geometry::kLargestRegionCoordinate.
constexpr double kFarthest = geometry::kLargestRegionCoordinate / 16.0;

struct Contact {
  double angle;  ///< of the outward normal
  Vec2 at;       ///< m/s, relative: the point of S / tau there, rounded
};

/// The arc of normals from the left leg's over the cut-off's to the right leg's, counter-clockwise, divided until the
/// triangles between neighbouring contacts are lower than the tolerance or lie outside the square.
///
///              . tip                  height <= chord/2 tan(theta/2), theta the angle between the normals
///          .       .
///      a ------------- b
class Cutoff {
 public:
  Cutoff(const ShiftedCone& cone, const Legs& legs, const Window& window)
      : s_(cone.cone.grown()),
        scale_(1.0 / cone.cone.time_horizon()),
        apex_(cone.apex),
        half_width_(kReach * window.speed),
        lowest_(std::max(window.tolerance, rounding(legs.left.normal))) {
    const double first = std::atan2(legs.left.normal.y, legs.left.normal.x);
    const double turn =
        std::atan2(cross(legs.left.normal, legs.right.normal), dot(legs.left.normal, legs.right.normal));
    const Contact left{first, scale_ * legs.left.touch}, right{first + turn, scale_ * legs.right.touch};
    contacts_.push_back(left);
    Contact from = left;
    for (const double angle : edge_normals(first, turn)) {
      const Contact to = contact(angle);
      refine(from, to, kMostHalvings);
      from = to;
    }
    refine(from, right, kMostHalvings);
  }

  const std::vector<Contact>& contacts() const { return contacts_; }

 private:
  static constexpr int kMostHalvings = 48;  ///< of at most half a turn: finer angles than that are rounding

  Contact contact(double angle) const { return {angle, scale_ * support_point(s_, at_angle(angle))}; }

  /// How far a contact may be off: lower triangles are made of rounding.
  double rounding(Vec2 n) const {
    return scale_ * geometry::kSupportError * support(s_, n).magnitude + 4.0 * kUnitRoundoff * norm(apex_);
  }

  void refine(const Contact& a, const Contact& b, int halvings) {
    const double height = 0.5 * norm(b.at - a.at) * std::tan(0.5 * (b.angle - a.angle));
    if (!(height > lowest_) || halvings == 0 || is_out_of_reach(a, b, height)) {
      contacts_.push_back(b);
      return;
    }
    const Contact middle = contact(0.5 * (a.angle + b.angle));
    refine(a, middle, halvings - 1);
    refine(middle, b, halvings - 1);
  }

  /// Whether a line along a side of the triangle or of the square has the two on different sides. Rounded: a wrong
  /// answer costs width, no proof.
  bool is_out_of_reach(const Contact& a, const Contact& b, double height) const {
    constexpr double kWidest = 1.0;  // rad; below, the tip lies over the chord
    if (!(b.angle - a.angle < kWidest)) return false;
    const Vec2 p = apex_ + a.at, q = apex_ + b.at;
    return least_of_square(at_angle(a.angle)) > dot(at_angle(a.angle), p) ||
           least_of_square(at_angle(b.angle)) > dot(at_angle(b.angle), q) ||
           least_of_square(geometry::perp(q - p)) > dot(geometry::perp(q - p), p) ||
           std::min(p.x, q.x) - height > half_width_ || std::max(p.x, q.x) + height < -half_width_ ||
           std::min(p.y, q.y) - height > half_width_ || std::max(p.y, q.y) + height < -half_width_;
  }

  /// The least n.v of the square.
  double least_of_square(Vec2 n) const { return -half_width_ * (std::fabs(n.x) + std::fabs(n.y)); }

  /// A normal a little to either side of each edge's, so that an edge costs two contacts and no halvings.
  std::vector<double> edge_normals(double first, double turn) const {
    constexpr double kBeside = 0x1p-30;  // rad: far above the rounding of an angle, and a triangle as flat as 2^-31
    std::vector<double> angles;
    std::vector<Vec2> v;
    if (const auto* p = std::get_if<geometry::ConvexPolygon>(&s_.shape)) v = p->vertices;
    if (const auto* g = std::get_if<geometry::Segment>(&s_.shape)) v = {g->a, g->b};
    const Vec2 start = at_angle(first);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec2 outward = -geometry::perp(v[(i + 1) % v.size()] - v[i]);
      const double beyond = std::atan2(cross(start, outward), dot(start, outward));
      if (!(beyond > kBeside && beyond < turn - kBeside)) continue;
      angles.push_back(first + beyond - kBeside);
      angles.push_back(first + beyond + kBeside);
    }
    std::sort(angles.begin(), angles.end());
    return angles;
  }

  const GrownShape& s_;
  double scale_;  ///< 0 for a cone without end: every contact is the apex
  Vec2 apex_;
  double half_width_;  ///< m/s, of the square
  double lowest_;      ///< m/s: triangles are not divided below
  std::vector<Contact> contacts_;
};

/// The half-plane with its offset moved to where it parts the square from nothing: the same within the square.
geometry::HalfPlane within_reach(const geometry::HalfPlane& h, const Window& window) {
  constexpr double kBeyond = 4.0;  // > 1.5 sqrt(2): |n.v| of the square, in speeds times |n|
  const double limit = kBeyond * window.speed * norm(h.normal);
  if (!(limit > 0.0)) return h;
  return {h.normal, std::clamp(h.offset, -limit, limit)};
}

geometry::ConvexPolygon square_of(const Window& window) {
  const double r = kReach * window.speed;
  return {{{-r, -r}, {r, -r}, {r, r}, {-r, r}}};
}

// --- From outside: certified half-planes ---

/// n.v <= c + n.apex for all v of the cone, rounded up; as the half-plane that keeps them. A term passes at most 8
/// roundings: the apex is a sum of three vectors at most.
geometry::HalfPlane keeping(Vec2 n, double c, const ShiftedCone& cone, const Window& window) {
  double value = c, magnitude = geometry::product_magnitude(1.0, c);
  for (const Vec2 m : cone.minus_apex.terms) {
    value -= dot(n, m);
    magnitude += geometry::dot_magnitude(n, m);
  }
  return within_reach({-n, -geometry::rounded_up_sum(value, magnitude, 8.0)}, window);
}

/// h_S(n) <= h_up <= 0 makes n.w <= h_up / tau on the relative cone.
std::optional<geometry::HalfPlane> keeping_beyond(double angle, const ShiftedCone& cone, const Window& window) {
  constexpr double kFinite = 0x1p1000;  // so that a horizon near 0 leaves room for the terms
  const Vec2 n = at_angle(angle);
  const double h_up = support_upper_bound(cone.cone.grown(), n);
  if (!(h_up <= 0.0)) return std::nullopt;
  const double c = std::max(h_up / cone.cone.time_horizon(), -kFinite);
  return keeping(n, c * (1.0 - 4.0 * kUnitRoundoff), cone, window);
}

// --- From inside: points that are exactly in the cone ---

/// p, or a point between it and `deep` that is exactly inside: the cone is convex, so what lies between is inside too.
void add_inside(const ShiftedCone& cone, Vec2 p, Vec2 deep, std::vector<Vec2>& points) {
  constexpr double kFew = 4.0;      // roundings of p; and by what the steps grow
  constexpr double kLast = 0x1p-4;  // of the way: a point still outside there was no point of this cone's boundary
  if (!(norm(p) < kFarthest)) return;
  if (cone.contains(p)) {
    points.push_back(p);
    return;
  }
  const double first = kFew * kUnitRoundoff * (norm(p) + norm(cone.apex)) / norm(deep - p);
  for (double share = std::max(first, kUnitRoundoff * kUnitRoundoff); share < kLast; share *= kFew) {
    const Vec2 nudged = p + share * (deep - p);
    if (!cone.contains(nudged)) continue;
    points.push_back(nudged);
    return;
  }
}

/// The cone's directions without end: from the left leg's so far clockwise; where no legs certify, the half-plane of a
/// robot in bare contact.
struct Opening {
  Vec2 left;
  double turn;  ///< rad, > 0
};

std::optional<Opening> opening_of(const ShiftedCone& cone, const std::optional<Legs>& legs) {
  if (legs) {
    const Vec2 left = legs->left.direction, right = legs->right.direction;
    return Opening{left, std::fabs(std::atan2(cross(left, right), dot(left, right)))};
  }
  const std::optional<geometry::HalfPlane> away = cone.cone.contact_half_plane();
  if (!away) return std::nullopt;
  return Opening{-geometry::perp(away->normal), geometry::kPi};
}

/// Its directions, at most a sixth of a turn apart.
std::vector<Vec2> fan(const Opening& opening) {
  constexpr double kStep = 1.0;  // rad
  const int steps = 1 + static_cast<int>(opening.turn / kStep);
  std::vector<Vec2> directions;
  for (int i = 0; i <= steps; ++i) directions.push_back(geometry::rotated(opening.left, -opening.turn * i / steps));
  return directions;
}

std::vector<Contact> contacts_of(const ShiftedCone& cone, const Legs& legs, const Window& window) {
  return Cutoff(cone, legs, window).contacts();
}

/// Where the hull's near corners are wanted: the contacts, or where there are no legs, the point nearest to the robot.
std::vector<Vec2> near_corners(const ShiftedCone& cone, const std::optional<Legs>& legs, const Window& window) {
  std::vector<Vec2> corners;
  if (legs) {
    for (const Contact& contact : contacts_of(cone, *legs, window)) corners.push_back(contact.at);
  } else {
    const VelocityObstacle::Nearest nearest = cone.cone.nearest();
    corners.push_back((-nearest.distance / cone.cone.time_horizon()) * nearest.normal);
  }
  return corners;
}

/// So far out that chords between directions a radian apart stay beyond the square, (|apex| + 1.5 sqrt(2) speed) /
/// cos(1/2), and beyond the cut-off in every direction: it lies in the triangle of the apex and its two ends.
double far_out(const ShiftedCone& cone, const std::vector<Vec2>& near, const Window& window) {
  double far = 3.0 * window.speed + 2.0 * norm(cone.apex);
  for (const Vec2 p : {near.front(), near.back()})
    if (norm(p) < kFarthest) far = std::max(far, 2.0 * norm(p));
  return std::min(far, 0.5 * kFarthest);
}

std::vector<geometry::HalfPlane> sides_of_square(const Window& window) {
  const double r = kReach * window.speed;
  return {{{1.0, 0.0}, -r}, {{-1.0, 0.0}, -r}, {{0.0, 1.0}, -r}, {{0.0, -1.0}, -r}};
}

/// { v : |v| <= speed }, from inside and from outside.
Region disc_from_inside(const Window& window) {
  const int count = corners_of_circle(window);
  const GrownShape disc{geometry::Disc{{}, window.speed}, {}, 0.0};
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * geometry::kPi * i / count;
    Vec2 p = window.speed * at_angle(angle);
    while (locate(disc, p) == geometry::Place::outside) p = (1.0 - 4.0 * kUnitRoundoff) * p;
    points.push_back(p);
  }
  return Region::hull_of(points);
}

Region disc_from_outside(const Window& window) {
  const int count = corners_of_circle(window);
  std::vector<geometry::HalfPlane> keep;
  for (int i = 0; i < count; ++i) {
    const Vec2 n = at_angle(2.0 * geometry::kPi * i / count);
    keep.push_back({-n, -window.speed * norm(n) * (1.0 + 8.0 * kUnitRoundoff)});  // a root, two products, a sum
  }
  return Region::cut(square_of(window), keep);
}

Region cone_from_outside(const ShiftedCone& cone, const Window& window) {
  const std::optional<Legs> legs = cone.cone.legs();
  std::vector<geometry::HalfPlane> keep;
  if (legs) {
    keep = {keeping(legs->left.normal, 0.0, cone, window), keeping(legs->right.normal, 0.0, cone, window)};
    for (const Contact& contact : contacts_of(cone, *legs, window))
      if (const auto h = keeping_beyond(contact.angle, cone, window)) keep.push_back(*h);
  } else if (const auto away = cone.cone.contact_half_plane()) {
    keep.push_back(keeping(away->normal, 0.0, cone, window));
  }
  return Region::cut(square_of(window), keep);
}

/// The cone within the square. Certified: every point of the first lies in it, and all of its points in the square in
/// the second. Where no legs certify, the line away from the nearest point takes their place; where that does not
/// either, nothing and the whole square. REQUIRES: !cone.cone.overlaps().
Region cone_from_inside(const ShiftedCone& cone, const Window& window) {
  const std::optional<Legs> legs = cone.cone.legs();
  const std::optional<Opening> opening = opening_of(cone, legs);
  if (!opening) return {};
  const std::vector<Vec2> near = near_corners(cone, legs, window);
  const double far = far_out(cone, near, window);
  const Vec2 deep = cone.apex + 2.0 * far * geometry::rotated(opening->left, -0.5 * opening->turn);
  std::vector<Vec2> points;
  for (const Vec2 at : near) add_inside(cone, cone.apex + at, deep, points);
  const Vec2 corner = legs ? cone.apex : cone.apex + near.front();
  for (const Vec2 d : fan(*opening)) add_inside(cone, corner + far * d, deep, points);
  if (points.size() < 3) return {};
  return Region::cut(geometry::convex_hull(points), sides_of_square(window));
}

}  // namespace
}  // namespace exactvo::vo::detail

namespace exactvo::vo {
namespace {

using geometry::Region;

detail::Window window_of(const FreeVelocityOptions& options) {
  return {options.max_speed, options.relative_tolerance * options.max_speed};
}

void require_in_range(const FreeVelocityOptions& o) {
  EXACTVO_REQUIRE(o.max_speed >= kLeastMaxSpeed && o.max_speed <= kMostMaxSpeed, std::to_string(o.max_speed));
  EXACTVO_REQUIRE(o.relative_tolerance >= 1e-7 && o.relative_tolerance <= 0.1, std::to_string(o.relative_tolerance));
}

void require_in_range(const ShiftedCone& cone) {
  for (const Vec2 m : cone.minus_apex.terms)
    EXACTVO_REQUIRE(std::fabs(m.x) <= kMostApex && std::fabs(m.y) <= kMostApex,
                    std::to_string(m.x) + ", " + std::to_string(m.y));
}

std::vector<HalfPlane> within_reach(const std::vector<HalfPlane>& half_planes, const detail::Window& window) {
  std::vector<HalfPlane> out;
  for (const HalfPlane& h : half_planes) out.push_back(detail::within_reach(h, window));
  return out;
}

/// Half-planes over a region that holds the disc, in one cut.
Region kept(const Region& disc, const std::vector<HalfPlane>& half_planes, const detail::Window& window) {
  return disc.intersection(Region::cut(detail::square_of(window), half_planes));
}

/// Whether the apex is a double: apex and minus_apex add up to nothing.
bool apex_is_exact(const ShiftedCone& cone) {
  return geometry::rounded({{cone.apex, cone.minus_apex.terms[0], cone.minus_apex.terms[1]}}) == Vec2{} &&
         cone.minus_apex.terms[2] == Vec2{};
}

bool excludes(const HalfPlane& h, const ShiftedCone& cone) {
  const geometry::GrownShape& s = cone.cone.grown();
  return is_true({s.shape, s.origin, s.radius, cone.cone.time_horizon(), cone.apex, h});
}

Vec2 farthest_out(const geometry::Polygon& polygon, const HalfPlane& h) {
  return *std::max_element(polygon.outer.begin(), polygon.outer.end(),
                           [&](Vec2 a, Vec2 b) { return violation(h, a) < violation(h, b); });
}

/// The half-plane that excludes most of the piece, by area.
std::size_t blamed(const Region& piece, double area, const std::vector<HalfPlane>& half_planes) {
  std::size_t worst = 0;
  double most = -1.0;
  for (std::size_t k = 0; k < half_planes.size(); ++k) {
    const double excluded = area - piece.cut(half_planes[k]).area().low;
    if (excluded > most) {
      most = excluded;
      worst = k;
    }
  }
  return worst;
}

}  // namespace

const char* name(Inside answer) {
  return answer == Inside::yes ? "yes" : answer == Inside::no ? "no" : "undecided";
}

FreeVelocities::FreeVelocities(std::vector<ShiftedCone> cones, const FreeVelocityOptions& options)
    : cones_(std::move(cones)), options_(options) {
  require_in_range(options);
  const detail::Window window = window_of(options_);
  disc_inside_ = detail::disc_from_inside(window);
  disc_outside_ = detail::disc_from_outside(window);
  inner_ = disc_inside_;
  outer_ = disc_outside_;
  for (const ShiftedCone& cone : cones_) {
    require_in_range(cone);
    const bool overlaps = cone.cone.overlaps();
    const Region whole = Region::cut(detail::square_of(window), {});
    from_inside_.push_back(overlaps ? whole : detail::cone_from_inside(cone, window));
    from_outside_.push_back(overlaps ? whole : detail::cone_from_outside(cone, window));
    inner_ = inner_.difference(from_outside_.back());
    outer_ = outer_.difference(from_inside_.back());
  }
}

bool FreeVelocities::contains(Vec2 v) const {
  const geometry::GrownShape disc{geometry::Disc{{}, options_.max_speed}, {}, 0.0};
  if (locate(disc, v) == geometry::Place::outside) return false;
  return std::none_of(cones_.begin(), cones_.end(),
                      [v](const ShiftedCone& c) { return c.cone.overlaps() || c.contains(v); });
}

geometry::Bracket FreeVelocities::area() const {
  return {inner_.area().low, outer_.area().high};
}

std::size_t FreeVelocities::least_components() const {
  const std::vector<Region::Piece> outer = outer_.pieces();
  return static_cast<std::size_t>(std::count_if(outer.begin(), outer.end(), [&](const Region::Piece& piece) {
    return !piece.region.intersection(inner_).is_empty();
  }));
}

bool FreeVelocities::proven_by_certificates(const std::vector<HalfPlane>& half_planes) const {
  return std::all_of(cones_.begin(), cones_.end(), [&](const ShiftedCone& cone) {
    return !cone.cone.overlaps() && apex_is_exact(cone) &&
           std::any_of(half_planes.begin(), half_planes.end(), [&](const HalfPlane& h) { return excludes(h, cone); });
  });
}

RegionReport FreeVelocities::compare(const std::vector<HalfPlane>& unclipped) const {
  const detail::Window window = window_of(options_);
  const std::vector<HalfPlane> half_planes = within_reach(unclipped, window);
  RegionReport report;
  const Region from_inside = kept(disc_inside_, half_planes, window);
  report.region = kept(disc_outside_, half_planes, window);
  report.area = {from_inside.area().low, report.region.area().high};
  const auto cut_into = [&](const Region& cone) { return !from_inside.intersection(cone).is_empty(); };
  if (std::any_of(from_inside_.begin(), from_inside_.end(), cut_into)) report.inside = Inside::no;
  const auto misses = [&](const Region& cone) { return report.region.intersection(cone).is_empty(); };
  if (proven_by_certificates(unclipped) || std::all_of(from_outside_.begin(), from_outside_.end(), misses))
    report.inside = Inside::yes;
  const Region lost = inner_.difference(report.region);
  report.given_away = {lost.area().low, outer_.difference(from_inside).area().high};
  for (Region::Piece& piece : lost.pieces()) {
    if (piece.area.high < window.tolerance * window.speed) break;
    LostPiece out{std::move(piece.polygon), piece.area, {}, 0};
    if (!half_planes.empty()) {
      out.half_plane = blamed(piece.region, piece.area.high, half_planes);
      out.farthest = farthest_out(out.polygon, unclipped[out.half_plane]);
    }
    report.lost.push_back(std::move(out));
  }
  return report;
}

}  // namespace exactvo::vo
