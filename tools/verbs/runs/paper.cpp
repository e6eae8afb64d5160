// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo paper: Section V of the paper from one command; on request the random fields and the ablations.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <thread>

#include "paper/campaign.h"
#include "paper/report.h"
#include "paper/section_five.h"
#include "support/files.h"
#include "support/parse_errors.h"
#include "support/run.h"
#include "support/simulation_flags.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

struct PaperFlags {
  std::string out;
  std::string data;
  std::uint64_t seed = datasets::kFieldSeed;
  std::uint64_t random = 0;
  bool ablations = false;
  std::uint64_t fields = 100;
  unsigned jobs = 0;
  bool json = false;
  bool no_figures = false;
  const CLI::Option* fields_given = nullptr;
  const CLI::Option* jobs_given = nullptr;
};

/// PREFIX/bin/exactvo -> PREFIX/share/exactvo/data.
fs::path installed_data() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path().parent_path() / EXACTVO_INSTALLED_DATA;
}

/// Where the paper's scenarios are: below --data; else in the installed folder beside the program; else in the sources
/// that it was built from. Throws UsageError where they are in none of them.
fs::path scenarios_for(const PaperFlags& flags) {
  std::vector<fs::path> places{flags.data};
  if (flags.data.empty()) places = {installed_data(), EXACTVO_SOURCE_DATA};
  for (const fs::path& place : places)
    if (fs::is_directory(place / "paper")) return place / "paper";
  throw UsageError("--data", places.back().string(), "a folder that holds a folder 'paper'");
}

void note_unused(const PaperFlags& flags) {
  if (flags.fields_given->count() > 0 && !flags.ablations)
    message("note: --fields does nothing here: it is of --ablations");
  if (flags.jobs_given->count() > 0 && !flags.ablations && flags.random == 0)
    message("note: --jobs does nothing here: it is of --random and --ablations");
}

/// The pictures of an earlier --ablations, put where the report in the making looks for them.
bool copy_pictures(const fs::path& from, const fs::path& to) {
  bool any = false;
  for (const char* name : {"ablations/options.png", "ablations/options_jitter.png"}) {
    if (!fs::exists(from / name)) continue;
    make_folder((to / name).parent_path());
    fs::copy_file(from / name, to / name);
    any = true;
  }
  return any;
}

/// What the report says of the campaigns changes with them.
void renew_report(const PaperFlags& flags) {
  const ReportData data(flags.out, flags.out, scenarios_for(flags));
  if (!data.has_runs()) return;
  write_report(data, flags.out);
  message("renewed " + flags.out + "/report.html and report.md");
}

ExitCode section_five(const PaperFlags& flags) {
  StagedFolder folder(flags.out);
  const SectionFiveOptions options{scenarios_for(flags), command_line(), flags.seed, flags.no_figures};
  const std::string summary = run_section_five(options, folder.path());
  if (interrupted()) throw Interrupted();
  // The campaigns' pictures, where an earlier command left some, are found beside those of this one.
  const bool campaigns_before = copy_pictures(flags.out, folder.path());
  const ReportData data(folder.path(), flags.out, options.scenarios);
  write_report(data, folder.path());
  if (campaigns_before) fs::remove_all(folder.path() / "ablations");
  if (flags.json) print(summary);
  for (const Claim& c : flags.json ? std::vector<Claim>{} : claims(data))
    print(fmt::format("{:<13} {}: {}\n", name(c.verdict), c.where, c.text));
  if (flags.no_figures) remove_figures(flags.out);
  folder.publish("summary.json");
  message("wrote " + flags.out + "/summary.json, report.html, report.md" +
          (flags.no_figures ? "" : ", explorer.html and figures/"));
  return ExitCode::success;
}

CampaignOptions campaign_options(const PaperFlags& flags, const char* folder, std::uint64_t fields) {
  const unsigned jobs = flags.jobs > 0 ? flags.jobs : std::max(1u, std::thread::hardware_concurrency());
  return {fs::path(flags.out) / folder / "parts", fields, flags.seed, jobs};
}

/// Each in a folder of its own that has the name of its files.
void publish(const CampaignFiles& files, const char* name, const PaperFlags& flags) {
  const fs::path folder = fs::path(flags.out) / name;
  write_campaign(files, folder, name);
  if (!flags.no_figures && !files.figures.empty()) draw(write_figures(files.figures, folder));
  print(flags.json ? files.json : files.table);
  message("wrote " + flags.out + "/" + name + "/");
}

ExitCode campaigns(const PaperFlags& flags) try {
  if (flags.random > 0) publish(random_fields(campaign_options(flags, "random", flags.random)), "random", flags);
  if (flags.ablations)
    publish(ablations(campaign_options(flags, "ablations", flags.fields), scenarios_for(flags)), "ablations", flags);
  renew_report(flags);
  return ExitCode::success;
} catch (const Interrupted&) {
  std::error_code error;
  error_message(fs::exists(flags.out, error)
                    ? "interrupted; what was finished is kept in " + flags.out + ": the same command goes on from there"
                    : std::string("interrupted; nothing was finished, so nothing is kept"));
  return ExitCode::interrupted;
}

ExitCode paper(const PaperFlags& flags) {
  check_output_folder(flags.out);
  note_unused(flags);
  ReportData(flags.out, flags.out, {});  // read before the work: a damaged file is reported at once
  return flags.random > 0 || flags.ablations ? campaigns(flags) : section_five(flags);
}

void declare_paper(CLI::App& app, PaperFlags& flags) {
  declare_out(app, flags.out,
              "Folder for summary.json, report.html, report.md, explorer.html and figures/; random/ or ablations/")
      ->required();
  app.add_option("--data", flags.data,
                 "Folder that contains paper/A1.json and so on; by default the one installed with the program");
  app.add_option(
         "--random", flags.random,
         "Instead of Section V: run this many random fields of each kind and count those each method crosses safely")
      ->check(whole_number(1, 1000000));
  app.add_flag("--ablations", flags.ablations,
               "Instead of Section V: the controller options added one by one, and the default less one at a time");
  flags.fields_given =
      app.add_option("--fields", flags.fields, "Random formations for each set of controller options of --ablations")
          ->capture_default_str()
          ->check(whole_number(1, 1000000));
  flags.jobs_given =
      app.add_option("--jobs,-j", flags.jobs,
                     "Threads for --random and --ablations, by default one per processor; results do not depend on it")
          ->check(whole_number(1, 1024));
  declare_seed(app, flags.seed, "Seed of the random fields; recorded in the provenance");
  app.add_flag("--json", flags.json, "Print the JSON instead of the verdicts and tables");
  app.add_flag("--no-figures", flags.no_figures, "Write no figures and no explorer.html");
}

}  // namespace

Verb paper_verb() {
  return {"paper", "Run the paper's experiments (Section V) and draw its figures; count random fields",
          "  exactvo paper --out out/paper\n"
          "  exactvo paper --out out/paper --random 1000 --jobs 2\n"
          "  exactvo paper --out out/paper --ablations\n",
          with_flags(declare_paper, paper)};
}

}  // namespace exactvo::tools
