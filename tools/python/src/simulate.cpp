// SPDX-License-Identifier: GPL-3.0-or-later
// Scenarios run, and what happened as arrays: steps x robots.
#include <pybind11/stl.h>

#include <memory>
#include <set>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/audit.h"
#include "exactvo/datasets/metrics_file.h"
#include "exactvo/datasets/recording_file.h"
#include "exactvo/datasets/scenario_file.h"
#include "exactvo/formation/notices.h"
#include "exactvo/formation/simulation.h"
#include "explorer/page.h"
#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

namespace fs = std::filesystem;

using datasets::LoadedScenario;
/// Releases the lock of the interpreter round a function that touches no Python object.
using WithoutGil = py::call_guard<py::gil_scoped_release>;

/// A run with its columns: [step][robot][xy].
struct Run {
  datasets::RecordingFile file;
  formation::Metrics metrics;
  std::vector<double> time, position, velocity, preferred, chosen;
  std::vector<std::uint8_t> status, mode;
  std::size_t robots() const { return file.scenario.robots.size(); }
};

void fill_columns(Run& run) {
  for (const formation::Step& step : run.file.recording.steps) {
    run.time.push_back(step.time);
    for (const formation::RobotStep& robot : step.robots) {
      for (auto [column, value] : {std::pair{&run.position, robot.position}, std::pair{&run.velocity, robot.velocity},
                                   std::pair{&run.preferred, robot.preferred}, std::pair{&run.chosen, robot.chosen}}) {
        column->push_back(value.x);
        column->push_back(value.y);
      }
      run.status.push_back(static_cast<std::uint8_t>(robot.status));
      run.mode.push_back(static_cast<std::uint8_t>(robot.mode));
    }
  }
}

/// The robots of a slice as (time, positions, velocities, preferred), arrays of their own.
py::tuple now_as_tuple(const formation::RobotSlice& robots, const std::vector<Vec2>& preferred) {
  return py::make_tuple(robots.time, as_array(robots.positions), as_array(robots.velocities), as_array(preferred));
}

/// What Python asks of the robots of a run. It gets all robots at once, and what it raises ends the run.
void take_own_rules(const py::object& steering, const py::object& asks, formation::SimulationOptions& options) {
  if (!steering.is_none())
    options.steering = [&steering](const formation::RobotSlice& robots, std::vector<Vec2>& preferred) {
      const py::gil_scoped_acquire held;
      const auto wanted = steering(*now_as_tuple(robots, preferred)).cast<py::array_t<double, py::array::c_style>>();
      for (std::size_t i = robots.first; i < robots.last; ++i)
        preferred[i] = {wanted.data()[2 * i], wanted.data()[2 * i + 1]};
    };
  if (!asks.is_none())
    options.half_planes = [&asks](const formation::RobotSlice& robots, const std::vector<Vec2>& preferred,
                                  std::vector<formation::OwnHalfPlane>& out) {
      const py::gil_scoped_acquire held;
      for (const py::handle h : asks(*now_as_tuple(robots, preferred))) {
        const auto [robot, x, y, offset, hard] = h.cast<std::tuple<std::size_t, double, double, double, bool>>();
        out.push_back({robot, {{x, y}, offset}, hard});
      }
    };
}

/// Keeps the rows, and tells Python what is said before the run. What Python raises ends the run.
class WarningSink : public formation::RunSink {
 public:
  explicit WarningSink(const py::object& warn) : warn_(warn) {}
  void begin(const formation::Recording& run) override {
    const py::gil_scoped_acquire held;
    for (const std::string& warning : run.warnings) warn_(warning);
  }
  void add_row(formation::Step row) override { rows.push_back(std::move(row)); }

  std::vector<formation::Step> rows;

 private:
  const py::object& warn_;
};

