// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "exactvo/datasets/provenance.h"
#include "exactvo/formation/remedies.h"
#include "paper/parts.h"
#include "support/terminal.h"

namespace exactvo::tools {

using datasets::FieldKind;
using formation::Method;

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Fields a part: seconds of work, so that little is lost by a kill.
constexpr std::uint64_t kFieldsAPart = 10;

FieldResult judged(const formation::Scenario& scenario, formation::SimulationOptions options, std::uint64_t field) {
  options.progress = [](double) { return !interrupted(); };
  const formation::Recording recording = formation::simulate(scenario, options);
  if (interrupted()) return {};
  const formation::Metrics m = formation::measure(scenario, recording);
  return {field,
          m.all_arrived,
          formation::is_safe(m),
          m.last_arrival_time.value_or(kNone),
          m.min_obstacle_clearance.value_or(kNone),
          m.min_robot_clearance.value_or(kNone),
          m.uncertified_half_planes,
          m.formation_position_error.value_or(kNone),
          m.jitter};
}

/// Shortest digits that read back to the same double; nothing for what does not apply.
std::string number(double x) {
  return std::isnan(x) ? "" : fmt::format("{}", x);
}
double number_of(const std::string& text) {
  return text.empty() ? kNone : std::stod(text);
}

std::string csv_row(const FieldResult& r) {
  return fmt::format("{},{:d},{:d},{},{},{},{},{},{}\n", r.field, r.reached, r.safe, number(r.last_arrival),
                     number(r.obstacle_clearance), number(r.robot_clearance), r.uncertified, number(r.formation_error),
                     r.jitter);  // always applies: where it is no number, "nan"
}

FieldResult from_csv_row(const std::string& row) {
  std::vector<std::string> cells;
  std::stringstream in(row);
  for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
  return {std::stoull(cells.at(0)), cells.at(1) == "1",     cells.at(2) == "1",
          number_of(cells.at(3)),   number_of(cells.at(4)), number_of(cells.at(5)),
          std::stoull(cells.at(6)), number_of(cells.at(7)), number_of(cells.at(8))};
}

/// A file name of a variant's name: "+ tau clamp" has none of its own.
std::string file_word(const std::string& name) {
  std::string word;
  for (const char c : name) word += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '-';
  return word;
}

PartTask part_of(const Variant& variant, std::uint64_t first, std::uint64_t end, std::uint64_t seed) {
  const std::string name =
      fmt::format("{}-{}-{}-{:06}-{:06}", datasets::name(variant.kind), file_word(variant.name), seed, first, end - 1);
  return {name, [&variant, first, end, seed] {
            std::string text;
            for (std::uint64_t k = first; k < end && !interrupted(); ++k)
              text += csv_row(judged(datasets::random_field(variant.kind, k, seed), variant.options, k));
            return text;
          }};
}

void append_fields(const std::string& text, std::vector<FieldResult>& fields) {
  std::stringstream in(text);
  for (std::string row; std::getline(in, row);) fields.push_back(from_csv_row(row));
}

std::size_t count(const std::vector<FieldResult>& fields, bool (*holds)(const FieldResult&)) {
  return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), holds));
}

}  // namespace

std::vector<Variant> random_field_variants() {
  std::vector<Variant> variants;
  const auto add = [&variants](FieldKind kind, Method method) {
    formation::SimulationOptions options;
    options.method = method;
    variants.push_back({kind, formation::name(method), options});
  };
  for (const FieldKind kind : {FieldKind::convex, FieldKind::open})
    for (const Method method : {Method::orca, Method::ivo_edge, Method::ivo_cluster, Method::ivo}) add(kind, method);
  for (const Method method : {Method::orca, Method::ivo_edge, Method::ivo}) add(FieldKind::formation, method);
  return variants;
}

std::vector<Variant> remedy_variants() {
  std::vector<Variant> variants;
  for (const auto& list : {formation::remedy_ladder(), formation::remedy_ablations()}) {
    for (const formation::NamedRemedies& n : list) {
      formation::SimulationOptions options;
      options.remedies = n.remedies;
      variants.push_back({FieldKind::formation, n.name, options});
    }
  }
  return variants;
}

std::size_t VariantResult::good() const {
  return count(fields, [](const FieldResult& r) { return r.good(); });
}
std::size_t VariantResult::reached() const {
  return count(fields, [](const FieldResult& r) { return r.reached; });
}
std::size_t VariantResult::safe() const {
  return count(fields, [](const FieldResult& r) { return r.safe; });
}

double VariantResult::latest_arrival() const {
  double latest = kNone;
  for (const FieldResult& r : fields)
    if (r.good() && !(r.last_arrival <= latest)) latest = r.last_arrival;
  return latest;
}

double VariantResult::median_jitter() const {
  std::vector<double> all;
  for (const FieldResult& r : fields)
    if (!std::isnan(r.jitter)) all.push_back(r.jitter);
  if (all.empty()) return kNone;
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

std::size_t VariantResult::without_jitter() const {
  return count(fields, [](const FieldResult& r) { return std::isnan(r.jitter); });
}

std::vector<VariantResult> run_campaign(const std::vector<Variant>& variants, const CampaignOptions& options) {
  std::vector<PartTask> tasks;
  std::vector<std::size_t> owner;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    for (std::uint64_t first = 0; first < options.fields; first += kFieldsAPart) {
      tasks.push_back(part_of(variants[v], first, std::min(first + kFieldsAPart, options.fields), options.seed));
      owner.push_back(v);
    }
  }
  const std::vector<std::string> texts = run_parts(tasks, options.folder, program_key(), options.jobs);
  std::vector<VariantResult> results;
  for (const Variant& v : variants) results.push_back({datasets::name(v.kind), v.name, {}});
  for (std::size_t i = 0; i < texts.size(); ++i) append_fields(texts[i], results[owner[i]].fields);
  return results;
}

std::string campaign_csv(const std::vector<VariantResult>& results) {
  std::string text =
      "kind,variant,field,reached,safe,last_arrival_s,obstacle_clearance_m,robot_clearance_m,uncertified,"
      "formation_error_m,jitter_m_s2\n";
  for (const VariantResult& v : results)
    for (const FieldResult& r : v.fields) text += v.kind + "," + v.name + "," + csv_row(r);
  return text;
}

std::string campaign_json(const std::string& what, const std::vector<VariantResult>& results,
                          const CampaignOptions& options) {
  using Json = nlohmann::ordered_json;
  const datasets::Provenance p = datasets::make_provenance({}, options.seed);
  Json rows = Json::array();
  for (const VariantResult& v : results) {
    Json failed = Json::array();
    for (const FieldResult& r : v.fields)
      if (!r.good()) failed.push_back(r.field);
    Json row{{"kind", v.kind}, {"variant", v.name}, {"fields", v.fields.size()}, {"reached_and_safe", v.good()}};
    row["reached"] = v.reached();
    row["safe"] = v.safe();
    row["latest_arrival"] = std::isnan(v.latest_arrival()) ? Json() : Json(v.latest_arrival());
    row["median_jitter"] = std::isnan(v.median_jitter()) ? Json() : Json(v.median_jitter());
    row["without_jitter"] = v.without_jitter();
    row["not_reached_and_safe"] = failed;
    rows.push_back(row);
  }
  const Json tree{{"kind", what},
                  {"seed", options.seed},
                  {"first_field", 0},
                  {"fields", options.fields},
                  {"program", {{"version", p.version}, {"commit", p.commit}, {"compiler", p.compiler}}},
                  {"rows", rows}};
  return tree.dump(1) + "\n";
}

}  // namespace exactvo::tools
