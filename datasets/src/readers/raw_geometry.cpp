// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/raw_geometry.h"

#include <algorithm>
#include <utility>

#include "exactvo/geometry/even_odd.h"
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
    case DataCode::clockwise:
      return "winding reversed";
    case DataCode::too_few_points:
    case DataCode::zero_area:
      return "hole dropped: nothing is in it";
    default:
      return "cut at its crossings, and recombined by the even-odd rule";
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

/// Where it is; a JSON pointer names no vertex, so that is said here.
std::string words_for_where(const RingFinding& finding) {
  const bool is_pointer = finding.place.rfind('/', 0) == 0;
  const std::string vertex = is_pointer ? "vertex " + std::to_string(finding.vertex) + ", " : "";
  return " at " + vertex + coordinates(finding.where);
}

/// A polygon's JSON needs no repeated first point, so its absence is no repair worth a note there.
bool is_worth_a_note(const RawGeometry& raw, DataCode code) {
  return code != DataCode::unclosed || raw.ring_pointers.empty();
}

std::vector<DataCode> codes_of(const std::vector<RingFinding>& findings) {
  std::vector<DataCode> codes;
  for (const RingFinding& finding : findings) codes.push_back(finding.code);
  std::sort(codes.begin(), codes.end());
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  return codes;
}

/// A refusal by a rule of `repair` that is no ring's problem.
DataError repair_refusal(DataCode code, const std::string& file, const std::string& place) {
  switch (code) {
    case DataCode::size:
      return {code, file, place, "too many crossings of edges",
              "at most " + std::to_string(geometry::most_crossings(0)) + " and two an edge"};
    case DataCode::out_of_range:
      return {code, file, place, "rings that cross and have a coordinate beyond 2^100 m", "nearer ones"};
    case DataCode::zero_area:
      return {code, file, place, "rings that enclose nothing an odd number of times", "some area"};
    case DataCode::rounding:
      return {code, file, place, "crossings that meet again however they are rounded to doubles",
              "rings farther apart"};
    default:
      return {code, file, place, "rings that could not be cut", "rings that can be"};
  }
}

std::vector<RingFinding> findings_of(const std::vector<geometry::RingProblem>& problems, const RawGeometry& raw) {
  std::vector<RingFinding> findings;
  for (const geometry::RingProblem& problem : problems) {
    const DataCode code = data_code(problem.code);
    if (problem.mended && !is_worth_a_note(raw, code)) continue;
    const std::string place = place_of_vertex(raw, problem.ring, problem.vertex);
    findings.push_back({code, place, raw.place, problem.where, problem.ring, problem.vertex, problem.mended});
  }
  return findings;
}

}  // namespace

const char* words_of(const RingFinding& finding) {
  return words_for(finding.code);
}

std::string place_of_vertex(const RawGeometry& raw, std::size_t ring, std::size_t vertex) {
  if (ring < raw.ring_pointers.size()) return raw.ring_pointers[ring];
  return raw.place + ", ring " + std::to_string(ring) + ", vertex " + std::to_string(vertex);
}

Judgement judge(const RawGeometry& raw) {
  if (raw.kind == RawKind::polyline) {
    geometry::NormalizedPolyline normal = geometry::normalize_polyline(raw.rings.at(0));
    return {std::move(normal.polyline), findings_of(normal.problems, raw)};
  }
  geometry::NormalizedPolygon normal = geometry::normalize(raw.rings);
  return {std::move(normal.polygon), findings_of(normal.problems, raw)};
}

DataError ring_refusal(const RingFinding& finding, const std::string& file) {
  return {finding.code, file, finding.place, words_for(finding.code) + words_for_where(finding),
          expectation(finding.code)};
}

void refuse_unmended(const Judgement& judgement, const std::string& file) {
  for (const RingFinding& finding : judgement.findings) {
    if (!finding.mended) throw ring_refusal(finding, file);
  }
}

Collector::Collector(std::string file, std::string format, const ReadOptions& options, const ObstacleStream* stream)
    : options_(options), stream_(stream) {
  result_.file = std::move(file);
  result_.format = std::move(format);
}

