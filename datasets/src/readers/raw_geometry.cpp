// SPDX-License-Identifier: GPL-3.0-or-later
#include "readers/raw_geometry.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/even_odd.h"
#include "exactvo/geometry/too_many_contacts.h"
#include "json/json_text.h"

namespace exactvo::datasets {
namespace {

/// A place that was projected: its digits beyond are the projection's rounding. (Adding 0 takes the sign off -0.)
double to_millimetres(double metres) {
  return std::round(metres * 1000.0) / 1000.0 + 0.0;
}

std::string coordinates(geometry::Vec2 p) {
  return "(" + number_text(p.x) + ", " + number_text(p.y) + ")";
}

constexpr const char* kCut = "cut at its crossings, and recombined by the even-odd rule";
constexpr const char* kHoleDropped = "hole dropped: nothing is in it";

/// What is said of a finding: what was found, what is expected where it is refused, and how it is repaired.
struct FindingWords {
  DataCode code;
  const char* found;
  const char* expected;
  const char* repair;
};
constexpr FindingWords kHoles{DataCode::hole_outside, "a hole that is not inside its polygon or meets another ring",
                              "holes inside their polygon, apart from each other; exactvo repair cuts rings that cross",
                              kCut};
constexpr FindingWords kFindings[] = {
    {DataCode::not_finite, "a coordinate that is no finite number", "finite coordinates", kCut},
    {DataCode::too_few_points, "too few distinct points", "at least three distinct points in a ring, two in a polyline",
     kHoleDropped},
    {DataCode::unclosed, "a ring that does not end where it began", kHoles.expected, "ring closed"},
    {DataCode::repeated_vertex, "the same point twice running", kHoles.expected, "repeated vertex dropped"},
    {DataCode::clockwise, "the wrong winding", kHoles.expected, "winding reversed"},
    {DataCode::zero_area, "a ring without area", "a ring that encloses some area", kHoleDropped},
    {DataCode::self_intersection, "a ring that crosses or touches itself",
     "a simple ring; exactvo repair cuts rings that cross", kCut},
    {DataCode::out_of_range, "a coordinate beyond 2^100 m", "coordinates within 2^100 m, 1.27e30 m, of (0, 0)", kCut},
    {DataCode::size, "rings that touch or cross too often",
     "rings whose edges' boxes meet in at most 2^26 pairs, and fewer or smaller holes", kCut}};

const FindingWords& words_for(DataCode code) {
  const auto* found =
      std::find_if(std::begin(kFindings), std::end(kFindings), [&](const FindingWords& w) { return w.code == code; });
  return found == std::end(kFindings) ? kHoles : *found;
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
      return {code, file, place, "too many contacts of edges",
              "at most " + std::to_string(geometry::most_crossings(0)) + " and two an edge"};
    case DataCode::out_of_range:
      return {code, file, place, "rings that cross and have a coordinate beyond 2^100 m", "nearer ones"};
    case DataCode::zero_area:
      return {code, file, place, "rings that enclose no area by the even-odd rule", "rings that enclose some"};
    case DataCode::rounding:
      return {code, file, place, "crossings that meet again however they are rounded to doubles",
              "rings farther apart"};
    default:
      return {code, file, place, "rings that could not be cut", "rings that can be"};
  }
}

RingFinding finding_at(DataCode code, const RawGeometry& raw, const geometry::RingProblem& at) {
  RingFinding finding;
  finding.code = code;
  finding.place = place_of_vertex(raw, at.ring, at.vertex);
  finding.feature = raw.place;
  finding.where = at.where;
  finding.ring = at.ring;
  finding.vertex = at.vertex;
  finding.repaired = at.repaired;
  finding.at_vertex = at.where;
  const geometry::Ring& ring = raw.rings[at.ring];
  if (ring.empty()) return finding;
  const bool is_vertex = !geometry::is_finite(at.where) || at.where == ring.at(at.vertex);
  finding.at_vertex = raw.as_written ? raw.as_written->rings[at.ring][at.vertex] : ring[at.vertex];
  if (!raw.as_written) return finding;
  finding.in_file =
      PlaceInFile{is_vertex ? finding.at_vertex : raw.as_written->from_metres(at.where), raw.as_written->is_degrees};
  return finding;
}

/// `normalize` expects outer rings counter-clockwise. Of a format that winds them clockwise those rings are wrong that
/// it found right.
std::vector<geometry::RingProblem> judged_by_format(std::vector<geometry::RingProblem> problems,
                                                    const RawGeometry& raw) {
  if (raw.winding == Winding::counter_clockwise || raw.kind != RawKind::polygon) return problems;
  using geometry::RingProblem;
  const auto is_turned = [](const RingProblem& p) { return p.code == geometry::RingProblemCode::clockwise; };
  std::vector<bool> is_right(raw.rings.size());  // or encloses nothing
  for (const RingProblem& p : problems) {
    const bool is_spoilt = !p.repaired && p.code != geometry::RingProblemCode::hole_outside;
    if (is_turned(p) || is_spoilt) is_right[p.ring] = true;
  }
  std::vector<RingProblem> wrong;
  for (std::size_t ring = 0; ring < raw.rings.size(); ++ring) {
    if (is_right[ring] || raw.rings[ring].empty()) continue;
    wrong.push_back({geometry::RingProblemCode::clockwise, ring, 0, raw.rings[ring].front(), true});
  }
  problems.erase(std::remove_if(problems.begin(), problems.end(), is_turned), problems.end());
  problems.insert(problems.end(), wrong.begin(), wrong.end());
  std::stable_sort(problems.begin(), problems.end(), [](const RingProblem& a, const RingProblem& b) {
    return std::tie(a.ring, a.vertex, a.code) < std::tie(b.ring, b.vertex, b.code);
  });
  return problems;
}

ValidationResult validation_of(geometry::Obstacle shape, const std::vector<geometry::RingProblem>& problems,
                               const RawGeometry& raw) {
  ValidationResult checked{std::move(shape), {}, {}};
  bool is_refused = false;
  for (const geometry::RingProblem& problem : problems) {
    const DataCode code = data_code(problem.code);
    // A polygon's JSON needs no repeated first point, so its absence is no repair worth a note there.
    if (problem.repaired && code == DataCode::unclosed && !raw.ring_pointers.empty()) continue;
    const bool first_refusal = !problem.repaired && !is_refused;
    is_refused = is_refused || !problem.repaired;
    if (checked.findings.size() < kMostFindings || first_refusal) {
      checked.findings.push_back(finding_at(code, raw, problem));
    } else {
      ++checked.unlisted[code];
    }
  }
  return checked;
}

/// The first coordinate beyond kLargestCoordinate of each ring; what is not finite is another problem.
std::vector<RingFinding> far_findings(const RawGeometry& raw) {
  const auto is_far = [](geometry::Vec2 p) {
    return geometry::is_finite(p) && std::max(std::fabs(p.x), std::fabs(p.y)) > kLargestCoordinate;
  };
  std::vector<RingFinding> findings;
  for (std::size_t k = 0; k < raw.rings.size(); ++k) {
    const geometry::Ring& ring = raw.rings[k];
    const auto far = std::find_if(ring.begin(), ring.end(), is_far);
    if (far == ring.end()) continue;
    geometry::RingProblem at{};
    at.ring = k;
    at.vertex = static_cast<std::size_t>(far - ring.begin());
    at.where = *far;
    findings.push_back(finding_at(DataCode::out_of_range, raw, at));
  }
  return findings;
}

}  // namespace

