// SPDX-License-Identifier: GPL-3.0-or-later
#include "liveness/reservations.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "liveness/split_mix.h"
#include "liveness/sweeps.h"

namespace exactvo::formation::detail {

namespace {

// Found by measuring. Safety does not depend on them, liveness on the order of kKeptFromOthers, the first and
// kPlaceReached only.

// Diameters of the widest robot.
/// What robots that drive keep from others besides the radii.
constexpr double kDrivenMargin = 2e-3;
static_assert(kPlaceReached < kKeptFromOthers - kDrivenMargin, "who has all but reached its place is in nobody's way");
/// What ways keep beside the radius from obstacles, unless they begin or end nearer to one.
constexpr double kWallMargin = 5e-4;
/// Boxes are wider than what distances, which are rounded, are compared with.
constexpr double kBeyondRounding = 1.0 + 1e-6;
/// By how much a robot may leave its way before all ways are looked at anew. Any number serves.
constexpr double kStrays = 1e-3;
/// Between places.
constexpr double kPlacePitch = 1.06;
/// A place that is not as much nearer to the goal does not count as nearer.
constexpr double kLeastNearer = 0.01;
/// Without anything ahead as near as that a robot needs no reservation.
constexpr double kAhead = 2.6;

// m.
/// What clearances are rounded by.
constexpr double kWallRounding = 1e-7;

// Pitches.
constexpr double kLongestDrive = 1.61;
constexpr double kWidestRows = 1.2;
constexpr double kCostOfPushing = 0.2, kCostOfPushingOn = 0.6;
/// The cost of a place where the robot that pushes would push it again next, as far ahead of that as `kFarAhead`.
constexpr double kCostOfBeingAhead = 1.0, kFarAhead = 2.0;
/// As near to a wall a robot can also drive straight along its row.
constexpr double kBesideWall = 0.1;
constexpr int kMostRows = 5;
/// Share of a pitch: nearer, the robot stands on the place.
constexpr double kStandsOn = 0.01;

/// s, and the share of the way at full speed that a robot must have come nearer to its goal in them, or has stalled.
constexpr double kStall = 2.5, kProgress = 0.2;
/// s without anything ahead, after which a robot needs no reservation.
constexpr double kFree = 1.0;
/// Share of its greatest speed: a faster robot without a reservation passes by itself.
constexpr double kInMotion = 0.35;
/// After this many tries in vain the places of pushed robots come in changing order.
constexpr std::uint32_t kShakeAfter = 10;
/// So do they, less changed, for each fourth time that a robot is pushed off its goal: else some may push each other
/// off their goals in a cycle for ever.
constexpr std::uint32_t kShakeEvery = 4;
/// Pitches: by how much costs change.
constexpr double kShaken = 2.0, kShakenAtGoals = 1.0;
/// After as many in vain a robot goes anywhere.
constexpr std::uint32_t kRestlessEvery = 32;
/// After as many nothing is new.
constexpr std::uint32_t kGivesUpAfter = 512;
/// Robots that push each other in a row.
constexpr std::size_t kLongestRow = 200;
/// Pushed by one.
constexpr std::size_t kMostPushed = 8;

double squared(double x) {
  return x * x;
}

Vec2 left_of(Vec2 a) {
  return {-a.y, a.x};
}

/// Whether the sweep from `p` to `q` comes within `keep` of a robot that stands at `o` until it has been left behind:
/// a robot that is nearer at first must not come nearer.
bool comes_near_until_left(Vec2 p, Vec2 q, Vec2 o, double keep) {
  if (squared_norm(p - o) < keep * keep) return dot(q - p, p - o) < 0.0;
  return squared_distance(o, p, q) < keep * keep;
}

/// The same for a robot that stays.
bool comes_near(Vec2 p, Vec2 q, Vec2 o, double keep) {
  return comes_near_until_left(p, q, o, keep) || squared_norm(q - o) < keep * keep;
}

/// A square lattice.
PlaceRows open_rows(double pitch) {
  return {{}, {1.0, 0.0}, {0.0, 1.0}, pitch, pitch, 0};
}

}  // namespace

PlaceRows rows_about(const ObstacleSpace& space, Vec2 place, double radius, double pitch) {
  constexpr int kMostLooks = 24;
  constexpr double kOpposite = 0.98;   // cosine
  constexpr double kRounding = 0.999;  // of steps that cross no wall
  constexpr double kOffWall = 1e-3;    // pitches
  const PlaceRows open = open_rows(pitch);
  if (space.is_open()) return open;
  const double widest = kMostRows * pitch, reach = 0.5 * widest + radius;
  const Vec2 from_wall = space.from_nearest_edge(place, reach);
  const double off = norm(from_wall);
  if (off == 0.0) return open;
  const Vec2 across = from_wall / off;
  // On to the wall on the other side, never farther at once than there is room.
  double ahead = 0.0, width = -1.0;
  for (int k = 0; k < kMostLooks && ahead < widest; ++k) {
    const Vec2 from = space.from_nearest_edge(place + ahead * across, reach);
    const double room = norm(from);
    if (room == 0.0) return open;
    if (dot(from, across) < -kOpposite * room) {
      width = off + ahead + room - 2.0 * radius - 2.0 * kOffWall * pitch;
      break;
    }
    ahead += kRounding * room;
  }
  if (width < -2.0 * kOffWall * pitch || width >= widest) return open;
  PlaceRows rows;
  rows.across = across;
  rows.along = -left_of(across);
  rows.column = pitch;
  rows.rows = static_cast<int>(std::max(width, 0.0) / pitch) + 1;
  rows.row = rows.rows == 1 ? pitch : std::min(width / (rows.rows - 1), kWidestRows * pitch);
  const Vec2 middle = place + (radius + kOffWall * pitch + 0.5 * width - off) * across;
  rows.origin = middle - dot(middle, rows.along) * rows.along - 0.5 * (rows.rows - 1) * rows.row * across;
  return rows;
}

Reservations::Reservations(const ObstacleSpace& space, std::size_t robots, double time_step, double widest,
                           WhoReserves who)
    : space_(space),
      time_step_(time_step),
      diameter_(2.0 * widest),
      pitch_(kPlacePitch * diameter_),
      reach_(2.0 * kLongestDrive * pitch_ + (1.0 + kKeptFromOthers) * diameter_),
      who_(who),
      of_(robots),
      reserved_(robots, who == WhoReserves::all),
      places_(robots),
      preferred_(robots),
      left_(robots),
      clear_(robots, 0),
      decided_(robots, 0),
      is_pushing_(robots, 0),
      ways_(robots) {
  std::size_t buckets = 1;
  while (buckets < robots) buckets *= 2;
  begin_.resize(buckets + 1);
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  placed_.resize(robots, {{kNowhere, kNowhere}});
  by_bucket_.resize(robots);
}

// --- Robots by place ---

/// std::floor is a call on targets before SSE4.1.
std::int64_t Reservations::cell(double x) const {
  constexpr double kFarthest = 0x1p62;
  const double cells = 2.0 * x / reach_, near = cells > kFarthest ? kFarthest : cells > -kFarthest ? cells : -kFarthest;
  const auto toward_zero = static_cast<std::int64_t>(near);
  return toward_zero - static_cast<std::int64_t>(static_cast<double>(toward_zero) > near);
}

std::size_t Reservations::bucket(std::int64_t x, std::int64_t y) const {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(y);
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93U;
  return (h ^ (h >> 32)) & (begin_.size() - 2);
}

/// Most robots stand where they stood.
void Reservations::place_robots() {
  std::fill(begin_.begin(), begin_.end(), 0);
  for (std::size_t i = 0; i < of_.size(); ++i) {
    Placed& p = placed_[i];
    if (p.at != at(i)) {
      p = {at(i), cell(at(i).x), cell(at(i).y), static_cast<std::uint32_t>(i), 0};
      p.bucket = static_cast<std::uint32_t>(bucket(p.cell_x, p.cell_y));
    }
    ++begin_[p.bucket];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& b : begin_) sum += b, b = sum;
  for (std::size_t i = of_.size(); i-- > 0;) by_bucket_[--begin_[placed_[i].bucket]] = placed_[i];
}

template <class Visit>
void Reservations::for_each_near(Vec2 here, double reach, const Visit& visit) const {
  const std::int64_t x0 = cell(here.x - reach), x1 = cell(here.x + reach);
  const std::int64_t y0 = cell(here.y - reach), y1 = cell(here.y + reach);
  for (std::int64_t y = y0; y <= y1; ++y)
    for (std::int64_t x = x0; x <= x1; ++x) {
      const std::size_t b = bucket(x, y);
      for (std::uint32_t k = begin_[b]; k < begin_[b + 1]; ++k) {
        const Placed& j = by_bucket_[k];
        if (j.cell_x == x && j.cell_y == y && squared_norm(j.at - here) <= reach * reach) visit(j.robot);
      }
    }
}

// --- Where robots stand ---

bool Reservations::is_moving(std::size_t i) const {
  return squared_norm(at(i) - places_[i]) > squared(kPlaceReached * diameter_);
}

std::uint64_t Reservations::steps_of(double seconds) const {
  return static_cast<std::uint64_t>(std::ceil(seconds / time_step_ - 1e-9));
}

/// m, along its course from there, whose farthest corner in sight is the nearest by the course.
double Reservations::way_from(std::size_t i, Vec2 place) const {
  const RobotUnderWay& r = (*robots_)[i];
  double rest = r.rest;
  for (std::size_t k = r.corners_ahead - 1; k > 0; --k) {
    if (sees(i, place, r.ahead[k])) return norm(r.ahead[k] - place) + rest;
    rest += norm(r.ahead[k] - r.ahead[k - 1]);
  }
  return norm(r.next() - place) + rest;
}

/// Whether its course goes on in sight of there.
bool Reservations::leads_on(std::size_t i, Vec2 place) const {
  const RobotUnderWay& r = (*robots_)[i];
  return std::any_of(r.ahead.begin(), r.ahead.begin() + static_cast<std::ptrdiff_t>(r.corners_ahead),
                     [&](Vec2 corner) { return sees(i, place, corner); });
}

bool Reservations::sees(std::size_t i, Vec2 from, Vec2 to) const {
  const double radius = (*robots_)[i].radius, there = space_.clearance(from, radius);
  return space_.is_clear(from, to, std::min(radius, there) - kWallRounding);
}

/// Whether a straight way there keeps off obstacles. Where the robot stands nearer to one it has to leave that at once:
/// along a wall that it touches rounding stops it.
bool Reservations::is_open(std::size_t i, Vec2 to) const {
  constexpr double kAway = 1e-3;  // sine of the angle with the wall
  if (space_.is_open()) return true;
  const Vec2 p = at(i), way = to - p;
  const double radius = (*robots_)[i].radius, wanted = radius + kWallMargin * diameter_;
  const double here = space_.clearance(p, wanted), there = space_.clearance(to, wanted);
  if (there < radius - kWallRounding || (there < wanted && to != (*robots_)[i].goal)) return false;
  if (here < wanted && !(there < wanted)) {
    const Vec2 from_wall = space_.from_nearest_edge(p, wanted);
    if (dot(way, from_wall) < kAway * norm(way) * norm(from_wall)) return false;
  }
  return space_.is_clear(p, to, std::min(here, there) - kWallRounding);
}

/// The place, or one as near to it as robots stand off walls.
Vec2 Reservations::off_walls(std::size_t i, Vec2 place) const {
  constexpr double kAndSome = 1.0 + 1e-6;
  const double wanted = ((*robots_)[i].radius + kWallMargin * diameter_) * kAndSome;
  const Vec2 from_wall = space_.from_nearest_edge(place, wanted);
  const double off = norm(from_wall);
  return off > 0.0 ? place + (wanted / off - 1.0) * from_wall : place;
}

// --- Who has a reservation ---

void Reservations::look_whether_stalled(std::size_t i) {
  OfRobot& of = of_[i];
  places_[i] = at(i);
  if ((*robots_)[i].yields) {
    of.has_way_then = 0;
    return;
  }
  if (of.is_at_goal) {
    of.has_way_then = 0;
    reserved_[i] = 1;
    return;
  }
  if (step_ - of.looked < steps_of(kStall) && of.has_way_then) return;
  const double way = way_from(i, at(i));
  const double least = kProgress * static_cast<double>(step_ - of.looked) * time_step_ * (*robots_)[i].max_speed;
  reserved_[i] = of.has_way_then && of.way_then - way < least;
  if (reserved_[i]) of.free_since = step_;
  of.has_way_then = 1;
  of.way_then = way;
  of.looked = step_;
}

bool Reservations::is_something_ahead(std::size_t i) const {
  const Vec2 on = (*robots_)[i].next() - at(i);
  bool is_any = false;
  for_each_near(at(i), kAhead * diameter_,
                [&](std::size_t j) { is_any = is_any || (j != i && dot(at(j) - at(i), on) >= 0.0); });
  return is_any;
}

/// REQUIRES: it stands on its place.
void Reservations::look_whether_free(std::size_t i) {
  if (who_ == WhoReserves::all || (of_[i].is_at_goal && !(*robots_)[i].yields)) return;
  if (!(*robots_)[i].yields && is_something_ahead(i)) {
    of_[i].free_since = step_;
  } else if ((*robots_)[i].yields || step_ - of_[i].free_since > steps_of(kFree)) {
    reserved_[i] = 0;
    of_[i].has_way_then = 0;
    places_[i] = at(i);
  }
}

/// The robot that was at its goal longer ago, or never, comes first, those that are there last.
bool Reservations::is_before(std::size_t a, std::size_t b) const {
  constexpr auto kLast = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t since_a = of_[a].is_at_goal ? kLast : of_[a].at_goal_last;
  const std::uint64_t since_b = of_[b].is_at_goal ? kLast : of_[b].at_goal_last;
  if (since_a != since_b) return since_a < since_b;
  const double far_a = squared_norm((*robots_)[a].goal - at(a)), far_b = squared_norm((*robots_)[b].goal - at(b));
  return far_a != far_b ? far_a < far_b : a < b;
}

std::uint64_t Reservations::patience() const {
  return steps_of(kStall) + steps_of(kFree) + 2;
}

void Reservations::look(const std::vector<RobotUnderWay>& robots) {
  robots_ = &robots;
  ++step_;
  has_changed_ = false;
  if (step_ == 1)
    for (std::size_t i = 0; i < of_.size(); ++i) places_[i] = at(i);
  bool has_placed = false;
  waiting_.clear();
  const std::uint64_t tickets = tickets_;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    OfRobot& of = of_[i];
    of.pushed_off += of.is_at_goal && !robots[i].is_at_goal;
    of.is_at_goal = robots[i].is_at_goal;
    if (of.is_at_goal || of.leg != robots[i].leg) of.at_goal_last = step_;
    of.leg = robots[i].leg;
    const bool had = reserved_[i];
    if (!had) look_whether_stalled(i);
    if (reserved_[i] && !has_placed) place_robots(), has_placed = true;
    if (reserved_[i] && !is_moving(i)) {
      look_whether_free(i);
      const bool rests =
          robots[i].is_at_goal && squared_norm(robots[i].goal - at(i)) <= squared(kPlaceReached * diameter_);
      if (reserved_[i] && !rests && !robots[i].yields) waiting_.push_back(static_cast<std::uint32_t>(i));
    }
    has_changed_ = has_changed_ || had != static_cast<bool>(reserved_[i]);
  }
  std::sort(waiting_.begin(), waiting_.end(), [this](std::size_t a, std::size_t b) { return is_before(a, b); });
  for (const std::uint32_t i : waiting_) {
    oldest_pusher_ = i;
    if (decided_[i] != step_) reserve(i, 0, i);
  }
  has_changed_ = has_changed_ || tickets_ != tickets;
  count_ = 0;
  for (std::size_t i = 0; i < of_.size(); ++i) left_[i] = reserved_[i] ? norm(places_[i] - at(i)) : 0.0;
  follow_ways();
  for (std::size_t i = 0; i < of_.size(); ++i) {
    count_ += reserved_[i];
    preferred_[i] = reserved_[i] ? preferred_of(i) : Vec2{};
  }
  robots_ = nullptr;
}

