// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons as graphs and as counted lists: GraphML with coordinates (Salzburg's polygon collection), its .line files,
// and planar straight line graphs as triangulators' tests hold them.
#include <algorithm>
#include <map>

#include "exactvo/geometry/box.h"
#include "files/text_file.h"
#include "readers/line_reader.h"
#include "readers/readers.h"
#include "readers/xml_file.h"

namespace exactvo::datasets {
namespace {

using geometry::Vec2;

// --- Points joined by edges, decomposed into rings and open chains ---

struct PlaneGraph {
  std::vector<Vec2> points;
  std::vector<std::pair<std::size_t, std::size_t>> edges;  ///< indices of points
};

struct GraphChain {
  std::vector<Vec2> points;  ///< closed: the first is repeated at the end
  bool closed = false;
};

/// Every edge in one chain: from ends and forks to the next, then round what is left. O(points + edges), in the order
/// of the points. REQUIRES: every index that of a point.
class ChainWalker {
 public:
  explicit ChainWalker(const PlaneGraph& graph) : graph_(graph), at_(graph.points.size()), used_(graph.edges.size()) {
    for (std::size_t e = 0; e < graph.edges.size(); ++e) {
      at_[graph.edges[e].first].push_back(e);
      at_[graph.edges[e].second].push_back(e);
    }
  }

  std::vector<GraphChain> chains() {
    for (std::size_t node = 0; node < at_.size(); ++node) {
      if (at_[node].size() != 2) walk_all_from(node);
    }
    for (std::size_t node = 0; node < at_.size(); ++node) walk_all_from(node);
    return std::move(chains_);
  }

 private:
  void walk_all_from(std::size_t node) {
    for (const std::size_t edge : at_[node]) {
      if (!used_[edge]) walk(node, edge);
    }
  }

  void walk(std::size_t start, std::size_t edge) {
    GraphChain chain;
    std::size_t node = start;
    chain.points.push_back(graph_.points[node]);
    for (;;) {
      used_[edge] = true;
      node = graph_.edges[edge].first == node ? graph_.edges[edge].second : graph_.edges[edge].first;
      chain.points.push_back(graph_.points[node]);
      if (node == start || at_[node].size() != 2) break;
      edge = used_[at_[node][0]] ? at_[node][1] : at_[node][0];
      if (used_[edge]) break;
    }
    chain.closed = node == start;
    chains_.push_back(std::move(chain));
  }

  const PlaneGraph& graph_;
  std::vector<std::vector<std::size_t>> at_;  ///< the edges at each point
  std::vector<bool> used_;
  std::vector<GraphChain> chains_;
};

double half_perimeter_of_box(const std::vector<Vec2>& points) {
  geometry::Box box{points.front(), points.front()};
  for (const Vec2 p : points) box.add(p);
  return (box.high.x - box.low.x) + (box.high.y - box.low.y);
}

void add_walls(std::vector<GraphChain> chains, const std::string& place, Collector& out) {
  for (std::size_t k = 0; k < chains.size(); ++k) {
    const std::string number = std::to_string(k);
    out.add({RawKind::polyline, number, place + ", chain " + number, {std::move(chains[k].points)}});
  }
}

bool is_lonely(const PlaneGraph& graph, Collector& out, const std::string& place) {
  if (!graph.edges.empty()) return false;
  out.pass_over(place, "points without edges skipped: points are no obstacles");
  return true;
}

/// Where nothing but rings is: one polygon, the ring with the largest box outside. Else walls, each chain one.
void add_graph(const PlaneGraph& graph, const std::string& place, Collector& out) {
  if (is_lonely(graph, out, place)) return;
  std::vector<GraphChain> chains = ChainWalker(graph).chains();
  if (!std::all_of(chains.begin(), chains.end(), [](const GraphChain& c) { return c.closed; }))
    return add_walls(std::move(chains), place, out);
  const auto less = [](const GraphChain& a, const GraphChain& b) {
    return half_perimeter_of_box(a.points) < half_perimeter_of_box(b.points);
  };
  std::iter_swap(chains.begin(), std::max_element(chains.begin(), chains.end(), less));
  RawGeometry raw{RawKind::polygon, "0", place, {}};
  for (GraphChain& chain : chains) raw.rings.push_back(std::move(chain.points));
  out.add(raw);
}

// --- GraphML: <node id><data key="x">..</data><data key="y">..</data></node>, <edge source target/> ---

double coordinate(const XmlFile& xml, const pugi::xml_node& node, const char* key, const std::string& file) {
  for (const pugi::xml_node data : node.children("data")) {
    if (std::string_view(data.attribute("key").value()) == key) return xml.to_number(data, data.child_value());
  }
  throw DataError(DataCode::key_missing, file, xml.place_of(node), std::string("no data of key ") + key,
                  "coordinates as data of keys x and y");
}

using NodeNumbers = std::map<std::string, std::size_t, std::less<>>;

std::size_t node_number(const NodeNumbers& numbers, const XmlFile& xml, const pugi::xml_node& edge, const char* end,
                        const std::string& file) {
  const auto found = numbers.find(std::string_view(edge.attribute(end).value()));
  if (found != numbers.end()) return found->second;
  throw DataError(DataCode::not_an_option, file, xml.place_of(edge),
                  std::string(end) + " \"" + edge.attribute(end).value() + "\"", "the id of a node");
}

PlaneGraph read_graph(const XmlFile& xml, const pugi::xml_node& element, const std::string& file) {
  PlaneGraph graph;
  NodeNumbers numbers;
  for (const pugi::xml_node node : element.children("node")) {
    numbers.emplace(node.attribute("id").value(), graph.points.size());
    graph.points.push_back({coordinate(xml, node, "x", file), coordinate(xml, node, "y", file)});
  }
  for (const pugi::xml_node edge : element.children("edge")) {
    graph.edges.emplace_back(node_number(numbers, xml, edge, "source", file),
                             node_number(numbers, xml, edge, "target", file));
  }
  return graph;
}

// --- Counted lists ---

/// Lines that hold something, this many fields each.
class CountedLines : public LineReader {
 public:
  using LineReader::LineReader;