const char* words_of(const RingFinding& finding) {
  return words_for(finding.code).found;
}

std::string words_of_place(const RingFinding& finding) {
  const bool is_projected = finding.in_file && finding.in_file->is_degrees;
  const auto local_metres = [&](double x) { return number_text(is_projected ? to_millimetres(x) : x); };
  const auto named = [&](geometry::Vec2 p) {
    if (!is_projected) return coordinates(p);
    return "longitude " + number_text(p.x) + ", latitude " + number_text(p.y);
  };
  const geometry::Vec2 where = finding.in_file ? finding.in_file->where : finding.where;
  std::string text = named(where);
  if (finding.in_file) text += " (" + local_metres(finding.where.x) + ", " + local_metres(finding.where.y) + " m)";
  const bool is_vertex = !geometry::is_finite(where) || where == finding.at_vertex;
  return is_vertex ? text : text + ", on an edge at vertex " + named(finding.at_vertex);
}

RawGeometry part_of_geometry(std::size_t number, RawKind kind, const std::string& id, const std::string& place,
                             std::vector<geometry::Ring> rings) {
  if (number == 0) return {kind, id, place, std::move(rings)};
  const std::string from_one = std::to_string(number + 1);
  return {kind, id + "." + from_one, place + ", part " + from_one, std::move(rings)};
}