// --- Which place ---

bool Reservations::Outlook::is_of(std::size_t i, const RobotUnderWay& r) const {
  return robot == i && position == r.position && goal == r.goal && ahead == r.ahead &&
         corners_ahead == r.corners_ahead && rest == r.rest;
}

/// Where the robot could drive, as far as obstacles allow. It is the same as long as the robot stands.
const Reservations::Outlook& Reservations::outlook_of(std::size_t i) {
  constexpr std::size_t kMost = 0x4000;
  const RobotUnderWay& r = (*robots_)[i];
  if (outlooks_.empty()) outlooks_.resize(std::min(kMost, begin_.size() - 1));
  Outlook& out = outlooks_[i % outlooks_.size()];
  if (out.is_of(i, r)) return out;
  out.robot = i;
  out.position = r.position;
  out.goal = r.goal;
  out.ahead = r.ahead;
  out.corners_ahead = r.corners_ahead;
  out.rest = r.rest;
  look_about(i, out);
  return out;
}

void Reservations::look_about(std::size_t i, Outlook& out) const {
  const RobotUnderWay& r = (*robots_)[i];
  const Vec2 p = r.position;
  out.way = way_from(i, p);
  out.count = 0;
  const bool is_in_sight = leads_on(i, p);  // else anything nearer will do
  const auto add = [&](Vec2 place, bool pushes_nobody = false) {
    if (!is_open(i, place)) return;
    const double way = way_from(i, place);
    out.places[out.count++] = {
        place, way, way < out.way - kLeastNearer * diameter_ && (!is_in_sight || leads_on(i, place)), pushes_nobody};
  };
  const double to_goal = norm(r.goal - p), to_next = norm(r.next() - p);
  if (to_goal < kLongestDrive * pitch_) add(r.goal);
  if (to_next > kPlaceReached * diameter_)
    add(off_walls(i, p + std::min(1.0, pitch_ / to_next) * (r.next() - p)), true);
  const PlaceRows rows = rows_about(space_, p, r.radius, pitch_);
  const auto add_places = [&](const PlaceRows& of, const auto& may_add) {
    const double column = std::round(dot(p - of.origin, of.along) / of.column);
    double row = std::round(dot(p - of.origin, of.across) / of.row);
    if (of.rows > 0) row = std::clamp(row, 0.0, of.rows - 1.0);
    for (const double y : {row - 1.0, row, row + 1.0})
      for (const double x : {column - 1.0, column, column + 1.0}) {
        if (!of.has_row(y)) continue;
        const Vec2 place = of.place(x, y);
        const double far2 = squared_norm(place - p);
        if (far2 > squared(kStandsOn * pitch_) && far2 < squared(kLongestDrive * pitch_) && may_add(place)) add(place);
      }
    return norm(of.place(column, row) - p) <= kStandsOn * pitch_;
  };
  out.stands_on_place = add_places(rows, [](Vec2) { return true; });
  // Two robots side by side in the mouth of a passage touch its corners: all that they can do is to go straight.
  const double beside_wall = r.radius + kBesideWall * pitch_;
  if (!out.stands_on_place && space_.clearance(p, beside_wall) < beside_wall) {
    for (const Vec2 way : {rows.along, -rows.along}) add(p + pitch_ * way);
    if (rows.rows == 0)
      for (const Vec2 way : {rows.across, -rows.across}) add(p + pitch_ * way);
  }
  // Out of a passage it goes to places of the open.
  if (rows.rows > 0)
    add_places(open_rows(pitch_), [&](Vec2 place) { return rows_about(space_, place, r.radius, pitch_).rows == 0; });
}

