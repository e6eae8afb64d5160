// SPDX-License-Identifier: GPL-3.0-or-later
// Polynomials of quadrotors as the programs for Crazyflies and uav_trajectories exchange them: CSV with the header
// duration,x^0,...,x^7,y^0,...,z^0,...,yaw^0,...; each line is a piece, in powers of the time since its beginning. A
// file is one agent. Only x and y count. It also reads curves in JSON: each line is an object, as in certificates.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "exactvo/datasets/input_text.h"
#include "exactvo/datasets/obstacle_file.h"
#include "files/text_file.h"
#include "json/json_text.h"
#include "readers/line_reader.h"
#include "trajectories/trajectory_readers.h"

namespace exactvo::datasets {
namespace {

/// Rows of one piece, which only show where it goes.
constexpr int kSamples = 16;

/// Where the powers of a coordinate stand.
std::vector<std::size_t> powers_of(char coordinate, const std::vector<std::string_view>& header) {
  std::vector<std::size_t> columns;
  for (;;) {
    const std::string name = std::string(1, coordinate) + "^" + std::to_string(columns.size());
    const auto at = std::find(header.begin(), header.end(), name);
    if (at == header.end()) return columns;
    columns.push_back(static_cast<std::size_t>(at - header.begin()));
  }
}

struct Header {
  std::size_t count = 0, duration = 0;
  std::vector<std::size_t> x, y;  ///< columns of the powers
};

std::optional<Header> header_in(std::string_view line) {
  line = trimmed(line);
  if (line.substr(0, 1) == "#") line.remove_prefix(1);
  const std::vector<std::string_view> names = fields_of(trimmed(line), ',');
  const auto is_duration = [](std::string_view name) { return name == "duration" || name == "Duration"; };
  const auto at = std::find_if(names.begin(), names.end(), is_duration);
  if (at == names.end()) return std::nullopt;
  Header header{names.size(), static_cast<std::size_t>(at - names.begin()), powers_of('x', names),
                powers_of('y', names)};
  if (header.x.empty() || header.x.size() != header.y.size()) return std::nullopt;
  return header;
}

geometry::Vec2 value_of(const std::vector<geometry::Vec2>& powers, double t) {
  geometry::Vec2 p;
  for (std::size_t k = powers.size(); k-- > 0;) p = t * p + powers[k];
  return p;
}

Header required_header(TextLines& lines, const TrajectorySink& out) {
  std::string_view line;
  std::optional<Header> header;
  if (lines.next(line)) header = header_in(line);
  if (!header)
    out.refuse(DataCode::format_syntax, 1, excerpt(line, 0, 40), "a header duration,x^0,x^1,...,y^0,y^1,...");
  if (header->x.size() > geometry::kMostDegree + 1)
    out.refuse(DataCode::out_of_range, 1, "x^" + std::to_string(header->x.size() - 1),
               "powers up to " + std::to_string(geometry::kMostDegree));
  return *header;
}

/// Files of one name in several folders are told apart by their paths.
std::size_t agent_of(const std::filesystem::path& path, TrajectorySink& out) {
  const std::vector<std::string>& known = out.file().agents;
  const std::string stem = path.stem().string();
  const bool is_taken = std::find(known.begin(), known.end(), stem) != known.end();
  return out.agent(is_taken ? path.string() : stem);
}

geometry::CurvedMotion piece_in(std::string_view text, const Header& header, double begin, std::uint64_t line,
                                const TrajectorySink& out) {
  const std::vector<std::string_view> fields = fields_of(text, ',');
  if (fields.size() < header.count)
    out.refuse(DataCode::wrong_count, line, std::to_string(fields.size()) + " fields",
               std::to_string(header.count) + " fields, as the header has");
  const double duration = out.number(fields[header.duration], "a duration", line);
  if (!(duration > 0.0) || !(begin + duration > begin))
    out.refuse(DataCode::out_of_range, line, std::string(fields[header.duration]), "a duration above 0 s");
  geometry::CurvedMotion curve{geometry::CurveBasis::powers, begin, begin + duration, {}};
  double power = 1.0;  // of the duration
  const auto coefficient = [&](std::size_t column) {
    const double c = out.scale() * out.number(fields[column], "a coefficient", line);
    if (!(std::fabs(c) * power <= kLargestCoordinate))
      out.refuse(DataCode::out_of_range, line,
                 std::string(fields[column]) + " of a piece of " + std::string(fields[header.duration]) + " s",
                 "terms up to 2^100 m");
    return c;
  };
  for (std::size_t k = 0; k < header.x.size(); ++k, power *= duration) {
    const double x = coefficient(header.x[k]);
    curve.points.push_back({x, coefficient(header.y[k])});
  }
  return curve;
}

/// Samples of a piece; of one that follows no other also its beginning.
void add_rows(std::size_t agent, const geometry::CurvedMotion& curve, bool is_first, std::uint64_t line,
              TrajectorySink& out) {
  const bool has_powers = curve.basis == geometry::CurveBasis::powers;
  std::vector<geometry::Vec2> velocity;
  for (std::size_t k = 1; k < curve.points.size(); ++k) velocity.push_back(static_cast<double>(k) * curve.points[k]);
  const double duration = curve.end - curve.start;
  for (int s = is_first ? 0 : 1; s <= kSamples; ++s) {
    const double t = static_cast<double>(s) / kSamples * duration;
    const double time = s == kSamples ? curve.end : std::min(curve.start + t, curve.end);
    out.row(agent, time, geometry::position_at(curve, time) / out.scale(), line, TrajectoryRow().heading,
            has_powers ? value_of(velocity, t) / out.scale() : TrajectoryRow().velocity);
  }
}

void note_samples(TrajectoryFile& file, const std::string& more) {
  file.notes.push_back("rows are " + std::to_string(kSamples) +
                       " samples of each piece; overlaps are those of the polynomials themselves" + more);
}

// --- JSON ---

constexpr const char* kBases[] = {"powers", "bezier", "b-spline"};

/// Points of a curve, in m. Of powers each term has bounds.
std::vector<geometry::Vec2> points_in(const JsonCursor& list, double scale, double time_unit) {
  std::vector<geometry::Vec2> points;
  double factor = 1.0;
  for (std::size_t k = 0; k < list.size(); ++k, factor *= time_unit) {
    const geometry::Vec2 p = scale * list.at(k).point();
    if (!(std::max(std::fabs(p.x), std::fabs(p.y)) * factor <= kLargestCoordinate))
      list.at(k).refuse("numbers up to 2^100 m", DataCode::out_of_range);
    points.push_back(p);
  }
  return points;
}

/// The pieces of a line: one from `start` to `end`, or those of a uniform B-spline, an `interval` each.
std::vector<geometry::CurvedMotion> curves_in(const JsonCursor& line, double scale) {
  const auto basis = std::find(std::begin(kBases), std::end(kBases), line.at("basis").text());
  if (basis == std::end(kBases)) line.at("basis").refuse("powers, bezier or b-spline", DataCode::not_an_option);
  const auto kind = static_cast<geometry::CurveBasis>(basis - std::begin(kBases));
  const JsonCursor list = line.at("points");
  const auto has_degree = [&](std::size_t degree) {
    if (degree > geometry::kMostDegree)
      list.refuse("a degree up to " + std::to_string(geometry::kMostDegree), DataCode::out_of_range);
  };
  const double start = line.at("start").number();
  const auto later = [&](const char* key, double time) {
    if (!(start < time && time - start <= kLargestCoordinate && std::fabs(start) <= kLargestCoordinate))
      line.at(key).refuse("a time after the start, both finite and up to 2^100 s", DataCode::out_of_range);
  };
  if (kind == geometry::CurveBasis::b_spline && line.has("interval")) {
    const std::uint64_t degree = line.at("degree").count();
    has_degree(degree);
    if (list.size() <= degree) list.refuse("more points than the degree", DataCode::wrong_count);
    const double interval = line.at("interval").number();
    const double pieces = static_cast<double>(list.size() - degree);
    later("interval", start + pieces * interval);
    std::vector<geometry::CurvedMotion> curves =
        geometry::b_spline_pieces(points_in(list, scale, 1.0), degree, start, interval);
    for (const geometry::CurvedMotion& curve : curves)
      if (!(curve.start < curve.end))
        line.at("interval").refuse("an interval that makes times differ", DataCode::out_of_range);
    return curves;
  }
  const double end = line.at("end").number();
  later("end", end);
  if (list.size() == 0) list.refuse("at least one point", DataCode::wrong_count);
  has_degree(list.size() - 1);
  const double unit = kind == geometry::CurveBasis::powers ? end - start : 1.0;
  return {{kind, start, end, points_in(list, scale, unit)}};
}

}  // namespace

bool looks_like_polynomials(std::string_view beginning) {
  return header_in(beginning.substr(0, beginning.find('\n'))).has_value();
}

void read_polynomials(const std::filesystem::path& path, TrajectorySink& out) {
  TextLines lines(path.string(), kLongestRow);
  const Header header = required_header(lines, out);
  const std::size_t agent = agent_of(path, out);
  std::vector<geometry::CurvedMotion> curves;
  for (std::string_view line; lines.next(line);) {
    if (trimmed(line).empty()) continue;
    const double begin = curves.empty() ? 0.0 : curves.back().end;
    curves.push_back(piece_in(line, header, begin, lines.number(), out));
    add_rows(agent, curves.back(), curves.size() == 1, lines.number(), out);
  }
  if (curves.empty()) out.refuse(DataCode::wrong_count, lines.number(), "no piece", "a line for each piece");
  if (out.file().curves.empty()) note_samples(out.file(), "; z does not count");
  out.file().curves.resize(agent);
  out.file().curves.push_back(std::move(curves));
}

bool looks_like_curves(std::string_view beginning) {
  const std::string_view text = trimmed(without_mark(beginning));
  return text.substr(0, 1) == "{" && text.find("\"basis\"") != std::string_view::npos &&
         text.find("\"certificate\"") == std::string_view::npos;
}

void read_curves(const std::filesystem::path& path, TrajectorySink& out) {
  TextLines lines(path.string(), kLongestRow);
  TrajectoryFile& file = out.file();
  for (std::string_view text; lines.next(text);) {
    if (trimmed(text).empty()) continue;
    const Json json = parse_json_line(text, file.file, lines.number());
    const JsonCursor line(json, file.file, "line " + std::to_string(lines.number()));
    std::vector<geometry::CurvedMotion> added = curves_in(line, out.scale());
    const JsonCursor id = line.at("id");
    const std::size_t agent = out.agent(id.json().is_string() ? id.text() : number_text(id.number()));
    file.curves.resize(file.agents.size());
    for (geometry::CurvedMotion& curve : added) {
      std::vector<geometry::CurvedMotion>& known = file.curves[agent];
      const double ended = known.empty() ? -std::numeric_limits<double>::infinity() : known.back().end;
      if (curve.start < ended)
        line.at("start").refuse("no time before the end of the agent's last curve, " + number_text(ended) + " s",
                                DataCode::out_of_range);
      add_rows(agent, curve, ended < curve.start, lines.number(), out);
      known.push_back(std::move(curve));
    }
  }
  if (file.curves.empty()) out.refuse(DataCode::wrong_count, lines.number(), "no curve", "a line for each curve");
  note_samples(file, "");
}

}  // namespace exactvo::datasets
