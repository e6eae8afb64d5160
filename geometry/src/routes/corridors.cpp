// SPDX-License-Identifier: GPL-3.0-or-later
#include "routes/corridors.h"

#include <algorithm>
#include <cmath>

namespace exactvo::geometry::routing {
namespace {

/// Whether the rectangle lies to the left (side = 1) or right (-1) of the line along the ray, farther from it than what
/// counts as a touch and than all rounding here.
bool lies_beside(Vec2 middle, Vec2 along, Vec2 across, const View& view, Vec2 ray, double size, double side) {
  const Vec2 to_middle = middle - view.root;
  const double least = side * cross(ray, to_middle) - std::fabs(cross(ray, along)) - std::fabs(cross(ray, across));
  constexpr double kRounding = 0x1p-46;
  const double reach = std::fabs(middle.x) + std::fabs(middle.y) + norm(along) + norm(across) + std::fabs(view.root.x) +
                       std::fabs(view.root.y);
  return least > norm(ray) * (2.0 * view.snap * std::max(size, view.size) + kRounding * reach);
}

}  // namespace

Corridor::Strip Corridor::strip_round(const std::vector<Vec2>& points) {
  Vec2 u = points.back() - points.front();
  const double length = norm(u);
  u = length > 0.0 ? u / length : Vec2{1.0, 0.0};
  const Vec2 v{-u.y, u.x};
  double low = 0.0, high = 0.0, right = 0.0, left = 0.0;  // of the first point
  for (const Vec2& p : points) {
    const double on = dot(p - points.front(), u), off = dot(p - points.front(), v);
    low = std::min(low, on);
    high = std::max(high, on);
    right = std::min(right, off);
    left = std::max(left, off);
  }
  return {points.front() + 0.5 * (low + high) * u + 0.5 * (right + left) * v, 0.5 * (high - low) * u,
          0.5 * (left - right) * v};
}

Corridor::Block Corridor::lowest_block(int number) {
  constexpr int kGates = 1 << kBlock;
  Block made;
  for (const bool is_left : {true, false}) {
    scratch_.clear();
    for (int i = number * kGates; i < (number + 1) * kGates; ++i)
      scratch_.push_back(is_left ? (*this)[i].left : (*this)[i].right);
    (is_left ? made.left : made.right) = strip_round(scratch_);
  }
  for (int i = number * kGates; i < (number + 1) * kGates; ++i) made.size = std::max(made.size, (*this)[i].size);
  return made;
}

Corridor::Block Corridor::block_of_two(const std::vector<Block>& below, int number) {
  const Block &first = below[2 * static_cast<std::size_t>(number)],
              &second = below[2 * static_cast<std::size_t>(number) + 1];
  Block made;
  for (const bool is_left : {true, false}) {
    scratch_.clear();
    for (const Block* half : {&first, &second}) {
      const Strip& s = is_left ? half->left : half->right;
      for (const double u : {-1.0, 1.0})
        for (const double v : {-1.0, 1.0}) scratch_.push_back(s.middle + u * s.along + v * s.across);
    }
    (is_left ? made.left : made.right) = strip_round(scratch_);
  }
  made.size = std::max(first.size, second.size);
  return made;
}

const Corridor::Block& Corridor::block(int level, int number) {
  const std::size_t row = static_cast<std::size_t>(level - kBlock);
  if (blocks_.size() <= row) blocks_.resize(row + 1);
  for (int k = static_cast<int>(blocks_[row].size()); k <= number; ++k) {
    if (level > kBlock) block(level - 1, 2 * k + 1);  // makes the one before it too
    blocks_[row].push_back(level == kBlock ? lowest_block(k) : block_of_two(blocks_[row - 1], k));
  }
  return blocks_[row][static_cast<std::size_t>(number)];
}

bool Corridor::passes(const Block& block, const View& view) {
  const auto beside = [&](const Strip& s, Vec2 ray, double side) {
    return lies_beside(s.middle, s.along, s.across, view, ray, block.size, side);
  };
  return beside(block.right, view.right_ray, -1.0) && beside(block.left, view.left_ray, 1.0) &&
         beside(block.right, view.left_ray, -1.0) && beside(block.left, view.right_ray, 1.0);
}

}  // namespace exactvo::geometry::routing