/// Places that others stand on or drive to cost more.
double Reservations::cost_of_pushing(std::size_t i, Vec2 place, bool is_pushed, std::size_t near,
                                     std::size_t near_end) const {
  for (std::size_t k = near; k < near_end; ++k) {
    const double apart2 = squared_norm(places_[list_[k]] - place);
    if (apart2 >= diameter_ * diameter_) continue;
    const double keep = (*robots_)[i].radius + (*robots_)[list_[k]].radius - kPlaceReached * diameter_;
    if (apart2 < keep * keep) return (is_pushed ? kCostOfPushingOn : kCostOfPushing) * pitch_;
  }
  return 0.0;
}

/// Whether the robot may drive there; the robots that it must push for it are put behind the list of those near it.
bool Reservations::is_there_room(std::size_t i, const Option& to, std::size_t near, std::size_t near_end,
                                 std::size_t& pushed) {
  const RobotUnderWay& r = (*robots_)[i];
  const Vec2 p = r.position, q = to.place;
  list_.resize(near_end);
  pushed = 0;
  const double most = kBeyondRounding * (1.0 + kKeptFromOthers) * diameter_;
  const Vec2 low{std::min(p.x, q.x) - most, std::min(p.y, q.y) - most};
  const Vec2 high{std::max(p.x, q.x) + most, std::max(p.y, q.y) + most};
  for (std::size_t k = near; k < near_end; ++k) {
    const std::uint32_t j = list_[k];
    const RobotUnderWay& other = (*robots_)[j];
    const Vec2 from = other.position, to_place = places_[j];
    if (std::max(from.x, to_place.x) < low.x || std::min(from.x, to_place.x) > high.x ||
        std::max(from.y, to_place.y) < low.y || std::min(from.y, to_place.y) > high.y)
      continue;
    const double keep = r.radius + other.radius + kKeptFromOthers * diameter_;
    if (is_pushing_[j]) {  // sets out after this one
      if (comes_near_until_left(p, q, at(j), keep) || squared_distance(q, at(j), places_[j]) < keep * keep)
        return false;
    } else if (is_moving(j)) {  // drives before this one
      if (squared_distance({p, q}, {at(j), places_[j]}) < keep * keep && comes_near(p, q, places_[j], keep))
        return false;
    } else if (comes_near(p, q, at(j), keep) || comes_near(p, q, places_[j], keep)) {
      const bool passes = !reserved_[j] && norm(other.velocity) > kInMotion * other.max_speed;
      if (to.pushes_nobody || passes || decided_[j] == step_ || pushed == kMostPushed) return false;
      list_.push_back(j);
      ++pushed;
    }
  }
  return true;
}

