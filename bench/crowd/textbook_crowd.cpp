// SPDX-License-Identifier: GPL-3.0-or-later
#include "textbook_crowd.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace exactvo::bench {
namespace {

/// Agents of a leaf of the tree.
constexpr std::size_t kLeaf = 10;
/// Directions that count as parallel.
constexpr float kParallel = 1e-5F;

struct Vector {
  float x, y;
};
Vector operator+(Vector a, Vector b) {
  return {a.x + b.x, a.y + b.y};
}
Vector operator-(Vector a, Vector b) {
  return {a.x - b.x, a.y - b.y};
}
Vector operator*(float s, Vector a) {
  return {s * a.x, s * a.y};
}
float dot(Vector a, Vector b) {
  return a.x * b.x + a.y * b.y;
}
float det(Vector a, Vector b) {
  return a.x * b.y - a.y * b.x;
}
float squared(Vector a) {
  return dot(a, a);
}
Vector normalized(Vector a) {
  return (1.0F / std::sqrt(squared(a))) * a;
}

/// What lies to its left is allowed.
struct Line {
  Vector point, direction;
};

struct Agent {
  TextbookAgent public_part;
  Vector position, velocity, preferred, next;
  float radius, max_speed, time_horizon, neighbour_distance;
  std::size_t most;
  std::vector<std::pair<float, const Agent*>> neighbours;
  std::vector<Line> lines;
};

struct Node {
  std::size_t begin, end, left, right;
  float low_x, high_x, low_y, high_y;
};

bool on_line(const std::vector<Line>& lines, std::size_t k, float radius, Vector wish, bool along, Vector& result) {
  const Line& line = lines[k];
  const float at = dot(line.point, line.direction);
  const float discriminant = at * at + radius * radius - squared(line.point);
  if (discriminant < 0.0F) return false;
  const float root = std::sqrt(discriminant);
  float low = -at - root, high = -at + root;
  for (std::size_t i = 0; i < k; ++i) {
    const float denominator = det(line.direction, lines[i].direction);
    const float numerator = det(lines[i].direction, line.point - lines[i].point);
    if (std::fabs(denominator) <= kParallel) {
      if (numerator < 0.0F) return false;
      continue;
    }
    const float t = numerator / denominator;
    if (denominator >= 0.0F)
      high = std::min(high, t);
    else
      low = std::max(low, t);
    if (low > high) return false;
  }
  float t = 0.0F;
  if (along)
    t = dot(wish, line.direction) > 0.0F ? high : low;
  else
    t = std::min(std::max(dot(line.direction, wish - line.point), low), high);
  result = line.point + t * line.direction;
  return true;
}

/// The number of lines that were kept.
std::size_t incremental(const std::vector<Line>& lines, float radius, Vector wish, bool along, Vector& result) {
  if (along)
    result = radius * wish;
  else if (squared(wish) > radius * radius)
    result = radius * normalized(wish);
  else
    result = wish;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (det(lines[k].direction, lines[k].point - result) <= 0.0F) continue;
    const Vector before = result;
    if (on_line(lines, k, radius, wish, along, result)) continue;
    result = before;
    return k;
  }
  return lines.size();
}

/// Least violation, from the line on that could not be kept.
void relax(const std::vector<Line>& lines, std::size_t first, float radius, Vector& result) {
  float level = 0.0F;
  for (std::size_t k = first; k < lines.size(); ++k) {
    if (det(lines[k].direction, lines[k].point - result) <= level) continue;
    std::vector<Line> projected;
    for (std::size_t j = 0; j < k; ++j) {
      Line line{};
      const float determinant = det(lines[k].direction, lines[j].direction);
      if (std::fabs(determinant) <= kParallel) {
        if (dot(lines[k].direction, lines[j].direction) > 0.0F) continue;
        line.point = 0.5F * (lines[k].point + lines[j].point);
      } else {
        line.point = lines[k].point +
                     (det(lines[j].direction, lines[k].point - lines[j].point) / determinant) * lines[k].direction;
      }
      line.direction = normalized(lines[j].direction - lines[k].direction);
      projected.push_back(line);
    }
    const Vector before = result;
    if (incremental(projected, radius, {-lines[k].direction.y, lines[k].direction.x}, true, result) < projected.size())
      result = before;
    level = det(lines[k].direction, lines[k].point - result);
  }
}