  void need(const std::string& what) {
    if (!next_filled()) refuse(DataCode::format_syntax, "the end of the file", what);
  }
  geometry::Vec2 point() {
    need("a point, x y");
    const std::vector<std::string_view> words = words_of(line());
    if (words.size() < 2) refuse(DataCode::wrong_count, excerpt(line(), 0), "a point, x y");
    return {to_number(words[0]), to_number(words[1])};
  }
  /// A number of things that follow, a line each of two characters at least: no more than the file has room for.
  std::size_t count(std::size_t field) const {
    const std::int64_t n = whole(field);
    if (n < 0) refuse(DataCode::format_syntax, excerpt(line(), 0), "a count");
    if (static_cast<std::uint64_t>(n) > left() / 2 + 1)
      refuse(DataCode::size, std::to_string(n) + " lines", "no more lines than the file has");
    return static_cast<std::size_t>(n);
  }
  std::size_t index(std::size_t field, std::size_t below) const {
    const std::int64_t n = whole(field);
    if (n < 0 || static_cast<std::uint64_t>(n) >= below)
      refuse(DataCode::out_of_range, excerpt(line(), 0), "indices of points, from 0 on");
    return static_cast<std::size_t>(n);
  }

 private:
  /// Below 0 where the line has no such field.
  std::int64_t whole(std::size_t field) const {
    const std::vector<std::string_view> words = words_of(line());
    return field < words.size() ? to_integer(words[field]) : -1;
  }
};

bool is_count(std::string_view word) {
  return !word.empty() && word.size() <= 10 && word.find_first_not_of("0123456789") == std::string_view::npos;
}

/// The fields of the first two lines that hold something.
std::vector<std::vector<std::string>> first_lines(const FormatProbe& probe) {
  std::vector<std::vector<std::string>> lines;
  const std::string name;
  LineReader reader(probe.beginning, name);
  while (lines.size() < 2 && reader.next_filled()) {
    const std::vector<std::string_view> words = words_of(reader.line());
    lines.emplace_back(words.begin(), words.end());
  }
  return lines;
}

}  // namespace

void read_graphml(const std::filesystem::path& path, Collector& out) {
  const XmlFile xml(path, out.file());
  for (const pugi::xml_node graph : xml.document().child("graphml").children("graph"))
    add_graph(read_graph(xml, graph, out.file()), xml.place_of(graph), out);
}

bool looks_like_counted_rings(const FormatProbe& probe) {
  const auto lines = first_lines(probe);
  return probe.extension == ".line" && !lines.empty() && lines[0].size() == 1 && is_count(lines[0][0]);
}

/// Rings, each its count and its points; the first is outside.
void read_counted_rings(const std::filesystem::path& path, Collector& out) {
  CountedLines lines(read_text_file(path), out.file());
  RawGeometry raw{RawKind::polygon, "0", "polygon", {}};
  while (lines.next_filled()) {
    geometry::Ring& ring = raw.rings.emplace_back();
    for (std::size_t n = lines.count(0); n > 0; --n) ring.push_back(lines.point());
  }
  if (raw.rings.empty()) return out.pass_over(raw.place, "an empty polygon skipped");
  out.add(raw);
}

bool looks_like_pslg(const FormatProbe& probe) {
  const auto lines = first_lines(probe);
  if (probe.extension != ".txt" && probe.extension != ".pslg") return false;
  return lines.size() == 2 && lines[0].size() == 2 && lines[1].size() == 2 && is_count(lines[0][0]) &&
         is_count(lines[0][1]);
}

/// "points edges", the points, the edges as pairs of indices. What is inside is not said: walls.
void read_pslg(const std::filesystem::path& path, Collector& out) {
  CountedLines lines(read_text_file(path), out.file());
  lines.need("the numbers of points and edges");
  const std::size_t points = lines.count(0);
  const std::size_t edges = lines.count(1);
  PlaneGraph graph;
  for (std::size_t k = 0; k < points; ++k) graph.points.push_back(lines.point());
  for (std::size_t k = 0; k < edges; ++k) {
    lines.need("an edge, two indices");
    graph.edges.emplace_back(lines.index(0, points), lines.index(1, points));
  }
  // Walls in any case: of edges that say nothing about what is inside.
  if (!is_lonely(graph, out, "graph")) add_walls(ChainWalker(graph).chains(), "graph", out);
}

}  // namespace exactvo::datasets