bool Reservations::try_place(std::size_t i, const Option& to, std::size_t near, std::size_t depth) {
  const std::size_t near_end = list_.size();
  std::size_t pushed = 0;
  bool has_room = is_there_room(i, to, near, near_end, pushed);
  if (has_room) {
    const Vec2 before = places_[i];
    places_[i] = to.place;
    for (std::size_t k = 0; k < pushed && has_room; ++k) {
      const std::uint32_t j = list_[near_end + k];
      has_room = depth < kLongestRow && decided_[j] != step_ && reserve(j, depth + 1, i);
    }
    if (!has_room) places_[i] = before;
  }
  list_.resize(near_end);
  return has_room;
}

/// A place for the robot, if there is one; then those that it pushes have one too. `depth`: how many push in a row,
/// the last of them `pusher`; 0: none does.
bool Reservations::reserve(std::size_t i, std::size_t depth, std::size_t pusher) {
  decided_[i] = step_;
  const std::size_t near = list_.size();
  for_each_near(at(i), reach_, [&](std::uint32_t j) {
    if (j != i) list_.push_back(j);
  });
  is_pushing_[i] = 1;
  const bool found = find_place(i, near, depth, pusher);
  is_pushing_[i] = 0;
  list_.resize(near);
  if (found) {
    reserved_[i] = 1;
    of_[i].in_vain = 0;
    of_[i].ticket = ++tickets_;
  } else if (of_[i].in_vain < kGivesUpAfter) {
    ++of_[i].in_vain;
    has_changed_ = true;
  }
  return found;
}

