// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/ordered_work.h"
#include "exactvo/datasets/part_folder.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/controller_options.h"
#include "figures/outlines.h"
#include "paper/report_data.h"
#include "support/files.h"
#include "support/terminal.h"

namespace exactvo::tools {

using datasets::FieldKind;
using formation::Method;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// On a terminal's line, or in a message now and then.
void show(std::size_t done, std::size_t parts, const std::string& doing, ProgressLine& line) {
  if (!line.is_due()) return;
  line.show(static_cast<double>(done), doing);
  if (line.enabled()) return;
  message(fmt::format("{} of {} parts, about {:.0f} s left", done, parts,
                      line.elapsed() * static_cast<double>(parts - done) / static_cast<double>(done)));
}

// --- Runs and their counts ---

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
/// Fields a part: seconds of work, so that little is lost by a kill.
constexpr std::uint64_t kFieldsAPart = 10;

FieldResult result_of(const formation::Scenario& scenario, formation::SimulationOptions options, std::uint64_t field) {
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

/// A file name of a variant's name: "+ horizon clamp" has none of its own.
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
              text += csv_row(result_of(datasets::random_field(variant.kind, k, seed), variant.options, k));
            return text;
          }};
}

std::size_t count(const std::vector<FieldResult>& fields, bool (*holds)(const FieldResult&)) {
  return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), holds));
}

// --- Tables and figures ---

constexpr const char* kFormationScenes[] = {"B0", "B1", "B2", "B3"};