std::string place_of_vertex(const RawGeometry& raw, std::size_t ring, std::size_t vertex) {
  if (ring < raw.ring_pointers.size()) return raw.ring_pointers[ring];
  return raw.place + ", ring " + std::to_string(ring) + ", vertex " + std::to_string(vertex);
}

ValidationResult validate(const RawGeometry& raw) {
  if (raw.kind == RawKind::polyline) {
    geometry::NormalizedPolyline normal = geometry::normalize_polyline(raw.rings.at(0));
    return validation_of(std::move(normal.polyline), normal.problems, raw);
  }
  try {
    geometry::NormalizedPolygon normal = geometry::normalize(raw.rings);
    return validation_of(std::move(normal.polygon), judged_by_format(std::move(normal.problems), raw), raw);
  } catch (const geometry::TooManyContacts&) {
    geometry::RingProblem at{};
    at.where = raw.rings[0].empty() ? geometry::Vec2{} : raw.rings[0].front();
    return {geometry::Polygon{}, {finding_at(DataCode::size, raw, at)}, {}};
  }
}

DataError ring_refusal(const RingFinding& finding, const std::string& file) {
  const bool is_pointer = finding.place.rfind('/', 0) == 0;  // of JSON, which names no vertex
  const std::string vertex = is_pointer ? "vertex " + std::to_string(finding.vertex) + ", " : "";
  return {finding.code, file, finding.place, words_for(finding.code).found + (" at " + vertex) + words_of_place(finding),
          words_for(finding.code).expected};
}

void refuse_unrepaired(const ValidationResult& checked, const std::string& file) {
  for (const RingFinding& finding : checked.findings) {
    if (!finding.repaired) throw ring_refusal(finding, file);
  }
}

DataError other_system(int srid, int before, const std::string& file, const std::string& place) {
  const auto words = [](int s) { return s == 0 ? std::string("no SRID") : "SRID=" + std::to_string(s); };
  return {DataCode::projection, file, place, words(srid),
          words(before) +
              ", as the first geometry has: one reference system a file; units metres takes the numbers as they stand"};
}

Collector::Collector(std::string file, std::string format, const ReadOptions& options, const ObstacleStream* stream)
    : options_(options), stream_(stream) {
  result_.file = std::move(file);
  result_.format = std::move(format);
}

void Collector::add(const RawGeometry& raw) {
  call_wait_hook();
  if (reject_far(raw)) return;
  if (options_.repair && raw.kind == RawKind::polygon) return add_repaired(raw);
  ValidationResult checked = validate(raw);
  take_findings(checked.findings, checked.unlisted);
  try {
    refuse_unrepaired(checked, result_.file);
  } catch (const DataError& error) {
    return reject(error);
  }
  count(checked.findings);
  keep(raw, raw.id, std::move(checked.shape), !checked.findings.empty());
}

bool Collector::reject_far(const RawGeometry& raw) {
  const std::vector<RingFinding> findings = far_findings(raw);
  if (findings.empty()) return false;
  take_findings(findings);
  reject(ring_refusal(findings.front(), result_.file));
  return true;
}

void Collector::add_repaired(const RawGeometry& raw) {
  Repair repaired = repair(raw.rings);
  repaired.problems = judged_by_format(std::move(repaired.problems), raw);
  const ValidationResult checked = validation_of(geometry::Polygon{}, repaired.problems, raw);
  take_findings(checked.findings, checked.unlisted);
  if (repaired.changed() && stream_ == nullptr) {
    result_.repairs.push_back({raw.place, raw.id, codes_of(checked.findings), repaired.refused, repaired.recombined,
                               repaired.moved, repaired.recombined ? raw.rings : std::vector<geometry::Ring>{},
                               repaired.before, repaired.after});
  }
  if (!repaired.ok()) return reject(refusal_of(*repaired.refused, checked, raw.place));
  count(checked.findings);
  for (std::size_t k = 0; k < repaired.polygons.size(); ++k) {
    keep(raw, k == 0 ? raw.id : raw.id + "-" + std::to_string(k + 1), std::move(repaired.polygons[k]),
         !checked.findings.empty());
  }
}

