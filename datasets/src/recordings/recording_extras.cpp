// SPDX-License-Identifier: GPL-3.0-or-later
#include "recordings/recording_extras.h"

#include <algorithm>

#include "recordings/recording_names.h"

namespace exactvo::datasets {
namespace {

using formation::BindingConstraint;
using formation::LyapunovRow;
using formation::StuckReport;

/// The numbers of a row under their names, for writing and for reading alike: `take(group, key, number)`.
template <class Row, class Take>
void for_each_term(Row& row, const Take& take) {
  take("paper", "kinetic", row.paper.kinetic);
  take("paper", "consensus", row.paper.consensus);
  take("paper", "pinning", row.paper.pinning);
  take("paper", "integral", row.paper.integral);
  take("paper_rates", "kinetic", row.paper_rates.kinetic);
  take("paper_rates", "consensus", row.paper_rates.consensus);
  take("paper_rates", "pinning", row.paper_rates.pinning);
  take("paper_rates", "integral", row.paper_rates.integral);
  take("paper_rates", "claimed", row.paper_rate);
  take("sound", "kinetic", row.sound.kinetic);
  take("sound", "consensus", row.sound.consensus);
  take("sound", "slots", row.sound.slots);
  take("sound_rates", "consensus", row.sound_rates.consensus);
  take("sound_rates", "tracking", row.sound_rates.tracking);
  take("sound_rates", "intervention", row.sound_rates.intervention);
  take("sound_rates", "bound", row.rate_bound);
}

/// The last row of a run has no decision, so no derivatives.
bool is_rate(const std::string& group) {
  return group == "paper_rates" || group == "sound_rates";
}

void append_binding(JsonWriter& json, const BindingConstraint& b) {
  json.begin_object().member("source", word_for(b.constraint.source)).member("index", b.constraint.index);
  json.member("piece", b.constraint.piece).member("normal", b.normal).member("clearance", b.clearance);
  json.member("radius_of_curvature", b.radius_of_curvature).member("pressing", b.pressing).end_object();
}

void append_equilibrium(JsonWriter& json, const formation::Equilibrium& e) {
  json.begin_object().member("position", e.position).member("normal", e.normal);
  json.member("radius_of_curvature", e.radius_of_curvature).member("distance", e.distance);
  json.member("stable", e.stable).end_object();
}

void append_report(JsonWriter& json, const StuckReport& r) {
  json.begin_object().member("robot", r.robot).member("position", r.position);
  json.member("goal_distance", r.goal_distance).member("speed", r.speed);
  json.list("binding", r.binding, [&](const BindingConstraint& b) { append_binding(json, b); });
  json.member("equilibrium", r.equilibrium, [&](const auto& e) { append_equilibrium(json, e); });
  json.member("text", r.text).member("rest_time", r.rest_time).end_object();
}

BindingConstraint to_binding(const JsonCursor& at) {
  BindingConstraint b;
  b.constraint.source = enumerator<formation::ConstraintSource>(at.at("source"));
  b.constraint.index = at.at("index").count();
  b.constraint.piece = at.at("piece").count();
  b.normal = at.at("normal").point();
  b.clearance = at.at("clearance").number();
  b.radius_of_curvature = at.at("radius_of_curvature").number();
  if (at.has("pressing")) b.pressing = at.at("pressing").truth();
  return b;
}

formation::Equilibrium to_equilibrium(const JsonCursor& at) {
  return {at.at("position").point(), at.at("normal").point(), at.at("radius_of_curvature").number(),
          at.at("distance").number(), at.at("stable").truth()};
}

StuckReport to_report(const JsonCursor& at) {
  StuckReport r;
  r.robot = at.at("robot").count();
  r.position = at.at("position").point();
  r.goal_distance = at.at("goal_distance").number();
  r.speed = at.at("speed").number();
  const JsonCursor binding = at.at("binding");
  for (std::size_t k = 0; k < binding.size(); ++k) r.binding.push_back(to_binding(binding.at(k)));
  if (!at.at("equilibrium").is_null()) r.equilibrium = to_equilibrium(at.at("equilibrium"));
  r.text = at.at("text").text();
  if (at.has("rest_time")) r.rest_time = at.at("rest_time").number();
  return r;
}

}  // namespace

void append_lyapunov(JsonWriter& json, const LyapunovRow& row) {
  std::string_view open;
  json.key("lyapunov").begin_object();
  for_each_term(row, [&](const char* group, const char* key, double number) {
    if (!row.has_rates && is_rate(group)) return;
    if (open != group) {
      if (!open.empty()) json.end_object();
      json.key(group).begin_object();
      open = group;
    }
    json.member(key, number);
  });
  json.end_object().end_object();
}

LyapunovRow to_lyapunov(const JsonCursor& at, double time) {
  LyapunovRow row;
  row.time = time;
  row.has_rates = at.has("paper_rates");
  for_each_term(row, [&](const char* group, const char* key, double& number) {
    if (row.has_rates || !is_rate(group)) number = at.at(group).at(key).number();
  });
  return row;
}

void append_collisions(JsonWriter& json, const std::vector<formation::Collision>& all) {
  json.key("collisions").begin_array();
  for (const formation::Collision& c : all) {
    json.begin_inline_object().member("robot", c.robot).member("kind", word_for(c.kind)).member("with", c.with);
    json.member("from", c.from).member("until", c.until).member("deepest_at", c.deepest_at).member("depth", c.depth);
    json.member("place", c.place).member("relaxed", c.relaxed).end_object();
  }
  json.end_array();
}

std::vector<formation::Collision> to_collisions(const JsonCursor& at) {
  std::vector<formation::Collision> all;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const JsonCursor c = at.at(k);
    all.push_back({c.at("robot").text(), enumerator<formation::CollisionKind>(c.at("kind")), c.at("with").text(),
                   c.at("from").number(), c.at("until").number(), c.at("deepest_at").number(), c.at("depth").number(),
                   c.at("place").point(), c.at("relaxed").truth()});
  }
  return all;
}

void append_stuck(JsonWriter& json, const RecordingFile& file) {
  json.list("stuck", file.stuck, [&](const StuckReport& report) { append_report(json, report); });
}

void read_stuck(const JsonCursor& at, RecordingFile& file) {
  for (std::size_t k = 0; k < at.size(); ++k) file.stuck.push_back(to_report(at.at(k)));
}

}  // namespace exactvo::datasets
