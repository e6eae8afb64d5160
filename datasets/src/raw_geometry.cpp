// SPDX-License-Identifier: GPL-3.0-or-later
#include "raw_geometry.h"

#include <algorithm>
#include <utility>

#include "json_text.h"

namespace exactvo::datasets {
namespace {

std::string coordinates(geometry::Vec2 p) {
  std::string text = "(";
  append_number(text, p.x);
  text += ", ";
  append_number(text, p.y);
  return text + ")";
}

const char* words_for(DataCode code) {
  switch (code) {
    case DataCode::not_finite:
      return "a coordinate that is no finite number";
    case DataCode::too_few_points:
      return "too few distinct points";
    case DataCode::unclosed:
      return "a ring that does not end where it began";
    case DataCode::repeated_vertex:
      return "the same point twice running";
    case DataCode::clockwise:
      return "the wrong winding";
    case DataCode::zero_area:
      return "a ring without area";
    case DataCode::self_intersection:
      return "a ring that crosses or touches itself";
    default:
      return "a hole that is not inside its polygon or meets another ring";
  }
}

const char* words_for_mending(DataCode code) {
  switch (code) {
    case DataCode::unclosed:
      return "ring closed";
    case DataCode::repeated_vertex:
      return "repeated vertex dropped";
    default:
      return "winding reversed";
  }
}

const char* expectation(DataCode code) {
  switch (code) {
    case DataCode::not_finite:
      return "finite coordinates";
    case DataCode::too_few_points:
      return "at least three distinct points in a ring, two in a polyline";
    case DataCode::zero_area:
      return "a ring that encloses some area";
    case DataCode::self_intersection:
      return "a simple ring";
    default:
      return "holes inside their polygon, apart from each other";
  }
}

/// A polygon's JSON needs no repeated first point, so its absence is no repair worth a note there.
bool is_worth_a_note(const RawGeometry& raw, DataCode code) {
  return code != DataCode::unclosed || raw.ring_pointers.empty();
}

DataError refusal(const RawGeometry& raw, const std::string& file, DataCode code, std::size_t ring, std::size_t vertex,
                  geometry::Vec2 where) {
  return {code, file, place_of_vertex(raw, ring, vertex), std::string(words_for(code)) + " at " + coordinates(where),
          expectation(code)};
}

void refuse_non_finite(const RawGeometry& raw, const std::string& file) {
  for (std::size_t r = 0; r < raw.rings.size(); ++r) {
    for (std::size_t v = 0; v < raw.rings[r].size(); ++v) {
      const geometry::Vec2 p = raw.rings[r][v];
      if (!geometry::is_finite(p)) throw refusal(raw, file, DataCode::not_finite, r, v, p);
    }
  }
}

geometry::Obstacle judged_polyline(const RawGeometry& raw, const std::string& file, std::vector<DataNote>& notes) {
  geometry::Polyline line;
  const geometry::Ring& points = raw.rings.front();
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (line.points.empty() || line.points.back() != points[v]) {
      line.points.push_back(points[v]);
    } else {
      notes.push_back(
          {DataCode::repeated_vertex, place_of_vertex(raw, 0, v), words_for_mending(DataCode::repeated_vertex)});
    }
  }
  if (line.points.size() < 2) {
    throw refusal(raw, file, DataCode::too_few_points, 0, 0, points.empty() ? geometry::Vec2{} : points.front());
  }
  return line;
}

geometry::Obstacle judged_polygon(const RawGeometry& raw, const std::string& file, std::vector<DataNote>& notes) {
  geometry::NormalizedPolygon normal = geometry::normalize(raw.rings);
  for (const geometry::RingProblem& problem : normal.problems) {
    const DataCode code = data_code(problem.code);
    if (!problem.mended) throw refusal(raw, file, code, problem.ring, problem.vertex, problem.where);
    if (!is_worth_a_note(raw, code)) continue;
    notes.push_back({code, place_of_vertex(raw, problem.ring, problem.vertex), words_for_mending(code)});
  }
  return std::move(normal.polygon);
}

}  // namespace

std::string place_of_vertex(const RawGeometry& raw, std::size_t ring, std::size_t vertex) {
  if (ring < raw.ring_pointers.size()) return raw.ring_pointers[ring] + "/" + std::to_string(vertex);
  return raw.place + ", ring " + std::to_string(ring) + ", vertex " + std::to_string(vertex);
}

geometry::Obstacle judged(const RawGeometry& raw, const std::string& file, std::vector<DataNote>& notes) {
  refuse_non_finite(raw, file);
  return raw.kind == RawKind::polyline ? judged_polyline(raw, file, notes) : judged_polygon(raw, file, notes);
}

Collector::Collector(std::string file, std::string format, const ReadOptions& options) : options_(options) {
  result_.file = std::move(file);
  result_.format = std::move(format);
}

void Collector::add(const RawGeometry& raw) {
  ++result_.counts.read;
  std::vector<DataNote> notes;
  try {
    result_.obstacles.push_back({raw.id, judged(raw, result_.file, notes)});
  } catch (const DataError& error) {
    ++result_.counts.rejected;
    if (!options_.keep_going) throw;
    result_.rejected.push_back(error);
    return;
  }
  ++(notes.empty() ? result_.counts.done : result_.counts.repaired);
  std::move(notes.begin(), notes.end(), std::back_inserter(result_.notes));
}

void Collector::pass_over(std::string place, std::string text) {
  ++result_.counts.read;
  ++result_.counts.passed_over;
  note(std::move(place), std::move(text));
}

void Collector::note(std::string place, std::string text) {
  result_.notes.push_back({std::nullopt, std::move(place), std::move(text)});
}

void Collector::reject(DataError error) {
  ++result_.counts.read;
  ++result_.counts.rejected;
  if (!options_.keep_going) throw error;
  result_.rejected.push_back(std::move(error));
}

}  // namespace exactvo::datasets