/// Where the pusher drives on it would push the robot again, all the way ahead of it: two that have to change places
/// would push each other to and fro.
void Reservations::weigh_way_of_pusher(std::size_t i, std::size_t pusher, Options& options) const {
  constexpr double kRounding = 1.0 - 1e-6;  // a place that just leaves the pusher's way is out of it
  const double keep = kRounding * ((*robots_)[i].radius + (*robots_)[pusher].radius + kKeptFromOthers * diameter_);
  const Vec2 from = places_[pusher], on = (*robots_)[pusher].next() - from;
  const double far = norm(on), reach = kFarAhead * pitch_;
  const Vec2 to = from + (far > reach ? reach / far : 1.0) * on;
  for (std::size_t k = 0; k < options.count; ++k)
    if (squared_distance(options.all[k].place, from, to) < keep * keep)
      options.all[k].cost += kCostOfBeingAhead * pitch_;
}

/// Near its goal a robot steps out of the pusher's way no farther than it must, so that it is back soon. At a place of
/// the lattice it would stand at the goals of others, which are pushed off these: where goals lie close, for ever.
void Reservations::add_steps_aside(std::size_t i, std::size_t pusher, std::size_t near, Options& options) const {
  constexpr double kRounding = 1.0 + 1e-9;
  const RobotUnderWay& r = (*robots_)[i];
  if (squared_norm(r.goal - r.position) >= squared(pitch_)) return;
  const double keep = kRounding * (r.radius + (*robots_)[pusher].radius + kKeptFromOthers * diameter_);
  const Vec2 from = at(pusher), way = places_[pusher] - from;
  const double length = norm(way);
  if (length == 0.0) return;
  const Vec2 on = way / length, nearest = from + std::clamp(dot(at(i) - from, on), 0.0, length) * on;
  const Vec2 away = at(i) - nearest;
  const double off = norm(away);
  const std::array<Vec2, Options::kMostAside> ways = {off > 0.0 ? away / off : on, left_of(on), -left_of(on)};
  for (const Vec2 aside : ways) {
    const Vec2 place = nearest + keep * aside;
    if (!is_open(i, place)) continue;
    const double cost = way_from(i, place) + cost_of_pushing(i, place, true, near, list_.size());
    options.all[options.count++] = {place, cost, false, false};
  }
}