Line line_against(const Agent& a, const Agent& b, float time_step) {
  const Vector p = b.position - a.position, v = a.velocity - b.velocity;
  const float distance = squared(p), radius = a.radius + b.radius, area = radius * radius;
  Line line{};
  Vector u{};
  if (distance > area) {
    const Vector w = v - (1.0F / a.time_horizon) * p;
    const float length = squared(w), along = dot(w, p);
    if (along < 0.0F && along * along > area * length) {
      const float norm = std::sqrt(length);
      const Vector unit = (1.0F / norm) * w;
      line.direction = {unit.y, -unit.x};
      u = (radius / a.time_horizon - norm) * unit;
    } else {
      const float leg = std::sqrt(distance - area);
      if (det(p, w) > 0.0F)
        line.direction = (1.0F / distance) * Vector{p.x * leg - p.y * radius, p.x * radius + p.y * leg};
      else
        line.direction = (-1.0F / distance) * Vector{p.x * leg + p.y * radius, -p.x * radius + p.y * leg};
      u = dot(v, line.direction) * line.direction - v;
    }
  } else {
    const Vector w = v - (1.0F / time_step) * p;
    const float norm = std::sqrt(squared(w));
    const Vector unit = (1.0F / norm) * w;
    line.direction = {unit.y, -unit.x};
    u = (radius / time_step - norm) * unit;
  }
  line.point = a.velocity + 0.5F * u;
  return line;
}

}  // namespace

struct TextbookCrowd::World {
  float time_step = 0.25F;
  std::vector<Agent> agents;
  std::vector<const Agent*> order;
  std::vector<Node> nodes;

  void build(std::size_t begin, std::size_t end, std::size_t node) {
    Node& n = nodes[node];
    n.begin = begin;
    n.end = end;
    n.low_x = n.high_x = order[begin]->position.x;
    n.low_y = n.high_y = order[begin]->position.y;
    for (std::size_t i = begin + 1; i < end; ++i) {
      n.low_x = std::min(n.low_x, order[i]->position.x);
      n.high_x = std::max(n.high_x, order[i]->position.x);
      n.low_y = std::min(n.low_y, order[i]->position.y);
      n.high_y = std::max(n.high_y, order[i]->position.y);
    }
    if (end - begin <= kLeaf) return;
    const bool vertical = n.high_x - n.low_x > n.high_y - n.low_y;
    const float middle = 0.5F * (vertical ? n.low_x + n.high_x : n.low_y + n.high_y);
    const auto before = [&](const Agent* a) { return (vertical ? a->position.x : a->position.y) < middle; };
    auto cut = static_cast<std::size_t>(std::partition(order.begin() + static_cast<std::ptrdiff_t>(begin),
                                                       order.begin() + static_cast<std::ptrdiff_t>(end), before) -
                                        order.begin());
    if (cut == begin) ++cut;
    n.left = node + 1;
    n.right = node + 2 * (cut - begin);
    const std::size_t right = n.right;
    build(begin, cut, node + 1);
    build(cut, end, right);
  }

  float away(Vector p, std::size_t node) const {
    const Node& n = nodes[node];
    const float x = std::max({0.0F, n.low_x - p.x, p.x - n.high_x}),
                y = std::max({0.0F, n.low_y - p.y, p.y - n.high_y});
    return x * x + y * y;
  }

  static void insert(Agent& agent, const Agent* other, float& range) {
    if (other == &agent) return;
    const float distance = squared(agent.position - other->position);
    if (distance >= range) return;
    auto& list = agent.neighbours;
    if (list.size() < agent.most) list.emplace_back(distance, other);
    std::size_t i = list.size() - 1;
    for (; i != 0 && distance < list[i - 1].first; --i) list[i] = list[i - 1];
    list[i] = {distance, other};
    if (list.size() == agent.most) range = list.back().first;
  }

