// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles from files and into them; batches.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "exactvo/datasets/batch.h"
#include "exactvo/datasets/generators.h"
#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/datasets/obstacle_write.h"
#include "exactvo/datasets/repair.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

namespace fs = std::filesystem;
using namespace py::literals;
using datasets::ObstacleFile;

datasets::ReadOptions reading(const py::object& format, const std::string& units, const std::string& unknown,
                              py::handle cell_size, bool skip_invalid, bool repair) {
  datasets::ReadOptions options;
  if (!format.is_none()) {
    options.format = py::str(format);
    require_word(options.format, "format", datasets::readable_formats());
  }
  options.units = word<datasets::Units>(units, "units", datasets::unit_names(), &datasets::parse);
  options.unknown = word<datasets::UnknownCells>(unknown, "unknown", datasets::unknown_cells_names(), &datasets::parse);
  options.cell_size = at_least_zero(cell_size, "cell_size");
  options.keep_going = skip_invalid;
  options.repair = repair;
  options.keep_properties = true;
  return options;
}

py::tuple as_tuple(const datasets::RingFinding& f) {
  py::object in_file = py::none();
  if (f.in_file) in_file = py::make_tuple(python::as_tuple(f.in_file->where), f.in_file->is_degrees);
  return py::make_tuple(datasets::code_name(f.code), f.place, python::as_tuple(f.where), f.ring, f.vertex, f.repaired,
                        std::string(datasets::words_of(f)), in_file);
}

py::list notes_of(const ObstacleFile& file) {
  py::list notes;
  for (const datasets::DataNote& n : file.notes) notes.append((n.place.empty() ? "" : n.place + ": ") + n.text);
  return notes;
}

py::list properties_of(const ObstacleFile& file) {
  py::list result;
  for (const datasets::FeatureProperties& p : file.properties) result.append(p.members);
  return result;
}

py::dict as_dict(ObstacleFile file) {
  py::list rejected, findings;
  for (const datasets::DataError& e : file.rejected) rejected.append(python::as_tuple(e));
  for (const datasets::RingFinding& f : file.findings) findings.append(as_tuple(f));
  const datasets::ReadCounts& n = file.counts;
  const py::dict counts("read"_a = n.read, "done"_a = n.done, "repaired"_a = n.repaired,
                        "passed_over"_a = n.passed_over, "rejected"_a = n.rejected);
  py::object origin = py::none();
  if (file.origin) origin = py::make_tuple(file.origin->longitude, file.origin->latitude);
  const py::list properties = properties_of(file);
  // The context: what a write needs to know of where obstacles lie, and their properties.
  return py::dict("file"_a = file.file, "format"_a = file.format, "notes"_a = notes_of(file), "rejected"_a = rejected,
                  "findings"_a = findings, "counts"_a = counts, "origin"_a = origin, "properties"_a = properties,
                  "obstacles"_a = Obstacles{std::move(file.obstacles)},
                  "context"_a = datasets::WriteOptions{{}, std::move(file.plane), false, std::move(file.properties)});
}

py::dict read(const fs::path& path, const py::object& format, const std::string& units, const std::string& unknown,
              py::handle cell_size, bool skip_invalid, bool repair) {
  const datasets::ReadOptions options = reading(format, units, unknown, cell_size, skip_invalid, repair);
  ObstacleFile file = without_gil([&] { return datasets::read_obstacles(path, options); });
  return as_dict(std::move(file));
}

py::list write(const fs::path& path, const Obstacles& obstacles, const py::object& context, const py::object& format,
               bool metres) {
  datasets::WriteOptions options;
  if (!context.is_none()) {
    options = context.cast<datasets::WriteOptions>();
    if (options.properties.size() != obstacles.list.size()) options.properties.clear();
  }
  if (!format.is_none()) options.format = py::str(format);
  options.metres = metres;
  const std::vector<std::string> lost =
      without_gil([&] { return datasets::write_obstacles(path, obstacles.list, options); });
  return py::cast(lost);
}

py::dict as_dict(const datasets::RepairFacts& f) {
  return py::dict("polygons"_a = f.polygons, "rings"_a = f.rings, "vertices"_a = f.vertices, "area"_a = f.area);
}