const VariantResult* find(const std::vector<VariantResult>& all, const std::string& kind, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const VariantResult& v) { return v.kind == kind && v.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::string random_table(const std::vector<VariantResult>& results, const CampaignOptions& options) {
  std::string text =
      fmt::format("Random fields 0-{}, seed {}: how many of {} are reached and safe (in brackets: reached)\n{:<12}",
                  options.fields - 1, options.seed, options.fields, "");
  const std::vector<std::string> methods = formation::method_names();
  for (const std::string& m : methods) text += fmt::format("{:>16}", m);
  text += "   latest arrival of ivo\n";
  for (const std::string& kind : datasets::field_kind_names()) {
    text += fmt::format("{:<12}", kind);
    for (const std::string& m : methods) {
      const VariantResult* v = find(results, kind, m);
      text += fmt::format("{:>16}", v ? fmt::format("{} ({})", v->good(), v->reached()) : "-");
    }
    text += fmt::format("   {:.2f} s\n", find(results, kind, "ivo")->latest_arrival());
  }
  return text + "Formations: controller default; ivo-cluster is the same as ivo there.\n";
}

/// One set of controller options in the formation scenes: a JSON list with one entry per run.
std::string scenes_of(const Variant& variant, const fs::path& scenarios) {
  Json list = Json::array();
  for (const char* scene : kFormationScenes) {
    formation::SimulationOptions options = variant.options;
    options.progress = [](double) { return !interrupted(); };
    const formation::Scenario scenario = datasets::load_scenario(scenarios / (std::string(scene) + ".json"));
    const formation::Metrics m = formation::measure(scenario, formation::simulate(scenario, options));
    const auto or_null = [](const std::optional<double>& x) { return x && std::isfinite(*x) ? Json(*x) : Json(); };
    list.push_back({{"scenario", scene},
                    {"formation_position_error", or_null(m.formation_position_error)},
                    {"min_obstacle_clearance", or_null(m.min_obstacle_clearance)},
                    {"min_robot_clearance", or_null(m.min_robot_clearance)},
                    {"jitter", or_null(m.jitter)},
                    {"peak_acceleration", or_null(m.peak_acceleration)},
                    {"velocity_variation", or_null(m.velocity_variation)},
                    {"heading_reversals", m.heading_reversals},
                    {"active_set_switches", m.active_set_switches}});
  }
  return list.dump();
}

std::vector<Json> run_scenes(const std::vector<Variant>& variants, const CampaignOptions& options,
                             const fs::path& scenarios) {
  std::string key = program_key();
  for (const char* scene : kFormationScenes)
    key += datasets::sha256_of_file(scenarios / (std::string(scene) + ".json"));
  std::vector<PartTask> tasks;
  for (std::size_t i = 0; i < variants.size(); ++i)
    tasks.push_back({fmt::format("scenes-{:02}", i), [&, i] { return scenes_of(variants[i], scenarios); }});
  std::vector<Json> rows;
  for (const std::string& text : run_parts(tasks, options.folder, key, options.jobs)) rows.push_back(Json::parse(text));
  return rows;
}

/// Whether a scene ended formed and nothing was touched.
bool formed_untouched(const Json& run) {
  const std::optional<double> error = value_of(run, "formation_position_error");
  return error && *error < formation::kFormed && !formation::touched(value_of(run, "min_obstacle_clearance")) &&
         !formation::touched(value_of(run, "min_robot_clearance"));
}

std::string ablation_table(const std::vector<VariantResult>& results, const std::vector<Json>& scenes,
                           const CampaignOptions& options) {
  std::string text = fmt::format(
      "Controller options over random formations 0-{}, seed {}, and jitter J [m/s^2] in B0-B3\n"
      "{:<22}{:>16}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}{:>14}\n",
      options.fields - 1, options.seed, "", "reached, safe", "reached", "safe", "J in B0", "B1", "B2", "B3",
      "median J");
  for (std::size_t i = 0; i < results.size(); ++i) {
    const VariantResult& v = results[i];
    if (i == formation::incremental_controller_options().size()) text += "\n";
    text += fmt::format("{:<22}{:>16}{:>9}{:>9}", v.name, v.good(), v.reached(), v.safe());
    for (const Json& run : scenes[i])
      text += fmt::format("{:>9}{}", shown(value_of(run, "jitter"), "{:.0f}"), formed_untouched(run) ? ' ' : '!');
    text += fmt::format("{:>14.0f}\n", v.median_jitter());
  }
  text += "!  not formed, or touched an obstacle or another robot\n";
  for (const VariantResult& v : results)
    if (v.without_jitter() > 0)
      text +=
          fmt::format("{}: J is not a number in {} fields, which the median leaves out\n", v.name, v.without_jitter());
  return text;
}

/// The name of a set of options as a label: mathematics set, all else as users write it after --ablation.
std::string drawn(const std::string& name) {
  static const std::regex horizon(R"(\btau\b)"), index("_([a-z]+)");
  return std::regex_replace(std::regex_replace(name, horizon, "τ"), index, "_{$1}");
}

/// Bars from the top down: options added one by one, then the ablations.
Figure counts_figure(const std::vector<VariantResult>& results, const CampaignOptions& options) {
  DataFile data;
  const int index = data.begin("reached and safe of " + std::to_string(options.fields), "place, count, name");
  const double n = static_cast<double>(results.size());
  for (std::size_t i = 0; i < results.size(); ++i)
    data.labelled_row({n - static_cast<double>(i), static_cast<double>(results[i].good())}, drawn(results[i].name));
  PlotCommand plot;
  plot.data(index, fmt::format("using (0.5*$2):1:(0.5*$2):(0.35):yticlabels(3) with boxxyerror fs solid 0.8 noborder "
                               "lc rgb '{}'",
                               series_colour(0)));
  plot.data(index, "using 2:1:2 with labels left offset 1.2,0 font ',10'");
  const std::string title =
      fmt::format("Reached and safe, of {} random formations (seed {})", options.fields, options.seed);
  const std::string body =
      filled("options",
             {{"title", quoted(title)},
              {"end", fmt::format("{}", 1.12 * static_cast<double>(options.fields))},
              {"top", fmt::format("{}", n + 0.7)},
              {"between",
               fmt::format("{}", n - static_cast<double>(formation::incremental_controller_options().size()) + 0.5)},
              {"plot", plot.text()}});
  return {"options", data.text(), title + ": options added one by one above, ablations below.", {960, 620}, body};
}

/// J in B1 and B3 for every set, logarithmic.
Figure jitter_figure(const std::vector<VariantResult>& results, const std::vector<Json>& scenes) {
  DataFile data;
  PlotCommand plot;
  const double n = static_cast<double>(results.size());
  for (std::size_t s = 0; s < 4; ++s) {
    const int index = data.begin(std::string("J in ") + kFormationScenes[s], "place, J [m/s^2], name");
    for (std::size_t i = 0; i < results.size(); ++i) {
      const Json& jitter = scenes[i][s]["jitter"];
      if (!jitter.is_null())
        data.labelled_row({n - static_cast<double>(i), jitter.get<double>()}, drawn(results[i].name));
    }
    plot.data(
        index,
        fmt::format("using 2:1:yticlabels(3) with points pt {} ps 1.3 lw 2 lc rgb '{}'", 4 + 2 * s, series_colour(s)),
        kFormationScenes[s]);
  }
  const std::string body = filled(
      "options_jitter",
      {{"title",
        markup("Jitter {/:Italic J} = Σ |{/:Italic a}_{k+1} − {/:Italic a}_k| with each set of controller options")},
       {"top", fmt::format("{}", n + 0.7)},
       {"plot", plot.text()}});
  return {"options_jitter", data.text(), "Jitter J with each set of controller options.", {960, 620}, body};
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

std::vector<Variant> option_variants() {
  std::vector<Variant> variants;
  for (const auto& list : {formation::incremental_controller_options(), formation::ablated_controller_options()}) {
    for (const formation::NamedControllerOptions& n : list) {
      formation::SimulationOptions options;
      options.controller_options = n.options;
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
  for (std::size_t i = 0; i < texts.size(); ++i) {
    std::stringstream in(texts[i]);
    for (std::string row; std::getline(in, row);) results[owner[i]].fields.push_back(from_csv_row(row));
  }
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

CampaignFiles random_fields(const CampaignOptions& options) {
  const std::vector<VariantResult> results = run_campaign(random_field_variants(), options);
  return {random_table(results, options),
          campaign_json("exactvo-random-fields", results, options),
          campaign_csv(results),
          {}};
}

CampaignFiles ablations(const CampaignOptions& options, const fs::path& scenarios) {
  const std::vector<Variant> variants = option_variants();
  const std::vector<Json> scenes = run_scenes(variants, options, scenarios);
  const std::vector<VariantResult> results = run_campaign(variants, options);
  Json tree = Json::parse(campaign_json("exactvo-ablations", results, options));
  for (std::size_t i = 0; i < variants.size(); ++i) {
    tree["rows"][i]["set"] = i < formation::incremental_controller_options().size() ? "incremental" : "ablation";
    tree["rows"][i]["scenes"] = scenes[i];
  }
  return {ablation_table(results, scenes, options),
          tree.dump(1) + "\n",
          campaign_csv(results),
          {counts_figure(results, options), jitter_figure(results, scenes)}};
}

void write_campaign(const CampaignFiles& files, const fs::path& folder, const std::string& stem) {
  datasets::write_file_atomically(folder / (stem + ".csv"), files.csv);
  datasets::write_file_atomically(folder / (stem + ".txt"), files.table);
  datasets::write_file_atomically(folder / (stem + ".json"), files.json);
}

std::vector<std::string> run_parts(const std::vector<PartTask>& tasks, const fs::path& path, const std::string& key,
                                   unsigned jobs) {
  const datasets::PartFolder folder(path);
  folder.create();
  const auto file_of = [&](std::size_t task) { return folder.path(tasks[task].name + ".part"); };
  std::vector<std::string> texts(tasks.size());
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::optional<std::string> text = folder.read_sealed(file_of(i), key);
    if (!text) open.push_back(i);
    texts[i] = std::move(text).value_or("");
  }
  if (!open.empty() && open.size() < tasks.size())
    message(fmt::format("{} of {} parts are there already", tasks.size() - open.size(), tasks.size()));
  ProgressLine line(static_cast<double>(open.size()), "parts");
  std::size_t next = 0;
  std::size_t done = 0;
  datasets::run_in_order(static_cast<int>(jobs), [&]() -> std::optional<datasets::OrderedTask> {
    if (interrupted() || next == open.size()) return std::nullopt;
    const std::size_t i = open[next++];
    const auto work = [&, i] {
      texts[i] = tasks[i].work();
      if (!interrupted()) folder.write_sealed(file_of(i), key, texts[i]);  // what was cut short is no part
    };
    return datasets::OrderedTask{work, [&, i] { show(++done, open.size(), tasks[i].name, line); }};
  });
  if (interrupted()) throw Interrupted();
  return texts;
}

std::string program_key() {
  const fs::path self = "/proc/self/exe";
  std::error_code error;
  if (fs::exists(self, error)) return datasets::sha256_of_file(self);
  const datasets::Provenance p = datasets::make_provenance({}, 0);
  return p.version + " " + p.commit + " " + p.compiler + " " + p.build_type;
}

}  // namespace exactvo::tools