std::unique_ptr<Run> simulate(const LoadedScenario& handle, const std::string& method, const py::object& guidance,
                              const py::object& liveness, const std::string& controller, const std::string& integrator,
                              bool record_all, int threads, const py::object& progress, const py::object& steering,
                              const py::object& asks, const py::object& warn) {
  using namespace formation;
  SimulationOptions options;
  options.method = word<Method>(method, "method", method_names(), &parse);
  if (!guidance.is_none()) options.guidance = word<Guidance>(py::str(guidance), "guidance", guidance_names(), &parse);
  if (!liveness.is_none()) options.liveness = word<Liveness>(py::str(liveness), "liveness", liveness_names(), &parse);
  options.controller = word<Controller>(controller, "controller", controller_names(), &parse);
  options.integrator = word<Integrator>(integrator, "integrator", integrator_names(), &parse);
  options.record_all = record_all;
  options.threads = threads;
  // Python is asked about ten times a second: for Ctrl-C, and whether to go on. What it raises ends the run.
  options.progress = [&](double time) {
    const py::gil_scoped_acquire held;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    return progress.is_none() || py::bool_(!progress(time).equal(py::bool_(false)));
  };
  take_own_rules(steering, asks, options);
  for (const ScenarioProblem& p : option_problems(handle.scenario, options))
    throw ArgumentError(p.pointer, p.found, p.expected);
  auto run = std::make_unique<Run>();
  run->file.scenario = handle.scenario;
  if (const std::string moved = recentring_notice(handle.scenario, options); !moved.empty()) warn(moved);
  WarningSink sink(warn);
  {
    const py::gil_scoped_release released;
    run->file.info =
        datasets::run_info(handle.scenario, options, datasets::make_provenance({"exactvo.simulate"}, 0, handle.files));
    run->file.recording = formation::simulate(handle.scenario, options, sink);
    run->file.recording.steps = std::move(sink.rows);
    Evaluation evaluation = evaluate(handle.scenario, run->file.recording);
    run->metrics = std::move(evaluation.metrics);
    run->file.lyapunov = std::move(evaluation.lyapunov);
    run->file.stuck = std::move(evaluation.stuck);
    run->file.collisions = run->metrics.collisions;
    run->file.outcome = run->metrics.outcome;
    fill_columns(*run);
  }
  return run;
}

std::unique_ptr<Run> recorded(datasets::RecordingFile file) {
  auto run = std::make_unique<Run>();
  run->file = std::move(file);
  run->metrics = formation::measure(run->file.scenario, run->file.recording);
  fill_columns(*run);
  return run;
}

/// The page of `exactvo view` of some runs.
std::string explorer_page(const std::vector<const Run*>& runs) {
  std::vector<tools::PageRun> shown;
  std::set<std::string> taken;
  for (const Run* run : runs) {
    shown.push_back(tools::recorded_run(run->file, datasets::metrics_json(run->file.info, run->metrics)));
    make_key_distinct(shown.back(), taken);
    taken.insert(shown.back().key);
  }
  return tools::explorer_page(shown);
}

template <class T>
void def_column(py::class_<Run>& run_class, const char* name, std::vector<T> Run::*column, bool is_vector) {
  run_class.def_property_readonly(name, [column, is_vector](const py::object& self) {
    const Run& run = self.cast<const Run&>();
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(run.time.size()), static_cast<py::ssize_t>(run.robots())};
    if (is_vector) shape.push_back(2);
    return view((run.*column).data(), std::move(shape), self);
  });
}

/// The half-planes of one decision that were recorded.
py::list half_planes(const Run& run, std::size_t step, std::size_t robot) {
  const auto& steps = run.file.recording.steps;
  if (step >= steps.size())
    throw py::index_error("no step " + std::to_string(step) + ": there are " + std::to_string(steps.size()));
  if (robot >= steps[step].robots.size()) throw py::index_error("no robot " + std::to_string(robot));
  py::list result;
  for (const formation::DecisionConstraint& c : steps[step].robots[robot].constraints)
    result.append(py::make_tuple(as_tuple(c.half_plane), static_cast<int>(c.source), c.index, c.certified, c.hard,
                                 c.active, c.multiplier, c.clearance));
  return result;
}

/// The half-planes of one decision that the user asked for, and the stage in which it was made.
py::tuple own_half_planes(const Run& run, std::size_t step, std::size_t robot) {
  const formation::RobotStep& decision = run.file.recording.steps.at(step).robots.at(robot);
  py::list result;
  for (const formation::OwnConstraint& c : decision.own)
    result.append(py::make_tuple(as_tuple(c.half_plane), c.hard, c.active, c.multiplier));
  return py::make_tuple(name(decision.own_stage), result);
}