void Collector::add(const RawGeometry& raw) {
  if (options_.repair && raw.kind == RawKind::polygon) return add_mended(raw);
  Judgement judgement = judge(raw);
  take_findings(judgement.findings);
  try {
    refuse_unmended(judgement, result_.file);
  } catch (const DataError& error) {
    return reject(error);
  }
  count(judgement.findings);
  keep(raw.id, std::move(judgement.shape), !judgement.findings.empty());
}

void Collector::add_mended(const RawGeometry& raw) {
  Repair mended = repair(raw.rings);
  const Judgement judgement{geometry::Polygon{}, findings_of(mended.problems, raw)};
  take_findings(judgement.findings);
  if (mended.changed() && stream_ == nullptr) {
    result_.repairs.push_back({raw.place, raw.id, codes_of(judgement.findings), mended.refused, mended.recombined,
                               mended.moved, mended.recombined ? raw.rings : std::vector<geometry::Ring>{},
                               mended.before, mended.after});
  }
  if (!mended.ok()) return reject(refusal_of(*mended.refused, judgement, raw.place));
  count(judgement.findings);
  for (std::size_t k = 0; k < mended.polygons.size(); ++k) {
    keep(k == 0 ? raw.id : raw.id + "-" + std::to_string(k + 1), std::move(mended.polygons[k]),
         !judgement.findings.empty());
  }
}

DataError Collector::refusal_of(DataCode reason, const Judgement& judgement, const std::string& place) const {
  for (const RingFinding& finding : judgement.findings) {
    if (finding.code == reason && !finding.mended) return ring_refusal(finding, result_.file);
  }
  return repair_refusal(reason, result_.file, place);
}

void Collector::take_findings(const std::vector<RingFinding>& findings) {
  if (stream_ != nullptr) return;
  result_.findings.insert(result_.findings.end(), findings.begin(), findings.end());
}

/// Of an input that can be used.
void Collector::count(const std::vector<RingFinding>& findings) {
  ++result_.counts.read;
  ++(findings.empty() ? result_.counts.done : result_.counts.repaired);
  if (stream_ != nullptr) return;
  for (const RingFinding& mended : findings) {
    result_.notes.push_back({mended.code, mended.place, words_for_mending(mended.code)});
  }
}

void Collector::keep(std::string id, geometry::Obstacle shape, bool repaired) {
  extend(shape);
  if (stream_ != nullptr) return stream_->obstacle({std::move(id), std::move(shape)}, repaired);
  std::vector<formation::SceneObstacle>& kept = result_.obstacles;
  // By quarters: a million polygons in a vector that doubles take twice the room, and thrice while it grows.
  if (kept.size() == kept.capacity()) kept.reserve(kept.size() + kept.size() / 4 + 16);
  kept.push_back({std::move(id), std::move(shape)});
}

void Collector::extend(const geometry::Obstacle& shape) {
  for (const geometry::Vec2 p : geometry::vertices_of(shape)) {
    if (!result_.extent) result_.extent = Extent{p, p};
    Extent& e = *result_.extent;
    e.low = {std::min(e.low.x, p.x), std::min(e.low.y, p.y)};
    e.high = {std::max(e.high.x, p.x), std::max(e.high.y, p.y)};
  }
}

void Collector::pass_over(std::string place, std::string text) {
  ++result_.counts.read;
  ++result_.counts.passed_over;
  note(std::move(place), std::move(text));
}

void Collector::progress(double share) const {
  if (stream_ != nullptr && stream_->progress) stream_->progress(share);
}

void Collector::note(std::string place, std::string text) {
  if (stream_ != nullptr && !place.empty()) return;
  result_.notes.push_back({std::nullopt, std::move(place), std::move(text)});
}

void Collector::reject(DataError error) {
  ++result_.counts.read;
  ++result_.counts.rejected;
  if (stream_ != nullptr) return stream_->rejected(std::move(error));
  if (!options_.keep_going) throw error;
  result_.rejected.push_back(std::move(error));
}

}  // namespace exactvo::datasets
