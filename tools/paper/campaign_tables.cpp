// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/campaign_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <regex>
#include <utility>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/remedies.h"
#include "figures/style.h"
#include "paper/parts.h"
#include "paper/report_data.h"
#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

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

/// One set of remedies in the formation scenes: a JSON list, a run an entry.
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

std::string jitter_cell(const Json& run) {
  return run["jitter"].is_null() ? "-" : fmt::format("{:.0f}", run["jitter"].get<double>());
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
      "Remedies over random formations 0-{}, seed {}, and jitter J [m/s^2] in B0-B3\n"
      "{:<22}{:>16}{:>9}{:>9}{:>10}{:>10}{:>10}{:>10}{:>14}\n",
      options.fields - 1, options.seed, "", "reached, safe", "reached", "safe", "J in B0", "B1", "B2", "B3",
      "median J");
  for (std::size_t i = 0; i < results.size(); ++i) {
    const VariantResult& v = results[i];
    if (i == formation::remedy_ladder().size()) text += "\n";
    text += fmt::format("{:<22}{:>16}{:>9}{:>9}", v.name, v.good(), v.reached(), v.safe());
    for (const Json& run : scenes[i])
      text += fmt::format("{:>9}{}", jitter_cell(run), formed_untouched(run) ? ' ' : '!');
    text += fmt::format("{:>14.0f}\n", v.median_jitter());
  }
  text += "!  not formed, or touched an obstacle or another robot\n";
  for (const VariantResult& v : results)
    if (v.without_jitter() > 0)
      text +=
          fmt::format("{}: J is not a number in {} fields, which the median leaves out\n", v.name, v.without_jitter());
  return text;
}

/// The name of a set of options as a label: mathematics set, all else as users write it after --remedies.
std::string drawn(const std::string& name) {
  static const std::regex horizon(R"(\btau\b)"), index("_([a-z]+)");
  return std::regex_replace(std::regex_replace(name, horizon, "τ"), index, "_{$1}");
}

/// Bars from the top down: the ladder, then the ablations.
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
  const std::string body = filled(
      "remedies", {{"title", quoted(title)},
                   {"end", fmt::format("{}", 1.12 * static_cast<double>(options.fields))},
                   {"top", fmt::format("{}", n + 0.7)},
                   {"between", fmt::format("{}", n - static_cast<double>(formation::remedy_ladder().size()) + 0.5)},
                   {"plot", plot.text()}});
  return {"remedies", data.text(), title + ": options added one by one above, ablations below.", {960, 620}, body};
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
      "remedies_jitter",
      {{"title",
        markup("Jitter {/:Italic J} = Σ |{/:Italic a}_{k+1} − {/:Italic a}_k| with each set of controller options")},
       {"top", fmt::format("{}", n + 0.7)},
       {"plot", plot.text()}});
  return {"remedies_jitter", data.text(), "Jitter J with each set of controller options.", {960, 620}, body};
}

}  // namespace

CampaignFiles random_fields(const CampaignOptions& options) {
  const std::vector<VariantResult> results = run_campaign(random_field_variants(), options);
  return {random_table(results, options),
          campaign_json("exactvo-random-fields", results, options),
          campaign_csv(results),
          {}};
}

CampaignFiles ablations(const CampaignOptions& options, const fs::path& scenarios) {
  const std::vector<Variant> variants = remedy_variants();
  const std::vector<Json> scenes = run_scenes(variants, options, scenarios);
  const std::vector<VariantResult> results = run_campaign(variants, options);
  Json tree = Json::parse(campaign_json("exactvo-ablations", results, options));
  for (std::size_t i = 0; i < variants.size(); ++i) {
    tree["rows"][i]["set"] = i < formation::remedy_ladder().size() ? "ladder" : "ablation";
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

void draw_campaign(const CampaignFiles& files, const fs::path& folder) {
  draw(write_figures(files.figures, folder));
}

}  // namespace exactvo::tools
