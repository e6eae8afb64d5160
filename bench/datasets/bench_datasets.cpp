// SPDX-License-Identifier: GPL-3.0-or-later
// How quick a batch is, and how much memory it takes.
//
//   bench_datasets [--stars N] [--sumo FILE] [--folder DIR] [--largest N] [--only-batches]
//
// In this order: whole batches of N generated obstacles with one and two workers, and two batches at once that share
// nothing (no two workers can be quicker than that); peak memory of batches of 10^4, 10^5, ... obstacles, each a
// process of its own; whole batches of a file of real polygons; the shapes of the generated ones in memory on one core,
// stage by stage; the naive exact way beside them, after their answers were compared; the same for the real polygons;
// where a batch spends its time.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "exactvo/datasets/batch.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/obstacle_shapes.h"
#include "exactvo/geometry/predicates.h"
#include "exactvo/geometry/validity.h"
#include "naive.h"
#include "options/program_options.h"
#include "stars.h"

namespace exactvo::bench {
namespace {

namespace fs = std::filesystem;
using datasets::BatchConfiguration;
using datasets::BatchResult;
using datasets::BatchRun;
using geometry::ObstacleShapes;
using geometry::Polygon;
using geometry::Vec2;

/// What this process has computed, all threads together, s: what else runs on the machine counts little.
double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Work>
double cpu_of(const Work& work) {
  const double start = cpu_seconds();
  work();
  return cpu_seconds() - start;
}

void need(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

std::size_t vertices_of(const std::vector<Polygon>& polygons) {
  std::size_t count = 0;
  for (const Polygon& p : polygons) count += geometry::vertices_of(geometry::Obstacle{p}).size();
  return count;
}

geometry::ShapeOptions batch_options() {
  geometry::ShapeOptions options = BatchConfiguration().shapes;
  options.check_validity = false;
  return options;
}

// --- One core, in memory ---

/// Shapes of all, every one certified; validity is checked as a reader does.
double seconds_for_shapes(const std::vector<Polygon>& polygons) {
  const geometry::ShapeOptions options = batch_options();
  return cpu_of([&] {
    for (const Polygon& polygon : polygons) {
      std::vector<geometry::Ring> rings{polygon.outer};
      rings.insert(rings.end(), polygon.holes.begin(), polygon.holes.end());
      need(geometry::normalize(rings).ok(), "an invalid obstacle");
      need(shapes_of(polygon, options).certified(), "an obstacle without certificate");
    }
  });
}

void show_rate(const char* what, const std::vector<Polygon>& polygons, double seconds) {
  const auto count = static_cast<double>(polygons.size());
  std::printf("%-44s %8.2f us each  %8.0f obstacles/s  %9.0f vertices/s\n", what, 1e6 * seconds / count,
              count / seconds, static_cast<double>(vertices_of(polygons)) / seconds);
}

/// The certification again: what shapes_of asks of what it has found.
void certify(const ObstacleShapes& s) {
  bool all = true;
  for (const Vec2 p : geometry::vertices_of(s.obstacle)) all = all && contains(s.hull, p);
  for (const Vec2 p : s.hull.vertices)
    all = all && contains(s.smallest_ellipse, p) && contains(*s.trap_free.ellipse, p);
  for (std::size_t k = 0; k < s.facade_ellipses.size(); ++k) {
    const geometry::Segment& facade = s.facades.facades[k];
    all = all && contains(s.facade_ellipses[k].ellipse, facade.a) && contains(s.facade_ellipses[k].ellipse, facade.b);
  }
  need(all && trap_free_for_every_goal(*s.trap_free.ellipse), "a certificate that does not hold");
}

void show_stages(const std::vector<Polygon>& polygons) {
  const geometry::ShapeOptions options = batch_options();
  std::vector<ObstacleShapes> shapes;
  for (const Polygon& p : polygons) shapes.push_back(shapes_of(p, options));
  const auto each = [&](const char* what, const auto& work) {
    const double seconds = cpu_of([&] {
      for (std::size_t k = 0; k < polygons.size(); ++k) work(polygons[k], shapes[k]);
    });
    std::printf("  %-42s %8.2f us\n", what, 1e6 * seconds / static_cast<double>(polygons.size()));
  };
  each("validity", [](const Polygon& p, const ObstacleShapes&) { geometry::normalize({p.outer}); });
  each("facades", [](const Polygon& p, const ObstacleShapes&) { divide_into_facades(p); });
  each("convex pieces, with their proof",
       [&](const Polygon& p, const ObstacleShapes&) { convex_pieces(p, options.partition); });
  each("hull (CGAL)", [](const Polygon& p, const ObstacleShapes&) { geometry::convex_hull(p.outer); });
  each("smallest ellipse, with its growth to certainty",
       [](const Polygon&, const ObstacleShapes& s) { geometry::fast_smallest_ellipse(s.hull.vertices); });
  each("facade ellipses, the same", [](const Polygon&, const ObstacleShapes& s) {
    for (const geometry::Segment& f : s.facades.facades) geometry::facade_ellipse(f);
  });
  each("certification of all, again", [](const Polygon&, const ObstacleShapes& s) { certify(s); });
}

// --- The naive way ---

/// The same hulls as sets of vertices, areas that agree to what ours may be larger, facade ellipses that contain.
void compare_answers(const Polygon& polygon) {
  const ObstacleShapes ours = shapes_of(polygon, batch_options());
  const NaiveShapes theirs = naive_shapes(polygon);
  need(ours.hull.vertices == theirs.hull, "hulls differ");
  constexpr double kApart = 1e-8;  // ours is within 1e-10 of the least, theirs is rounded from numbers of many digits
  need(std::fabs(ours.measurements.ellipse_area / theirs.ellipse_area - 1.0) < kApart, "smallest ellipses differ");
  need(theirs.facade_ellipses_contain && ours.certified(), "a facade ellipse that does not contain");
  need(theirs.pieces >= 1, "no piece");
}

void show_naive(const std::vector<Polygon>& polygons) {
  constexpr std::size_t kSample = 300;
  constexpr int kRounds = 3;
  const std::vector<Polygon> sample(polygons.begin(), polygons.begin() + std::min(kSample, polygons.size()));
  for (const Polygon& p : sample) compare_answers(p);
  double ours = 1e300;
  double theirs = 1e300;
  for (int round = 0; round < kRounds; ++round) {
    ours = std::min(ours, seconds_for_shapes(sample));
    theirs = std::min(theirs, cpu_of([&] {
                        for (const Polygon& p : sample) need(naive_shapes(p).pieces > 0, "no piece");
                      }));
  }
  show_rate("of these, the first 300", sample, ours);
  show_rate("the naive exact way on them", sample, theirs);
  std::printf("%-44s %8.0f times as long\n", "naive / ours (to reach: 50)", theirs / ours);
}

// --- Whole batches ---

BatchConfiguration configuration_of(bool everything) {
  BatchConfiguration configuration;
  configuration.geopackage = configuration.geojson = configuration.pictures = everything;
  return configuration;
}

BatchResult batch(const fs::path& input, const fs::path& out, int workers, bool everything) {
  BatchRun run;
  run.paths = {input};
  run.out = out;
  run.workers = workers;
  fs::remove_all(out);
  return run_batch(configuration_of(everything), run);
}

/// Runs it in a process of its own; `finish` waits for it, throws where it failed and gives what it used.
class Child {
 public:
  template <class Work>
  explicit Child(const Work& work) : id_(::fork()) {
    if (id_ != 0) return;
    int status = 1;
    try {
      status = work() ? 0 : 1;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
    }
    ::_exit(status);
  }

  rusage finish() const {
    int status = 0;
    rusage usage{};
    ::wait4(id_, &status, 0, &usage);
    need(WIFEXITED(status) && WEXITSTATUS(status) == 0, "a batch failed");
    return usage;
  }

 private:
  pid_t id_;
};

bool is_certified_batch(const fs::path& input, const fs::path& out, int workers, bool everything) {
  return batch(input, out, workers, everything).summary.uncertified == 0;
}

template <class Work>
double wall_of(const Work& work) {
  const double start = wall_seconds();
  work();
  return wall_seconds() - start;
}

/// The same batch twice at once, in processes of their own with a worker each, that share nothing but the machine: what
/// its two cores give at most.
double seconds_of_two_apart(const fs::path& input, const fs::path& folder, bool everything) {
  return wall_of([&] {
    const Child one([&] { return is_certified_batch(input, folder / "one", 1, everything); });
    const Child two([&] { return is_certified_batch(input, folder / "two", 1, everything); });
    one.finish();
    two.finish();
  });
}

/// The quickest of some rounds, s.
struct BatchSeconds {
  double one_worker = 1e300;
  double two_workers = 1e300;
  double two_apart = 1e300;
};

BatchSeconds measure_batches(const fs::path& input, const fs::path& folder, bool everything, int rounds) {
  // In processes of their own, as the program is, and forked before this one has done anything: a page of memory that
  // a child finds used is copied when it is written to.
  const auto seconds_with = [&](int workers) {
    return wall_of(
        [&] { Child([&] { return is_certified_batch(input, folder / "out", workers, everything); }).finish(); });
  };
  BatchSeconds least;
  for (int round = 0; round < rounds; ++round) {
    least.one_worker = std::min(least.one_worker, seconds_with(1));
    least.two_workers = std::min(least.two_workers, seconds_with(2));
    least.two_apart = std::min(least.two_apart, seconds_of_two_apart(input, folder, everything));
  }
  return least;
}

void show_batches(const fs::path& input, const fs::path& folder, std::size_t obstacles, const std::string& what) {
  const auto count = static_cast<double>(obstacles);
  std::printf("whole batches of %zu %s, by the clock:\n", obstacles, what.c_str());
  for (const bool everything : {false, true}) {
    const int rounds = everything ? 1 : 5;
    const BatchSeconds s = measure_batches(input, folder, everything, rounds);
    const double gain = s.one_worker / s.two_workers;
    const double ceiling = 2.0 * s.one_worker / s.two_apart;
    const auto show = [&](const char* who, double seconds, double of_it, double times) {
      std::printf("    %-44s %7.2f s  %8.0f obstacles/s  x%.2f\n", who, seconds, of_it / seconds, times);
    };
    std::printf("  %s, the quickest of %d:\n",
                everything ? "GeoPackage, GeoJSON, pictures, measurements" : "measurements alone", rounds);
    show("one worker", s.one_worker, count, 1.0);
    show("two workers", s.two_workers, count, gain);
    show("two batches at once, nothing shared", s.two_apart, 2.0 * count, ceiling);
    std::printf("    two workers of what the machine gives two processes: %.0f %%\n", 100.0 * gain / ceiling);
    std::fflush(stdout);
  }
}

/// Seconds of the stages of a batch with one worker: reading alone, reading and decomposing, everything.
void show_shares(const fs::path& input, const fs::path& folder) {
  datasets::ReadOptions options;
  options.keep_going = true;
  const double reading = cpu_of([&] {
    read_obstacles(input, options,
                   {[](const formation::SceneObstacle&, bool) {}, [](const datasets::DataError&) {}, {}});
  });
  const std::vector<Polygon> polygons = [&] {
    std::vector<Polygon> all;
    read_obstacles(input, options,
                   {[&](const formation::SceneObstacle& o, bool) { all.push_back(std::get<Polygon>(o.shape)); },
                    [](const datasets::DataError&) {},
                    {}});
    return all;
  }();
  const geometry::ShapeOptions shape_options = batch_options();
  std::vector<ObstacleShapes> shapes;
  const double decomposing = cpu_of([&] {
    for (const Polygon& p : polygons) need(shapes_of(p, shape_options).certified(), "no certificate");
  });
  const double hulls = cpu_of([&] {
    for (const Polygon& p : polygons) geometry::convex_hull(p.outer);
  });
  for (const Polygon& p : polygons) shapes.push_back(shapes_of(p, shape_options));
  const double certifying = cpu_of([&] {
    for (const ObstacleShapes& s : shapes) certify(s);
  });
  const double all = cpu_of([&] { batch(input, folder / "out", 1, false); });
  const double share = 100.0 / all;
  std::printf(
      "  shares of %.2f s with measurements alone: reading and validity %.0f %%, shapes %.0f %% (of it CGAL %.0f %%, "
      "certifying %.0f %%), writing %.0f %%\n",
      all, share * reading, share * decomposing, share * hulls, share * certifying,
      share * (all - reading - decomposing));
}

// --- Memory ---

/// kB at most in a process that runs one batch.
long peak_memory(const fs::path& input, const fs::path& out) {
  return Child([&] { return is_certified_batch(input, out, 1, false); }).finish().ru_maxrss;
}

void show_memory(const fs::path& folder, std::size_t largest) {
  std::printf("peak memory of a batch from WKT, one worker, measurements:\n");
  for (std::size_t count = 10000; count <= largest; count *= 10) {
    const fs::path input = folder / "many.wkt";
    write_stars(input, count);
    const auto size = static_cast<double>(fs::file_size(input));
    std::printf("  %8zu obstacles, a file of %6.1f MB: %6.1f MB\n", count, 1e-6 * size,
                1.024e-3 * static_cast<double>(peak_memory(input, folder / "out")));
    std::fflush(stdout);
    fs::remove(input);
    fs::remove_all(folder / "out");
  }
}

struct Flags {
  std::size_t stars = 100000;
  std::size_t largest = 1000000;
  std::string sumo = EXACTVO_SOURCE_DIR "/../shared/data/sumo-poly/erlangen.poly.xml";
  std::string folder;
  bool only_batches = false;
};

std::vector<Polygon> real_polygons(const std::string& path) {
  datasets::ReadOptions options;
  options.keep_going = true;
  std::vector<Polygon> polygons;
  for (const formation::SceneObstacle& o : datasets::read_obstacles(path, options).obstacles) {
    if (const auto* polygon = std::get_if<Polygon>(&o.shape)) polygons.push_back(*polygon);
  }
  return polygons;
}

void show_the_rest(const Flags& flags, const fs::path& folder, const fs::path& input) {
  const std::vector<Polygon> generated = stars(flags.stars);
  std::printf("%zu generated obstacles of 3 to 16 corners, one core (to reach: 20000 a second):\n", generated.size());
  show_rate("validity, shapes, all certified", generated, seconds_for_shapes(generated));
  show_stages(generated);
  show_naive(generated);
  if (fs::exists(flags.sumo)) {
    const std::vector<Polygon> real = real_polygons(flags.sumo);
    std::printf("%zu real polygons of %s, one core:\n", real.size(), flags.sumo.c_str());
    show_rate("validity, shapes, all certified", real, seconds_for_shapes(real));
  } else {
    std::printf("no real polygons measured: there is no %s (--sumo FILE)\n", flags.sumo.c_str());
  }
  std::printf("where a whole batch spends its time:\n");
  show_shares(input, folder);
}

void run(const Flags& flags) {
  std::string name = flags.folder;
  if (name.empty()) {
    name = (fs::temp_directory_path() / "exactvo_bench_XXXXXX").string();
    need(::mkdtemp(name.data()) != nullptr, "no folder to work in");
  }
  const fs::path folder = name;
  fs::create_directories(folder);
  std::printf("%s\n", to_json(datasets::make_provenance({}, 0)).c_str());
  const fs::path input = folder / "stars.wkt";
  Child([&] { return write_stars(input, flags.stars), true; }).finish();
  show_batches(input, folder, flags.stars, "generated obstacles");
  // Before this process takes memory, which its children would have as well.
  if (!flags.only_batches) show_memory(folder, flags.largest);
  if (fs::exists(flags.sumo)) {
    const std::vector<Polygon> real = real_polygons(flags.sumo);
    show_batches(flags.sumo, folder, real.size(), "polygons of " + flags.sumo);
  }
  if (!flags.only_batches) show_the_rest(flags, folder, input);
  if (flags.folder.empty()) fs::remove_all(folder);
}

}  // namespace
}  // namespace exactvo::bench

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("bench_datasets", [&] {
    bench::Flags flags;
    tools::ProgramOptions options("bench_datasets", "How fast a batch is, and how much memory it takes.");
    options.whole_number("--stars", flags.stars, 1, "Generated obstacles");
    options.whole_number("--largest", flags.largest, 1, "Obstacles of the largest batch whose memory is measured");
    options.text("--sumo", flags.sumo, "A file of real polygons");
    options.flag("--only-batches", flags.only_batches, "Whole batches only, by the clock");
    options.text("--folder", flags.folder, "To work in; a temporary one unless given");
    if (options.parse(argc, argv)) bench::run(flags);
    return 0;
  });
}