DataError Collector::refusal_of(DataCode reason, const ValidationResult& checked, const std::string& place) const {
  for (const RingFinding& finding : checked.findings) {
    if (finding.code == reason && !finding.repaired) return ring_refusal(finding, result_.file);
  }
  return repair_refusal(reason, result_.file, place);
}

void Collector::take_findings(const std::vector<RingFinding>& findings,
                              const std::map<DataCode, std::size_t>& unlisted) {
  if (stream_ != nullptr) return;
  for (const auto& [code, count] : unlisted) result_.unlisted[code] += count;
  const std::size_t room = kMostFindings - result_.findings.size();
  const auto end = findings.begin() + static_cast<std::ptrdiff_t>(std::min(room, findings.size()));
  result_.findings.insert(result_.findings.end(), findings.begin(), end);
  for (auto left_out = end; left_out != findings.end(); ++left_out) ++result_.unlisted[left_out->code];
}

/// Counts an input that can be used.
void Collector::count(const std::vector<RingFinding>& findings) {
  ++result_.counts.read;
  ++(findings.empty() ? result_.counts.done : result_.counts.repaired);
  if (stream_ != nullptr) return;
  for (const RingFinding& repaired : findings) {
    if (notes_of_findings_++ >= kMostFindings) return;
    result_.notes.push_back({repaired.code, repaired.place, words_for(repaired.code).repair, true});
  }
}

void Collector::keep(const RawGeometry& raw, std::string id, geometry::Obstacle shape, bool repaired) {
  extend(shape);
  if (stream_ != nullptr) return stream_->obstacle({std::move(id), std::move(shape)}, repaired);
  std::vector<formation::SceneObstacle>& kept = result_.obstacles;
  // By quarters: a million polygons in a vector that doubles take twice the room, and thrice while it grows.
  if (kept.size() == kept.capacity()) kept.reserve(kept.size() + kept.size() / 4 + 16);
  kept.push_back({std::move(id), std::move(shape), raw.disc});
  if (!options_.keep_properties) return;
  const bool is_first = result_.properties.empty() && (!raw.properties.id.empty() || !raw.properties.members.empty());
  if (!is_first && result_.properties.empty()) return;
  result_.properties.resize(kept.size() - 1);  // of those before the first that has any
  result_.properties.push_back(raw.properties);
}

void Collector::set_plane(const LocalPlane& plane) {
  const LocalPlane& before = result_.plane;
  const bool same_origin = before.origin.has_value() == plane.origin.has_value() &&
                           (!plane.origin || (before.origin->longitude == plane.origin->longitude &&
                                              before.origin->latitude == plane.origin->latitude));
  const bool is_same =
      same_origin && before.reference_system == plane.reference_system && before.offset == plane.offset;
  result_.plane = !has_plane_ || is_same ? plane : LocalPlane{};
  has_plane_ = true;
  if (stream_ != nullptr && stream_->plane) stream_->plane(plane);
}

void Collector::extend(const geometry::Obstacle& shape) {
  for (const geometry::Vec2 p : geometry::vertices_of(shape)) {
    if (!result_.extent) result_.extent.emplace();
    result_.extent->add(p);
  }
}

void Collector::pass_over(std::string place, std::string text) {
  call_wait_hook();
  ++result_.counts.read;
  ++result_.counts.passed_over;
  if (stream_ == nullptr) result_.notes.push_back({std::nullopt, std::move(place), std::move(text), true});
}

void Collector::reference_system(int srid, const std::string& place) {
  if (options_.units != Units::automatic) return;
  const bool is_first = !srid_;
  if (is_first) srid_ = srid;
  if (is_first && srid != 0) throw ReferenceSystemMet{srid};
  if (srid != *srid_) throw other_system(srid, *srid_, result_.file, place);
}

void Collector::note(std::string place, std::string text) {
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
