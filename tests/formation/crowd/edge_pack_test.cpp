// SPDX-License-Identifier: GPL-3.0-or-later
// Half-planes against edges for a pack of robots against those that are made one by one, bit for bit.
#include "crowd/edge_pack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "crowd/edge_oracle.h"
#include "crowd/kinds.h"
#include "crowd_scenes.h"
#include "exactvo/vo/lp/batch.h"
#include "lp/sets/target.h"

namespace exactvo::formation::crowd {
namespace {

constexpr std::size_t kRobots = 4000, kRings = 12;

struct Robot {
  BodyQuery query;
};

struct Setting {
  EdgeGrid grid;
  std::vector<Robot> robots;
};

/// Robots of three kinds among edges: short, long, of no length, with an end or a point in the place of a robot,
/// touching robots, and in a few places far more of them than a lane has room for.
Setting setting() {
  SceneRandom random;
  Setting s;
  std::vector<Segment> edges;
  double reach = 0.0;
  for (std::size_t k = 0; k < kRobots; ++k) {
    BodyQuery q;
    q.position = {0x1p-18 * std::floor(0x1p18 * 200.0 * random()), 0x1p-18 * std::floor(0x1p18 * 200.0 * random())};
    const double kind = std::floor(3.0 * random());
    q.radius = 0.25 + 0.25 * kind;
    q.still_horizon = 1.0 + 1.5 * kind;
    q.max_speed = 1.5;
    const Vec2 velocity = {random() - 0.5, random() - 0.5};
    q.velocity = k % 9 == 0 ? Vec2{} : 1.5 * velocity;
    reach = std::max(reach, q.still_horizon * q.max_speed + q.radius);
    s.robots.push_back({q});
  }
  for (std::size_t k = 0; k < 1500; ++k) {
    const Vec2 place = s.robots[k].query.position, way = {random() - 0.5, random() - 0.5};
    const Vec2 from = place + 8.0 * Vec2{random() - 0.5, random() - 0.5};
    switch (k % 16) {
      case 0:
        edges.push_back({from, from});
        break;
      case 1:
        edges.push_back({from, from + 300.0 * way});
        break;
      case 2:
        edges.push_back({place, place + 5.0 * way});
        break;
      case 3:
        edges.push_back({place - 3.0 * way, place + 3.0 * way});
        break;
      case 4:
        edges.push_back({place, place});
        break;
      case 5:
        edges.push_back({{from.x, place.y - 4.0}, {from.x, place.y + 4.0}});
        break;
      case 6:
        edges.push_back({from, from + 1e-170 * way});
        break;
      default:
        edges.push_back({from, from + 1.5 * way});
        break;
    }
  }
  for (std::size_t k = 0; k < kRings; ++k) {  // no edge hides another
    const Vec2 centre = {20.0 + 40.0 * static_cast<double>(k), 230.0};
    for (int j = 0; j < 24; ++j) {
      const Vec2 out = {std::cos(0.26 * j), std::sin(0.26 * j)};
      edges.push_back({centre + 1.5 * out, centre + 1.7 * out});
    }
    BodyQuery& q = s.robots[10 * k].query;
    q.position = centre + Vec2{0.125 * random(), 0.125 * random()};
    q.velocity = {};
  }
  for (int k = 0; k < 200; ++k) edges.push_back({{80.0 + 0.01 * k, 80.0}, {80.0 + 0.01 * k, 80.5}});
  s.grid.set_edges(edges);
  s.grid.lay_out(reach);
  return s;
}

template <class T>
struct Pack {
  EdgePackQuery<T> query;
  std::vector<T> x, y, c;
  std::vector<std::uint32_t> edge;
  std::vector<std::uint8_t> touching;
  std::int32_t lines[kPack];
  std::uint32_t overflow = 0;
};

constexpr double kSlack = 0x1p-16;

/// With room for some lines, and where there is room for all, with their edges.
template <class T>
std::unique_ptr<Pack<T>> lines_of_pack(const Setting& s, std::size_t first, std::size_t room, EdgePackTable& table) {
  auto pack = std::make_unique<Pack<T>>();
  EdgePackQuery<T>& query = pack->query;
  query.edges = s.grid.edges().data();
  query.items = s.grid.items().data();
  query.slack = static_cast<T>(kSlack);
  std::size_t most = 0;
  for (std::size_t lane = 0; lane < kPack; ++lane) {
    const BodyQuery& q = s.robots[first + lane].query;
    query.x[lane] = q.position.x;
    query.y[lane] = q.position.y;
    query.vx[lane] = q.velocity.x;
    query.vy[lane] = q.velocity.y;
    query.radius[lane] = q.radius;
    query.horizon[lane] = q.still_horizon;
    query.max_speed[lane] = q.max_speed;
    query.least[lane] = static_cast<T>(-1.0);  // binds now and then
    const EdgeGrid::Range near = s.grid.near(q.position);
    query.first[lane] = static_cast<std::int32_t>(near.first);
    query.count[lane] = static_cast<std::int32_t>(near.last - near.first);
    most = std::max<std::size_t>(most, near.last - near.first);
  }
  const bool for_all = room >= most;
  room = std::min(room, most);
  for (auto* row : {&pack->x, &pack->y, &pack->c}) row->resize(room * kPack);
  pack->edge.resize(room * kPack);
  pack->touching.resize(room * kPack);
  EdgePackLines<T> out{pack->x.data(), pack->y.data(), pack->c.data(), kPack, pack->lines, room};
  if (for_all) out.edge = pack->edge.data(), out.touching = pack->touching.data();
  pack->overflow = make_edge_lines(query, table, out);
  return pack;
}

template <class T>
void expect_the_same(const std::string& target) {
  const Setting s = setting();
  EdgePackTable table;
  std::size_t lines = 0, overflows = 0, touching = 0, crowded = 0;
  for (std::size_t first = 0; first < kRobots; first += kPack) {
    const auto pack = lines_of_pack<T>(s, first, kMostEdges, table);
    const auto whole = lines_of_pack<T>(s, first, s.grid.edges().size(), table);
    ASSERT_EQ(whole->overflow, 0U) << target << ' ' << first;
    for (std::size_t lane = 0; lane < kPack; ++lane) {
      BodyQuery query = s.robots[first + lane].query;
      query.float_normals = sizeof(T) == 4;
      const std::vector<BodyLine> alone = edge_lines(s.grid, query);
      const bool overflow = (pack->overflow >> lane & 1U) != 0;
      ASSERT_EQ(overflow, alone.size() > kMostEdges) << target << ' ' << first + lane;
      ASSERT_EQ(static_cast<std::size_t>(pack->lines[lane]), overflow ? 0 : alone.size())
          << target << ' ' << first + lane;
      ASSERT_EQ(static_cast<std::size_t>(whole->lines[lane]), alone.size()) << target << ' ' << first + lane;
      overflows += overflow;
      crowded += whole->query.count[lane] > 96;
      for (std::size_t k = 0; k < alone.size(); ++k, ++lines) {
        const std::size_t at = k * kPack + lane;
        touching += alone[k].touching;
        ASSERT_EQ(whole->edge[at], alone[k].obstacle) << target << ' ' << first + lane << ' ' << k;
        ASSERT_EQ(whole->touching[at] != 0, alone[k].touching) << target << ' ' << first + lane << ' ' << k;
        for (const Pack<T>* p : {pack.get(), whole.get()}) {
          if (p == pack.get() && overflow) continue;
          ASSERT_EQ(static_cast<double>(p->x[at]), alone[k].normal.x) << target << ' ' << first + lane << ' ' << k;
          ASSERT_EQ(static_cast<double>(p->y[at]), alone[k].normal.y) << target << ' ' << first + lane << ' ' << k;
          ASSERT_EQ(p->c[at], std::max(T(-1), rounded_up<T>(alone[k].offset + kSlack)))
              << target << ' ' << first + lane << ' ' << k;
        }
      }
    }
  }
  // The setting has all of what it is for.
  EXPECT_GT(lines, 10000U);
  EXPECT_GT(overflows, 5U);
  EXPECT_GT(touching, 100U);
  EXPECT_GT(crowded, 5U);
}

TEST(CrowdEdgePack, GivesTheBitsOfOneRobotOnEveryTarget) {
  for (const char* target : {"", "AVX3", "AVX2", "SSE4", "SSE2"}) {
    if (!lp::limit_batch_target(target)) continue;  // not on this machine
    expect_the_same<float>(lp::batch_target());
    expect_the_same<double>(lp::batch_target());
  }
  lp::limit_batch_target("");
}

/// Two edges that the robots can meet, one of them behind all of the many in its cell's list.
TEST(CrowdEdgePack, FarEdgesOfACellTakeNoRows) {
  constexpr std::size_t kFar = 10000;
  Setting s;
  std::vector<Segment> edges(kFar, Segment{{3.5, 0.0}, {4.0, 0.0}});
  edges.push_back({{1.6, -1.0}, {2.6, -1.0}});
  edges.push_back({{0.0, 0.0}, {0.0, 0.0}});
  s.grid.set_edges(edges);
  s.grid.lay_out(6.0);
  BodyQuery q;
  q.position = {1.6, 0.0};
  q.radius = 0.25;
  q.still_horizon = 1.0;
  q.max_speed = 1.5;
  s.robots.resize(kPack, {q});
  EdgePackTable table;
  const auto pack = lines_of_pack<float>(s, 0, edges.size(), table);
  ASSERT_EQ(static_cast<std::size_t>(pack->query.count[0]), edges.size());
  ASSERT_EQ(s.grid.items()[static_cast<std::size_t>(pack->query.first[0]) + kFar + 1], kFar + 1);
  EXPECT_EQ(pack->overflow, 0U);
  for (std::size_t lane = 0; lane < kPack; ++lane) {
    ASSERT_EQ(pack->lines[lane], 2);
    EXPECT_EQ(pack->edge[lane], kFar);
    EXPECT_EQ(pack->edge[kPack + lane], kFar + 1);
  }
  EXPECT_LT(table.row_at.size(), 100U);
}

}  // namespace
}  // namespace exactvo::formation::crowd
