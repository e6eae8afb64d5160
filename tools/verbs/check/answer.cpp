// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/check/answer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "exactvo/geometry/counted.h"
#include "support/escape.h"
#include "support/obstacle_name.h"

namespace exactvo::tools {

using datasets::AgentSurvey;
using datasets::Extreme;
using geometry::Approach;
using geometry::counted;
using geometry::Encounter;
using geometry::MotionEvent;

namespace {

/// Jumps, gaps and approaches that are listed in words; further ones are counted.
constexpr std::size_t kMostListed = 20;

/// s, to a microsecond, without zeros at the end.
std::string seconds(double time) {
  std::string text = fmt::format("{:.6f}", time);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string place_text(geometry::Vec2 p) {
  return fmt::format("({:.6g}, {:.6g})", p.x, p.y);
}

/// A depth or a distance from its bounds: one number where they agree in six digits.
std::string between_text(double low, double high) {
  const std::string a = fmt::format("{:.6g}", low), b = fmt::format("{:.6g}", high);
  return a == b ? a + " m" : fmt::format("{} to {} m", a, b);
}

/// `close`: it is open whether two bodies that turn touch, or overlap.
const char* word_of(const MotionEvent& e) {
  return e.is_open ? "close" : e.encounter == Encounter::overlap ? "overlap" : "contact";
}

/// How bodies move between rows, in words.
std::string assumption_of(const CheckedFile& asked) {
  if (asked.has_curves) return "along the file's polynomials";
  switch (asked.between) {
    case geometry::Between::straight:
      break;
    case geometry::Between::hold:
      return "each agent rests at a row until its next row";
    case geometry::Between::cubic:
      return asked.survey.has_velocities()
                 ? "along a cubic from each row to the next, with the file's velocities"
                 : "along a cubic from each row to the next, with the velocities of a Catmull-Rom spline";
    case geometry::Between::none:
      return "only the rows count, and nothing between them";
  }
  return asked.on_arcs ? "straight and uniform between rows of one heading"
                       : "straight and uniform from each row to the next";
}

/// Infinite bounds are left out.
OrderedJson number_or_null(double value) {
  return std::isfinite(value) ? OrderedJson(value + 0.0) : OrderedJson();  // -0.0 becomes 0.0
}

OrderedJson bounds_json(const geometry::Bounds& b) {
  return OrderedJson::array({number_or_null(b.low), number_or_null(b.high)});
}

OrderedJson extreme_json(const Extreme& e) {
  return {{"value", e.value}, {"time", e.time}, {"line", e.line > 0 ? OrderedJson(e.line) : OrderedJson()}};
}

}  // namespace

void SampledMoves::add(std::size_t agent, const geometry::Motion& piece) {
  last_[agent] = {Span{start_of(piece), end_of(piece)}, last_[agent][0]};
}

bool SampledMoves::finds(const MotionEvent& event) const {
  // An event is reported when the first piece begins behind its end, so it ends in one of the body's last two pieces.
  const std::array<Span, 2>& last = last_[event.body];
  const Span& piece = last[0].from <= event.last.high ? last[0] : last[1];
  const double begin = piece.from, step = (piece.to - begin) / static_cast<double>(samples_);
  if (event.first.low <= begin) return true;
  if (!(step > 0.0)) return true;
  const double next = begin + step * std::ceil((event.first.high - begin) / step);
  return next <= event.last.low;
}

std::string CheckAnswer::name_of(std::size_t agent) const {
  return asked_.file.agents[agent];
}

std::string CheckAnswer::other_of(bool with_obstacle, std::size_t other) const {
  return with_obstacle ? obstacle_name(asked_.obstacles[other]) : name_of(other);
}

void CheckAnswer::put(const std::string& text) {
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  waiting_ += text;
  if (waiting_.size() > kChunk) print_waiting();
}

void CheckAnswer::print_waiting() {
  if (progress_) progress_->clear();
  print(waiting_);
  waiting_.clear();
}

void CheckAnswer::begin() {
  if (json_) return;
  const datasets::TrajectorySurvey& s = asked_.survey;
  std::string text =
      fmt::format("{}: {}, {} of {}, from {} s to {} s\n", asked_.file.file, asked_.file.format,
                  counted(s.rows(), "row"), counted(s.agents().size(), "agent"), seconds(s.first()), seconds(s.last()));
  text += fmt::format("assumed: {}; {}{}\n", asked_.bodies, assumption_of(asked_),
                      std::isfinite(asked_.longest_gap)
                          ? fmt::format("; away where it has no row for more than {:.6g} s", asked_.longest_gap)
                          : "");
  if (!asked_.obstacles.empty())
    text += fmt::format("map: {}, {}\n", asked_.map, counted(asked_.obstacles.size(), "obstacle"));
  put(shown_lines(text));
}

void CheckAnswer::add(const MotionEvent& e) {
  if (json_) {
    OrderedJson json{{"event", word_of(e)}, {"body", name_of(e.body)}};
    json[e.with_obstacle ? "obstacle" : "other"] = e.with_obstacle ? asked_.obstacles[e.other].id : name_of(e.other);
    json["first"] = bounds_json(e.first);
    json["last"] = bounds_json(e.last);
    json["clearance"] = bounds_json(e.clearance);
    json["time"] = e.nearest_time;
    json["place"] = json_point(e.place);
    return put(json_line(json));
  }
  const std::string first = seconds(e.first.low), last = seconds(e.last.high);
  const std::string when =
      first == last ? fmt::format("at {} s", first) : fmt::format("from {} s to {} s", first, last);
  std::string text =
      fmt::format("{}: {} and {}, {}", word_of(e), name_of(e.body), other_of(e.with_obstacle, e.other), when);
  if (e.encounter == Encounter::overlap && asked_.has_depth(e))
    text += fmt::format(", {} deep at {} s", between_text(0.0 - e.clearance.high, 0.0 - e.clearance.low),
                        seconds(e.nearest_time));
  else if (e.encounter == Encounter::overlap)
    text += fmt::format(", for example at {} s", seconds(e.nearest_time));
  if (e.is_open && e.clearance.high > 0.0)
    text += fmt::format(", nearer than {:.3g} m; whether they touch is open", e.clearance.high);
  else if (e.is_open)
    text += "; they touch, and whether they overlap is open";
  put(shown(text + fmt::format(", at {}", place_text(e.place))) + "\n");
}

void CheckAnswer::look_at(const datasets::Move& move) {
  const bool is_gap = move.interval() > asked_.survey.gap_of(move.agent);
  const bool is_jump = move.speed() > asked_.jump_speed;
  jumps_ += is_jump ? 1 : 0;
  gaps_ += is_gap ? 1 : 0;
  if (json_) {
    const auto finding = [&](const char* what) {
      return OrderedJson{{"finding", what},
                         {"body", name_of(move.agent)},
                         {asked_.file.row_word, move.to.line},
                         {"from", move.from.time},
                         {"to", move.to.time}};
    };
    if (is_jump) {
      OrderedJson json = finding("jump");
      json["length"] = norm(move.to.at - move.from.at);
      json["speed"] = move.speed();
      put(json_line(json));
    }
    if (is_gap) put(json_line(finding("gap")));
    return;
  }
  const std::string where = fmt::format("{}, {} {}: ", name_of(move.agent), asked_.file.row_word, move.to.line);
  if (is_jump && jumps_ <= kMostListed)
    put(shown(fmt::format("jump: {}{:.6g} m in {:.6g} s, {:.6g} m/s", where, norm(move.to.at - move.from.at),
                          move.interval(), move.speed())) +
        "\n");
  if (is_gap && gaps_ <= kMostListed)
    put(shown(fmt::format("gap: {}no row from {} s to {} s", where, seconds(move.from.time), seconds(move.to.time))) +
        "\n");
}

void CheckAnswer::list_approaches(const std::vector<Approach>& approaches) {
  if (json_) {
    for (const Approach& a : approaches) {
      OrderedJson json{{"approach", bounds_json(a.clearance)}, {"body", name_of(a.body)}};
      json[a.with_obstacle ? "obstacle" : "other"] = a.with_obstacle ? asked_.obstacles[a.other].id : name_of(a.other);
      json["time"] = a.nearest_time;
      json["place"] = json_point(a.place);
      put(json_line(json));
    }
    return;
  }
  std::vector<Approach> apart;
  for (const Approach& a : approaches)
    if (a.clearance.low > 0.0) apart.push_back(a);
  std::sort(apart.begin(), apart.end(),
            [](const Approach& a, const Approach& b) { return a.clearance.low < b.clearance.low; });
  for (std::size_t k = 0; k < std::min(apart.size(), kMostListed); ++k) {
    const Approach& a = apart[k];
    put(shown(fmt::format("near: {} and {}, {} apart at {} s, at {}", name_of(a.body),
                          other_of(a.with_obstacle, a.other), between_text(a.clearance.low, a.clearance.high),
                          seconds(a.nearest_time), place_text(a.place))) +
        "\n");
  }
  if (apart.size() > kMostListed)
    put(fmt::format("... and {} more that come nearer than {:.6g} m\n", apart.size() - kMostListed, asked_.near));
}

OrderedJson CheckAnswer::bodies_json() const {
  OrderedJson bodies = OrderedJson::array();
  for (std::size_t k = 0; k < asked_.survey.agents().size(); ++k) {
    const AgentSurvey& a = asked_.survey.agents()[k];
    bodies.push_back({{"id", name_of(k)},
                      {"rows", a.rows},
                      {"from", a.first},
                      {"to", a.last},
                      {"speed", extreme_json(a.speed)},
                      {"acceleration", extreme_json(a.acceleration)}});
  }
  return bodies;
}

OrderedJson CheckAnswer::summary_json(const geometry::MotionCheck& check, std::uint64_t missed) const {
  OrderedJson notes = OrderedJson::array();
  for (const std::string& note : asked_.file.notes) notes.push_back(note);
  OrderedJson whole{
      {"file", asked_.file.file},
      {"format", asked_.file.format},
      {"map", asked_.map.empty() ? OrderedJson() : OrderedJson(asked_.map)},
      {"between", asked_.has_curves ? "polynomials" : between_names()[static_cast<std::size_t>(asked_.between)]},
      {"footprint", asked_.bodies},
      {"rows", asked_.survey.rows()},
      {"repeated_rows", asked_.file.repeated},
      {"overlaps", check.overlaps},
      {"contacts", check.contacts},
      {"open", check.open},
      {"jumps", jumps_},
      {"jump_speed", number_or_null(asked_.jump_speed)},
      {"gaps", gaps_},
      {"near", asked_.near},
      {"approaches", check.approaches.size()},
      {"pieces", check.pieces},
      {"pairs", check.pairs},
      {"edge_pairs", check.edge_pairs},
      {"examined", check.examined},
      {"most_held", check.most_held},
      {"bodies", bodies_json()},
      {"notes", notes}};
  if (asked_.samples > 0) {
    whole["samples"] = asked_.samples;
    whole["missed"] = missed;
  }
  return whole;
}

/// The greatest value of a member over all agents.
void CheckAnswer::put_greatest(const char* what, Extreme AgentSurvey::*member, const char* unit) {
  const std::vector<AgentSurvey>& all = asked_.survey.agents();
  const auto most = std::max_element(all.begin(), all.end(), [&](const AgentSurvey& a, const AgentSurvey& b) {
    return (a.*member).value < (b.*member).value;
  });
  if (most == all.end() || (((*most).*member).line == 0 && ((*most).*member).value == 0.0)) return;
  const Extreme& e = (*most).*member;
  const std::string where = e.line > 0 ? fmt::format(", {} {}", asked_.file.row_word, e.line) : "";
  put(shown(fmt::format("greatest {}: {:.6g} {}, {} at {} s{}", what, e.value, unit,
                        name_of(static_cast<std::size_t>(most - all.begin())), seconds(e.time), where)) +
      "\n");
}

void CheckAnswer::put_counts(const geometry::MotionCheck& check, std::uint64_t missed) {
  if (asked_.samples > 0)
    put(fmt::format("{} of each move {} {} of {}\n", counted(asked_.samples, "sample"),
                    asked_.samples == 1 ? "misses" : "miss", missed, counted(check.overlaps, "overlap")));
  const std::string bound =
      std::isfinite(asked_.jump_speed) ? fmt::format(" (faster than {:.6g} m/s)", asked_.jump_speed) : "";
  const std::string open = check.open == 0 ? "" : fmt::format(", {} open", check.open);
  put(fmt::format("{}, {}{}, {}{}, {}\n", counted(check.overlaps, "overlap"), counted(check.contacts, "contact"), open,
                  counted(jumps_, "jump"), bound, counted(gaps_, "gap")));
}

void CheckAnswer::finish(const geometry::MotionCheck& check, std::uint64_t missed) {
  list_approaches(check.approaches);
  if (json_) {
    put(json_line({{"summary", summary_json(check, missed)}}));
    return print_waiting();
  }
  if (jumps_ > kMostListed) put(fmt::format("... and {} more jumps\n", jumps_ - kMostListed));
  if (gaps_ > kMostListed) put(fmt::format("... and {} more gaps\n", gaps_ - kMostListed));
  put_greatest("speed", &AgentSurvey::speed, "m/s");
  put_greatest("acceleration", &AgentSurvey::acceleration, "m/s^2");
  put_counts(check, missed);
  print_waiting();
}

}  // namespace exactvo::tools
