// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/vo/free_velocities.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "exactvo/geometry/require.h"
#include "exactvo/vo/certificate.h"
#include "free/cone_bounds.h"

namespace exactvo::vo {
namespace {

using geometry::Bracket;
using geometry::Polygon;
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

Vec2 farthest_out(const Polygon& polygon, const HalfPlane& h) {
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

Bracket FreeVelocities::area() const {
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