/// Pitches: by how much the costs of places change for robots that are pushed for this one.
double Reservations::shaking_of(const OfRobot& of) {
  if (of.in_vain > kShakeAfter && of.in_vain < kGivesUpAfter) return kShaken;
  return of.pushed_off % kShakeEvery == kShakeEvery - 1 ? kShakenAtGoals : 0.0;
}

bool Reservations::find_place(std::size_t i, std::size_t near, std::size_t depth, std::size_t pusher) {
  const Outlook& found = outlook_of(i);  // another robot's may take its room
  const bool is_pushed = depth > 0, may_settle = !is_pushed && !of_[i].is_at_goal && !found.stands_on_place;
  const bool is_restless = !is_pushed && !of_[i].is_at_goal && of_[i].in_vain < kGivesUpAfter &&
                           of_[i].in_vain % kRestlessEvery == kRestlessEvery - 1;
  SplitMix64 random(step_ * of_.size() + i);
  const double shaken = is_pushed ? shaking_of(of_[oldest_pusher_]) : 0.0;
  Options options;
  for (; options.count < found.count; ++options.count) {
    const Prospect& p = found.places[options.count];
    const double cost = p.way + cost_of_pushing(i, p.place, is_pushed, near, list_.size());
    options.all[options.count] = {p.place, cost, p.leads_on, p.pushes_nobody};
  }
  if (is_pushed) {
    add_steps_aside(i, pusher, near, options);
    weigh_way_of_pusher(i, pusher, options);
  }
  const auto begin = options.all.begin(), end = begin + static_cast<std::ptrdiff_t>(options.count);
  if (shaken > 0.0) std::for_each(begin, end, [&](Option& o) { o.cost += shaken * pitch_ * random.fraction(); });
  const auto try_all = [&](auto&& may_take) {
    for (auto at = begin; at != end; ++at)  // few, and equal ones stay in order
      for (auto k = at; k != begin && k->cost < (k - 1)->cost; --k) std::swap(*k, *(k - 1));
    return std::any_of(begin, end, [&](const Option& o) { return may_take(o) && try_place(i, o, near, depth); });
  };
  if (try_all([&](const Option& o) { return is_pushed ? !o.pushes_nobody : o.leads_on; })) return true;
  const auto is_place = [](const Option& o) { return !o.pushes_nobody; };
  if (may_settle) {  // off the rows of places, and no way on: to a place of them
    std::for_each(begin, end, [&](Option& o) { o.cost = squared_norm(o.place - at(i)); });
    if (try_all(is_place)) return true;
  }
  if (!is_restless) return false;
  std::for_each(begin, end, [&](Option& o) { o.cost = random.fraction(); });
  return try_all(is_place);
}