py::tuple repair(const py::list& rings) {
  std::vector<geometry::Ring> given;
  for (const py::handle ring : rings) {
    const Doubles array = doubles(ring, "rings", {-1, 2});  // not `points`: a repair says what is not finite
    geometry::Ring r;
    for (py::ssize_t k = 0; k < array.shape(0); ++k) r.push_back({array.data()[2 * k], array.data()[2 * k + 1]});
    given.push_back(std::move(r));
  }
  if (given.empty()) throw ArgumentError("rings", "no ring", "at least one ring");
  const datasets::Repair done = without_gil([&] { return datasets::repair(given); });
  py::list polygons, problems;
  for (const geometry::Polygon& polygon : done.polygons) polygons.append(rings_of(polygon));
  for (const geometry::RingProblem& p : done.problems)
    problems.append(
        py::make_tuple(geometry::code_name(p.code), p.ring, p.vertex, python::as_tuple(p.where), p.repaired));
  return py::make_tuple(polygons, problems,
                        done.refused ? py::object(py::str(datasets::code_name(*done.refused))) : py::none(),
                        done.recombined, done.moved, as_dict(done.before), as_dict(done.after));
}

py::dict as_dict(const datasets::BatchTally& t) {
  return py::dict("read"_a = t.read, "done"_a = t.done, "repaired"_a = t.repaired, "rejected"_a = t.rejected);
}

py::tuple batch(const std::vector<fs::path>& paths, const fs::path& out, const std::vector<std::string>& write,
                int jobs, bool resume, bool repair, bool metres, const py::object& progress) {
  datasets::BatchConfiguration configuration;
  configuration.reading.repair = repair;
  configuration.geojson_in_metres = metres;
  configuration.geopackage = configuration.geojson = configuration.pictures = false;
  for (const std::string& name : write) {
    if (name == "geopackage")
      configuration.geopackage = true;
    else if (name == "geojson")
      configuration.geojson = true;
    else if (name == "pictures")
      configuration.pictures = true;
    else if (name != "measurements")
      throw ArgumentError("write", "\"" + name + "\"",
                          "some of \"measurements\", \"pictures\", \"geopackage\", \"geojson\"");
  }
  datasets::BatchRun run;
  run.paths = paths;
  run.out = out;
  run.workers = jobs;
  run.resume = resume;
  run.command_line = {"exactvo.datasets.batch"};
  const datasets::BatchResult result = [&] {
    const py::gil_scoped_release released;
    return run_batch(configuration, run, [&](const datasets::BatchProgress& p) {
      const py::gil_scoped_acquire held;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      return progress.is_none() || py::bool_(!progress(p.share_done).equal(py::bool_(false)));
    });
  }();
  return py::make_tuple(result.end == datasets::BatchEnd::complete, as_dict(result.summary.files),
                        as_dict(result.summary.obstacles), result.summary.obstacles_out, result.summary.certified,
                        result.summary.uncertified, result.summary.seconds);
}

Obstacles generate(const std::string& kind, std::uint64_t count, std::uint64_t seed) {
  require_word(kind, "kind", datasets::generator_kind_names());
  Obstacles result;
  const py::gil_scoped_release released;
  for (std::uint64_t k = 0; k < count; ++k)
    for (formation::SceneObstacle& obstacle : datasets::generated_item(kind, k, seed))
      result.list.push_back(std::move(obstacle));
  return result;
}

}  // namespace

void bind_obstacle_files(py::module_& module) {
  py::class_<datasets::WriteOptions>(module, "FileContext");
  module.def("read_obstacles", &read);
  module.def("parse_wkt", [](const std::string& text, bool repair) {
    datasets::ReadOptions options;
    options.repair = repair;
    return as_dict(datasets::parse_wkt(text, "<text>", options));
  });
  module.def("write_obstacles", &write);
  module.def("repair_rings", &repair);
  module.def("batch", &batch);
  module.def("generate", &generate);
  module.def("readable_formats", &datasets::readable_formats);
  module.def("writable_formats", &datasets::writable_formats);
}

}  // namespace exactvo::python
