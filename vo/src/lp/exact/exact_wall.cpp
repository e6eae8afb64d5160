// SPDX-License-Identifier: GPL-3.0-or-later
#include "lp/exact/exact_wall.h"

#include <utility>

namespace exactvo::lp {

Stretch inside_disc(const Carrier& carrier) {
  Stretch stretch;
  if (!carrier.has_disc) return stretch;
  stretch.low_owner = stretch.high_owner = kDiscOwner;
  stretch.empty = sign_of(carrier.discriminant) < 0;
  stretch.low = disc_end(-1);
  stretch.high = disc_end(1);
  return stretch;
}

void clip(Stretch& stretch, const Carrier& carrier, const ExactLine& other, std::size_t owner) {
  const int side = allowed_side(carrier, other);
  if (side == 0) {
    if (sign_of(missing(carrier, other)) <= 0) return;
    stretch.empty = true;
    stretch.low_owner = owner;
    stretch.high_owner = kNoOwner;
    return;
  }
  const Abscissa s = cut(carrier, other);
  if (side > 0 && compare(carrier, s, stretch.low) > 0) stretch.low = s, stretch.low_owner = owner;
  if (side < 0 && compare(carrier, s, stretch.high) < 0) stretch.high = s, stretch.high_owner = owner;
  stretch.empty = compare(carrier, stretch.low, stretch.high) > 0;
}

Abscissa wish(const Carrier& carrier, const Aim& aim) {
  for (const Vec2 direction : aim.directions) {
    const int side = sign_of(dot(exact(direction), carrier.direction));
    if (side != 0) return end(side);
  }
  return foot(carrier, aim.target);
}

Abscissa clamped(const Carrier& carrier, const Stretch& stretch, const Abscissa& s) {
  if (compare(carrier, s, stretch.low) < 0) return stretch.low;
  return compare(carrier, s, stretch.high) > 0 ? stretch.high : s;
}

bool at_disc(const Carrier& carrier, const Abscissa& s) {
  if (!carrier.has_disc) return false;
  return compare(carrier, s, disc_end(-1)) == 0 || compare(carrier, s, disc_end(1)) == 0;
}

ExactLine below(const ExactLine& top, const ExactLine& other) {
  return {other.normal - top.normal, other.offset - top.offset};
}

WallSearch::WallSearch(Carrier carrier, Aim aim) : carrier_(std::move(carrier)), aim_(std::move(aim)) {
  wish_ = wish(carrier_, aim_);
  stretch_ = inside_disc(carrier_);
}

void WallSearch::add_soft(const ExactLine& line, std::size_t position) {
  soft_.push_back({line, position});
}

void WallSearch::add_hard(const ExactLine& line, std::size_t position) {
  if (!stretch_.empty) clip(stretch_, carrier_, line, position);
}

std::size_t WallSearch::highest_at(const Abscissa& s) const {
  std::size_t highest = 0;
  for (std::size_t k = 1; k < soft_.size(); ++k)
    if (compare(carrier_, height_at(carrier_, soft_[k].line, s), height_at(carrier_, soft_[highest].line, s)) > 0)
      highest = k;
  return highest;
}

bool WallSearch::nearer_wish(const Abscissa& s) const {
  const int order = compare(carrier_, s, best_);
  if (wish_.infinite != 0) return order * wish_.infinite > 0;
  return order * compare_mean(carrier_, s, best_, wish_) < 0;
}

void WallSearch::consider(const Abscissa& s) {
  if (s.infinite != 0 || compare(carrier_, s, stretch_.low) < 0 || compare(carrier_, s, stretch_.high) > 0) return;
  const std::size_t highest = highest_at(s);
  const int order = found_ ? compare(carrier_, height_at(carrier_, soft_[highest].line, s),
                                     height_at(carrier_, soft_[highest_].line, best_))
                           : -1;
  if (order > 0 || (order == 0 && !nearer_wish(s))) return;
  found_ = true;
  best_ = s;
  highest_ = highest;
}

void WallSearch::consider_crossings() {
  for (std::size_t j = 0; j < soft_.size(); ++j) {
    for (std::size_t k = j + 1; k < soft_.size(); ++k) {
      const ExactLine crossing = below(soft_[j].line, soft_[k].line);
      if (allowed_side(carrier_, crossing) != 0) consider(cut(carrier_, crossing));
    }
  }
}

bool WallSearch::run() {
  if (stretch_.empty) return false;
  consider(stretch_.low);
  consider(stretch_.high);
  consider(wish_);
  consider_crossings();
  return found_;
}

}  // namespace exactvo::lp