// --- How far ---

/// Where ways begin. A robot that is not on its way makes all ways begin anew, where the robots are.
void Reservations::follow_ways() {
  const double strays2 = squared(kStrays * diameter_);
  bool all_are_on_their_ways = true;
  double longest2 = 0.0;
  const auto begin_here = [this](std::size_t i) { ways_[i].from = at(i), ways_[i].ticket = of_[i].ticket; };
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (!reserved_[i]) {
      ways_[i].ticket = OfWay::kNone;
      continue;
    }
    if (ways_[i].ticket != of_[i].ticket) begin_here(i);
    all_are_on_their_ways = all_are_on_their_ways && squared_distance(at(i), ways_[i].from, places_[i]) <= strays2;
    longest2 = std::max(longest2, squared_norm(places_[i] - ways_[i].from));
  }
  longest_ = std::sqrt(longest2);
  if (all_are_on_their_ways) return;
  for (std::size_t i = 0; i < of_.size(); ++i) {
    if (reserved_[i]) begin_here(i);
    ways_[i].known = OfWay::kNone;
    longest_ = std::max(longest_, left_[i]);
  }
}

/// Robots with earlier tickets whose whole ways come near the whole way of this one.
void Reservations::find_earlier(std::size_t i) {
  OfWay& way = ways_[i];
  const Segment own{way.from, places_[i]};
  const double strays = 2.0 * kStrays * diameter_, widest_keep = (1.0 + kDrivenMargin) * diameter_ + strays;
  way.known = of_[i].ticket;
  way.count = 0;
  for_each_near(at(i), norm(own.b - own.a) + longest_ + widest_keep + strays, [&](std::uint32_t j) {
    if (j == i || !reserved_[j] || of_[j].ticket >= of_[i].ticket) return;
    const double keep = (*robots_)[i].radius + (*robots_)[j].radius + kDrivenMargin * diameter_ + strays;
    if (squared_distance(own, {ways_[j].from, places_[j]}) >= squared(keep)) return;
    if (way.count < OfWay::kMost) way.earlier[way.count] = j;
    ++way.count;
  });
}