/// (row, from_row, robots, starts, who moves, where to), a tuple per plan.
py::list plans(const Run& run) {
  py::list result;
  for (const formation::JointPlan& plan : run.file.recording.plans) {
    std::vector<std::size_t> movers;
    std::vector<Vec2> places;
    for (const formation::PlanMove& move : plan.moves) {
      movers.push_back(move.robot);
      places.push_back(move.to);
    }
    result.append(
        py::make_tuple(plan.row, plan.from_row, plan.robots, as_array(plan.starts), movers, as_array(places)));
  }
  return result;
}

}  // namespace

void bind_simulate(py::module_& module) {
  py::class_<LoadedScenario>(module, "Scenario")
      .def_static(
          "load", [](const std::string& path) { return datasets::load_scenario_with_notes(path); }, WithoutGil())
      .def_static(
          "parse",
          [](const std::string& text, const std::string& file_name, const std::string& base_dir) {
            return datasets::parse_scenario_with_notes(text, file_name, base_dir);
          },
          WithoutGil())
      .def(
          "to_json", [](const LoadedScenario& s) { return datasets::write_scenario(s.scenario); }, WithoutGil())
      .def("problems",
           [](const LoadedScenario& s) {
             py::list result;
             for (const formation::ScenarioProblem& p : formation::validate(s.scenario))
               result.append(py::make_tuple(p.pointer, p.found, p.expected));
             return result;
           })
      .def(
          "warnings", [](const LoadedScenario& s) { return formation::warnings_before(s.scenario); }, WithoutGil())
      .def_property_readonly("name", [](const LoadedScenario& s) { return s.scenario.name; })
      .def_property_readonly("notes", [](const LoadedScenario& s) { return s.notes; })
      .def("obstacles", [](const LoadedScenario& s) { return Obstacles{s.scenario.obstacles}; })
      .def("robots", [](const LoadedScenario& s) {
        py::list result;
        for (const formation::Robot& r : s.scenario.robots)
          result.append(py::make_tuple(r.id, as_tuple(r.position), as_array(r.goals), r.radius, r.max_speed));
        return result;
      });
  py::class_<Run> run_class(module, "Run");
  run_class
      .def_static(
          "read", [](const std::string& path) { return recorded(datasets::read_recording(path)); }, WithoutGil())
      .def_static(
          "parse", [](const std::string& text) { return recorded(datasets::parse_recording(text, "<pickled>")); },
          WithoutGil())
      .def(
          "write", [](const Run& run, const std::string& path) { datasets::write_recording(path, run.file); },
          WithoutGil())
      .def_property_readonly("time",
                             [](const py::object& self) {
                               const Run& run = self.cast<const Run&>();
                               return view(run.time.data(), {static_cast<py::ssize_t>(run.time.size())}, self);
                             })
      .def(
          "metrics_json", [](const Run& run) { return datasets::metrics_json(run.file.info, run.metrics); },
          WithoutGil())
      .def_property_readonly("outcome", [](const Run& run) { return run.metrics.outcome; })
      .def_property_readonly("method", [](const Run& run) { return run.file.info.method; })
      .def_property_readonly("warnings", [](const Run& run) { return run.metrics.warnings; })
      .def("scenario",
           [](const Run& run) {
             return LoadedScenario{run.file.scenario, {}, {}};
           })
      .def("half_planes", &half_planes)
      .def("own_half_planes", &own_half_planes)
      .def("plans", &plans)
      .def(
          "audit", [](const Run& run) { return datasets::to_json(datasets::audit(run.file)); }, WithoutGil());
  def_column(run_class, "position", &Run::position, true);
  def_column(run_class, "velocity", &Run::velocity, true);
  def_column(run_class, "preferred", &Run::preferred, true);
  def_column(run_class, "chosen", &Run::chosen, true);
  def_column(run_class, "status", &Run::status, false);
  def_column(run_class, "mode", &Run::mode, false);
  module.def("simulate", &simulate);
  module.def("explorer_page", &explorer_page, WithoutGil());
  module.def(
      "write_text",
      [](const std::string& path, const std::string& text) { datasets::write_file_atomically(path, text); },
      WithoutGil());
  module.def("method_names", &formation::method_names);
  module.attr("mode_names") = [] {
    std::vector<std::string> names;
    for (int k = 0; k <= static_cast<int>(formation::Mode::arrived); ++k)
      names.emplace_back(name(static_cast<formation::Mode>(k)));
    return py::tuple(py::cast(names));
  }();
}

}  // namespace exactvo::python
