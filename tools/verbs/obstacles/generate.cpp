// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo generate: obstacles by seed, the same on every machine.
#include <fmt/format.h>

#include <optional>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/generators.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/geometry/counted.h"
#include "figures/figure.h"
#include "figures/plane.h"
#include "support/simulation_flags.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

using formation::SceneObstacle;

namespace {

struct GenerateFlags {
  std::string kind;
  std::uint64_t seed = 1;
  std::int64_t count = 100;
  std::string out, to, figure;
  bool list = false;
  bool metres = false;
};

constexpr std::uint64_t kMostItemsDrawn = 400;
constexpr const char* kOutHelp =
    "The file to write; its extension selects the format. - is stdout (wkt, or the format of --to)";

std::string kind_help() {
  return fmt::format("One of {}", fmt::join(datasets::generator_kind_names(), " "));
}

ExitCode list_kinds() {
  std::string text;
  for (const datasets::GeneratorKind& kind : datasets::generator_kinds())
    text += fmt::format("{:16} {}\n", kind.name, kind.what);
  print(text);
  return ExitCode::success;
}

void check(const GenerateFlags& flags) {
  if (flags.kind.empty()) throw missing_option("generate", "argument kind", kind_help());
  require_known("kind", flags.kind, datasets::generator_kind_names());
  if (flags.out.empty()) throw missing_option("generate", "option --out", kOutHelp);
  constexpr std::int64_t kMostItems = 100'000'000;
  if (flags.count < 1 || flags.count > kMostItems)
    throw UsageError("--count", std::to_string(flags.count), "a whole number from 1 to 100000000");
  check_format("--to", flags.to, datasets::writable_formats());
  check_figure_name("--figure", flags.figure, {flags.out});
}

std::vector<SceneObstacle> item(const GenerateFlags& flags, std::uint64_t k) {
  if (interrupted()) throw Interrupted();
  return datasets::generated_item(flags.kind, k, flags.seed);
}

std::vector<SceneObstacle> items(const GenerateFlags& flags, std::uint64_t count) {
  std::vector<SceneObstacle> all;
  for (std::uint64_t k = 0; k < count; ++k) {
    for (SceneObstacle& obstacle : item(flags, k)) all.push_back(std::move(obstacle));
  }
  return all;
}

/// A line at a time: memory does not grow with the count.
std::size_t stream_wkt(const GenerateFlags& flags, std::uint64_t count) {
  std::optional<datasets::AtomicFile> file;
  if (flags.out != "-") file.emplace(flags.out);
  std::size_t written = 0;
  for (std::uint64_t k = 0; k < count; ++k) {
    const std::vector<SceneObstacle> obstacles = item(flags, k);
    file ? file->write(datasets::to_wkt(obstacles)) : print(datasets::to_wkt(obstacles));
    written += obstacles.size();
  }
  if (file) file->commit();
  return written;
}

std::size_t write(const GenerateFlags& flags, std::uint64_t count) {
  const std::string to = output_format(flags.out, flags.to);
  if (to == "wkt") return stream_wkt(flags, count);
  const std::vector<SceneObstacle> all = items(flags, count);
  write_or_print(flags.out, all, {to, {}, flags.metres, {}});
  return all.size();
}

void draw_figure(const GenerateFlags& flags, std::uint64_t count) {
  const std::uint64_t drawn = std::min(count, kMostItemsDrawn);
  if (drawn < count) message(fmt::format("the figure shows the first {} of {} items", drawn, count));
  const std::string title = fmt::format("{}, seed {}, {}", flags.kind, flags.seed, geometry::counted(drawn, "item"));
  MapLayers map;
  map.obstacles(items(flags, drawn));
  write_figure(map.figure(title), flags.figure);
}

ExitCode generate(const GenerateFlags& flags) {
  if (flags.list) return list_kinds();
  check(flags);
  const auto count = static_cast<std::uint64_t>(flags.count);
  const std::size_t written = write(flags, count);
  message(fmt::format("wrote {}: {} of {}, {}, seed {}", flags.out, geometry::counted(written, "obstacle"),
                      geometry::counted(count, "item"), flags.kind, flags.seed));
  if (!flags.figure.empty()) draw_figure(flags, count);
  return ExitCode::success;
}

void declare_generate(CLI::App& app, GenerateFlags& flags) {
  app.add_option("kind", flags.kind, kind_help());
  declare_seed(app, flags.seed, "Seed of the generator; the same seed gives the same bytes on every machine");
  app.add_option("--count", flags.count, "Number of items; one maze, block or field consists of several obstacles");
  app.add_option("--out", flags.out, kOutHelp);
  app.add_option("--to", flags.to, "The format of --out, if its extension does not determine it");
  declare_metres(app, flags.metres);
  app.add_option("--figure", flags.figure, std::string("The first 400 items. ") + kFigureFileHelp);
  app.add_flag("--list", flags.list, "Print the kinds");
}

}  // namespace

Verb generate_verb() {
  return {"generate", "Generate obstacles from a seed: polygons, stars, walls, mazes, blocks, floors, needles, fields",
          "  exactvo generate --list\n"
          "  exactvo generate maze --seed 7 --count 4 --out mazes.geojson --figure mazes.svg\n",
          with_flags(declare_generate, generate)};
}

}  // namespace exactvo::tools