/// The share of what is left of its way that stays clear of the ways of all earlier tickets. These only get shorter: a
/// way that is clear of them remains so.
double Reservations::share_allowed(std::size_t i) {
  if (clear_[i] == of_[i].ticket) return 1.0;
  constexpr int kMostSteps = 8;
  constexpr double kClose = 1e-6;  // diameters
  if (ways_[i].known != of_[i].ticket) find_earlier(i);
  const Vec2 p = at(i), way = places_[i] - p;
  const double length = left_[i], radius = (*robots_)[i].radius;
  double share = 1.0;
  bool is_clear = true;
  const double reach = length + kLongestDrive * pitch_ + (1.0 + kDrivenMargin) * diameter_;
  const auto look_at = [&](std::size_t j) {
    if (left_[j] <= kPlaceReached * diameter_ || of_[j].ticket >= of_[i].ticket || j == i || share == 0.0) return;
    const double keep = radius + (*robots_)[j].radius + kDrivenMargin * diameter_;
    if (squared_norm(at(j) - p) > std::min(squared(reach), squared(length + left_[j] + keep)) ||
        squared_distance({p, places_[i]}, {at(j), places_[j]}) >= squared(keep))
      return;
    is_clear = false;
    // Each step is as long as there is room all round.
    double t = 0.0;
    for (int n = 0; n < kMostSteps && t < share; ++n) {
      const double gap = std::sqrt(squared_distance(p + t * way, at(j), places_[j])) - keep;
      if (gap <= kClose * diameter_) break;
      t += gap / length;
    }
    share = std::min(share, t);
  };
  const OfWay& known = ways_[i];
  if (known.count <= OfWay::kMost)
    std::for_each(known.earlier.begin(), known.earlier.begin() + known.count, look_at);
  else
    for_each_near(p, reach, look_at);
  if (is_clear) clear_[i] = of_[i].ticket;
  return share;
}

Vec2 Reservations::preferred_of(std::size_t i) {
  const Vec2 way = places_[i] - at(i);
  const double length = left_[i];
  if (length == 0.0) return {};
  const double share = is_moving(i) ? share_allowed(i) : 1.0;
  return std::min(share, (*robots_)[i].max_speed * time_step_ / length) / time_step_ * way;
}

// --- Snapshots ---

void Reservations::put(crowd::SnapshotWriter& to) const {
  to.fields(step_, tickets_, reserved_, places_, clear_);
  for (const OfRobot& of : of_)
    to.fields(of.ticket, of.at_goal_last, of.looked, of.free_since, of.way_then, of.in_vain, of.pushed_off, of.leg,
              of.has_way_then, of.is_at_goal);
}

void Reservations::get(crowd::SnapshotReader& from) {
  from.fields(step_, tickets_, reserved_, places_, clear_);
  const bool fits = reserved_.size() == of_.size() && places_.size() == of_.size() && clear_.size() == of_.size();
  from.require(fits, "other robots");
  for (OfRobot& of : of_)
    from.fields(of.ticket, of.at_goal_last, of.looked, of.free_since, of.way_then, of.in_vain, of.pushed_off, of.leg,
                of.has_way_then, of.is_at_goal);
  std::fill(decided_.begin(), decided_.end(), 0);
  ways_.assign(of_.size(), {});
}

}  // namespace exactvo::formation::detail