  void query(Agent& agent, float& range, std::size_t node) const {
    const Node& n = nodes[node];
    if (n.end - n.begin <= kLeaf) {
      for (std::size_t i = n.begin; i < n.end; ++i) insert(agent, order[i], range);
      return;
    }
    const float left = away(agent.position, n.left), right = away(agent.position, n.right);
    const std::size_t first = left < right ? n.left : n.right, second = left < right ? n.right : n.left;
    if (std::min(left, right) >= range) return;
    query(agent, range, first);
    if (std::max(left, right) < range) query(agent, range, second);
  }

  void decide(Agent& agent) const {
    agent.neighbours.clear();
    float range = agent.neighbour_distance * agent.neighbour_distance;
    query(agent, range, 0);
    agent.lines.clear();
    for (const auto& [distance, other] : agent.neighbours)
      agent.lines.push_back(line_against(agent, *other, time_step));
    const std::size_t kept = incremental(agent.lines, agent.max_speed, agent.preferred, false, agent.next);
    if (kept < agent.lines.size()) relax(agent.lines, kept, agent.max_speed, agent.next);
  }

  void read() {
    for (Agent& a : agents) {
      const TextbookAgent& p = a.public_part;
      a.position = {p.x, p.y};
      a.velocity = {p.vx, p.vy};
      a.preferred = {p.preferred_x, p.preferred_y};
      a.radius = p.radius;
      a.max_speed = p.max_speed;
      a.time_horizon = p.time_horizon;
      a.neighbour_distance = p.neighbour_distance;
      a.most = static_cast<std::size_t>(p.neighbours);
    }
  }
};

TextbookCrowd::TextbookCrowd(float time_step) : world_(std::make_unique<World>()) {
  world_->time_step = time_step;
}
TextbookCrowd::~TextbookCrowd() = default;
TextbookCrowd::TextbookCrowd(TextbookCrowd&&) noexcept = default;
void TextbookCrowd::reserve(std::size_t agents) {
  world_->agents.reserve(agents);
}
void TextbookCrowd::add(const TextbookAgent& agent) {
  world_->agents.push_back({});
  world_->agents.back().public_part = agent;
}
std::size_t TextbookCrowd::size() const {
  return world_->agents.size();
}
TextbookAgent& TextbookCrowd::operator[](std::size_t agent) {
  return world_->agents[agent].public_part;
}

void TextbookCrowd::read() {
  world_->read();
}

void TextbookCrowd::step() {
  World& w = *world_;
  if (w.agents.empty()) return;
  if (w.order.size() != w.agents.size()) {
    w.order.clear();
    for (const Agent& a : w.agents) w.order.push_back(&a);
    w.nodes.resize(2 * w.agents.size());
  }
  w.build(0, w.order.size(), 0);
  for (Agent& a : w.agents) w.decide(a);
  for (Agent& a : w.agents) {
    a.velocity = a.next;
    a.position = a.position + w.time_step * a.velocity;
  }
}

void TextbookCrowd::write() {
  for (Agent& a : world_->agents) {
    a.public_part.x = a.position.x;
    a.public_part.y = a.position.y;
    a.public_part.vx = a.velocity.x;
    a.public_part.vy = a.velocity.y;
  }
}

std::size_t TextbookCrowd::bytes() const {
  std::size_t sum = world_->agents.capacity() * (sizeof(Agent) - sizeof(TextbookAgent)) +
                    world_->order.capacity() * sizeof(void*) + world_->nodes.capacity() * sizeof(Node);
  for (const Agent& a : world_->agents)
    sum += a.neighbours.capacity() * sizeof(a.neighbours[0]) + a.lines.capacity() * sizeof(Line);
  return sum;
}

}  // namespace exactvo::bench
