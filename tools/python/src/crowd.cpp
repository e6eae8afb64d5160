// SPDX-License-Identifier: GPL-3.0-or-later
// Crowds of robots. Positions and velocities are numpy arrays that the crowd owns and `step` fills in place: what
// Python sees is a view of them, at the same address from step to step.
#include "exactvo/formation/crowd.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <type_traits>

#include "module.h"
#include "shapes.h"

namespace exactvo::python {

namespace {

using formation::RobotId;
using namespace py::literals;

/// The place of an id without a robot.
constexpr Vec2 kNowhere{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

/// Values by id that Python sees: numbers, or rows of two. They grow by a new allocation; what saw the old one keeps it
/// alive.
template <class T>
class Column {
 public:
  void grow(std::size_t rows, T value) {
    if (rows <= rows_) return;
    view_ = py::none();
    if (rows > capacity_) {
      const std::size_t capacity = std::max(rows, 2 * capacity_);
      auto memory = std::make_unique<T[]>(capacity);
      std::fill_n(memory.get(), capacity, value);
      std::copy_n(data_, rows_, memory.get());
      data_ = memory.get();
      owner_ = py::capsule(memory.release(), [](void* p) { delete[] static_cast<T*>(p); });
      capacity_ = capacity;
    }
    rows_ = rows;
  }

  T* data() { return data_; }

  py::object view(bool is_writable) {
    if (!view_.is_none()) return view_;
    using Number = std::conditional_t<std::is_same_v<T, Vec2>, double, T>;
    std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows_)};
    if (sizeof(T) > sizeof(Number)) shape.push_back(2);
    view_ = python::view(reinterpret_cast<const Number*>(data_), std::move(shape), owner_, is_writable);
    return view_;
  }

 private:
  std::size_t rows_ = 0, capacity_ = 0;
  T* data_ = nullptr;
  py::object owner_ = py::none(), view_ = py::none();
};

class PythonCrowd {
 public:
  explicit PythonCrowd(formation::Crowd crowd) : crowd_(std::move(crowd)) { grow(); }

  /// The crowd, for one thread at a time.
  class Use {
   public:
    explicit Use(PythonCrowd& crowd) : crowd_(crowd.crowd_), one_(crowd.busy_, "crowd") {}
    formation::Crowd* operator->() const { return &crowd_; }

   private:
    formation::Crowd& crowd_;
    OneThread one_;
  };

  formation::Crowd& crowd() { return crowd_; }

  RobotId add_robot(Vec2 position, formation::KindId kind) {
    const RobotId id = crowd_.add_robot(position, kind);
    grow();
    take(id);
    return id;
  }

  void remove_robot(RobotId id) {
    crowd_.remove_robot(id);
    positions_.data()[id] = velocities_.data()[id] = kNowhere;
    preferred_.data()[id] = {};
    kept_.data()[id] = false;
  }

  /// After a change of the crowd: rows for new ids.
  void grow() {
    const std::size_t rows = crowd_.id_end();
    positions_.grow(rows, kNowhere);
    velocities_.grow(rows, kNowhere);
    preferred_.grow(rows, {});
    kept_.grow(rows, false);
  }

  void take(RobotId id) {
    positions_.data()[id] = crowd_.position(id);
    velocities_.data()[id] = crowd_.velocity(id);
  }

  /// Everything that the robots have now into the arrays.
  void take_all() {
    write(&formation::Crowd::positions, positions_.data());
    write(&formation::Crowd::velocities, velocities_.data());
    crowd_.kept(kept_now_);
    std::copy(kept_now_.begin(), kept_now_.end(), kept_.data());
  }

  formation::StepReport step(std::size_t count) {
    const Use use(*this);
    const std::size_t rows = crowd_.id_end();
    const py::gil_scoped_release released;
    formation::StepReport sum;
    for (std::size_t k = 0; k < count; ++k) {
      if (!heads_for_goals_) {
        preferred_now_.assign(preferred_.data(), preferred_.data() + rows);
        crowd_.set_preferred(preferred_now_);
      }
      try {
        add(sum, crowd_.step());
      } catch (...) {
        take_all();  // of the steps before the one that failed
        throw;
      }
      ++steps_;
    }
    take_all();
    return sum;
  }

  /// Each robot prefers its goal at `speed`, slower where it would pass it in a step. NaN: it prefers to stand.
  void head_for(const Doubles& goals, double speed) {
    const Use use(*this);
    const py::gil_scoped_release released;
    goals_.resize(static_cast<std::size_t>(goals.shape(0)));
    for (std::size_t id = 0; id < goals_.size(); ++id) goals_[id] = {goals.data()[2 * id], goals.data()[2 * id + 1]};
    const double time_step = crowd_.options().time_step;
    crowd_.set_steering([this, speed, time_step](formation::CrowdSlice& slice) {
      for (std::size_t k = 0; k < slice.size(); ++k) {
        const std::size_t id = slice.id(k);
        if (id >= goals_.size() || !is_finite(goals_[id])) continue;
        const Vec2 way = goals_[id] - slice.position(k);
        const double most = std::isinf(speed) ? crowd_.kind(slice.kind(k)).max_speed : speed;
        const double length = std::hypot(way.x, way.y);
        if (length > 0.0) slice.prefer(k, way * (std::fmin(most, length / time_step) / length));
      }
    });
    heads_for_goals_ = true;
  }
  void follow_preferred() {
    const Use use(*this);
    heads_for_goals_ = false;
  }

  Column<Vec2>& positions() { return positions_; }
  Column<Vec2>& velocities() { return velocities_; }
  Column<Vec2>& preferred() { return preferred_; }
  Column<bool>& kept() { return kept_; }
  std::size_t steps() const { return steps_; }
  void set_steps(std::size_t steps) { steps_ = steps; }

 private:
  static void add(formation::StepReport& sum, const formation::StepReport& step) {
    using R = formation::StepReport;
    sum.robots = step.robots;
    for (const auto count :
         {&R::neighbours, &R::relaxed, &R::cut_short, &R::overlapping, &R::touching, &R::widened, &R::edges, &R::stopped, &R::nudged})
      sum.*count += step.*count;
  }

  /// By way of an array that is kept: entries of ids that name nobody are not written.
  void write(void (formation::Crowd::*fill)(std::vector<Vec2>&) const, Vec2* out) {
    by_id_.assign(crowd_.id_end(), kNowhere);
    (crowd_.*fill)(by_id_);
    std::copy(by_id_.begin(), by_id_.end(), out);
  }

  formation::Crowd crowd_;
  Column<Vec2> positions_, velocities_, preferred_;
  Column<bool> kept_;
  std::vector<Vec2> by_id_, preferred_now_, goals_;
  std::vector<std::uint8_t> kept_now_;
  std::atomic<bool> busy_{false};
  bool heads_for_goals_ = false;
  std::size_t steps_ = 0;
};

/// `nobody`: what a number that no Id has is said to be.
template <class Id>
Id id_of(const py::int_& number, formation::CrowdProblem problem, const char* nobody) {
  const long long value = PyLong_AsLongLong(number.ptr());
  PyErr_Clear();
  if (value < 0 || value > std::numeric_limits<Id>::max())
    throw formation::CrowdError(problem, nobody + std::string(py::repr(number)));
  return static_cast<Id>(value);
}
RobotId robot_id(const py::int_& id) {
  return id_of<RobotId>(id, formation::CrowdProblem::unknown_robot, "no robot has the id ");
}
formation::KindId kind_id(const py::int_& id) {
  return id_of<formation::KindId>(id, formation::CrowdProblem::unknown_kind, "no kind has the number ");
}

py::tuple as_tuple(const formation::StepReport& r) {
  return py::make_tuple(r.robots, r.neighbours, r.relaxed, r.cut_short, r.overlapping, r.touching, r.widened, r.edges, r.stopped, r.nudged);
}

py::dict as_dict(const formation::CrowdExplanation& e) {
  py::list neighbours, edges;
  for (const auto& n : e.neighbours)
    neighbours.append(py::make_tuple(n.robot, python::as_tuple(n.half_plane), n.touching));
  for (const auto& n : e.edges)
    edges.append(py::make_tuple(python::as_tuple(n.edge.a), python::as_tuple(n.edge.b), python::as_tuple(n.half_plane),
                                n.touching));
  return py::dict("robot"_a = e.robot, "position"_a = python::as_tuple(e.position),
                  "velocity"_a = python::as_tuple(e.velocity), "preferred"_a = python::as_tuple(e.preferred),
                  "wish"_a = python::as_tuple(e.wish), "chosen"_a = python::as_tuple(e.chosen), "kept"_a = e.kept, "widened"_a = e.widened,
                  "neighbours"_a = neighbours, "edges"_a = edges);
}

std::unique_ptr<PythonCrowd> make_crowd(py::handle time_step, py::handle position_step, const std::string& precision,
                                        bool certified, int threads) {
  formation::CrowdOptions options;
  options.time_step = number(time_step, "time_step");
  options.position_step = number(position_step, "position_step");
  options.precision = word<formation::CrowdPrecision>(precision, "precision", {"float", "double"}, &formation::parse);
  options.certified = certified;
  options.threads = threads;
  return std::make_unique<PythonCrowd>(formation::Crowd(options));
}

py::bytes snapshot(PythonCrowd& crowd) {
  const PythonCrowd::Use use(crowd);
  const std::string bytes = [&] {
    const py::gil_scoped_release released;
    std::ostringstream out;
    crowd.crowd().snapshot(out);
    return out.str();
  }();
  return bytes;
}

std::unique_ptr<PythonCrowd> restored(const py::bytes& bytes, int threads) {
  std::optional<formation::Crowd> crowd;
  {
    std::istringstream in{std::string(bytes)};
    const py::gil_scoped_release released;
    crowd.emplace(formation::Crowd::restored(in, threads));
  }
  auto made = std::make_unique<PythonCrowd>(std::move(*crowd));
  made->take_all();
  return made;
}

py::array_t<std::uint32_t> add_robots(PythonCrowd& self, py::handle positions, const py::int_& kind) {
  const PythonCrowd::Use use(self);
  const std::vector<Vec2> all = points(positions, "positions");
  const formation::KindId k = kind_id(kind);
  py::array_t<std::uint32_t> ids(static_cast<py::ssize_t>(all.size()));
  RobotId* const added = ids.mutable_data();
  std::size_t done = 0;
  try {
    const py::gil_scoped_release released;
    // First whether there is a place for the farthest: a refusal then leaves no id behind.
    const auto farthest = std::max_element(all.begin(), all.end(), [](Vec2 a, Vec2 b) {
      return std::max(std::fabs(a.x), std::fabs(a.y)) < std::max(std::fabs(b.x), std::fabs(b.y));
    });
    if (farthest != all.end()) self.crowd().remove_robot(self.crowd().add_robot(*farthest, k));
    self.crowd().reserve(self.crowd().size() + all.size());
    for (; done < all.size(); ++done) added[done] = self.crowd().add_robot(all[done], k);
  } catch (...) {  // all or none
    while (done > 0) self.crowd().remove_robot(added[--done]);
    self.grow();
    throw;
  }
  self.grow();
  const py::gil_scoped_release released;
  for (std::size_t r = 0; r < all.size(); ++r) self.take(added[r]);
  return ids;
}

}  // namespace

void bind_crowd(py::module_& module) {
  py::class_<PythonCrowd>(module, "Crowd")
      .def(py::init(&make_crowd))
      .def_static("restored", &restored)
      .def("add_kind",
           [](PythonCrowd& self, py::handle radius, py::handle max_speed, py::handle time_horizon,
              py::handle neighbour_distance, int neighbours) {
             return PythonCrowd::Use(self)->add_kind({number(radius, "radius"), number(max_speed, "max_speed"),
                                                      number(time_horizon, "time_horizon"),
                                                      number(neighbour_distance, "neighbour_distance"), neighbours});
           })
      .def("kind",
           [](PythonCrowd& self, const py::int_& kind) {
             const PythonCrowd::Use use(self);
             const formation::CrowdKind& k = self.crowd().kind(kind_id(kind));
             return py::make_tuple(k.radius, k.max_speed, k.time_horizon, k.neighbour_distance, k.neighbours);
           })
      .def("kind_of",
           [](PythonCrowd& self, const py::int_& id) { return PythonCrowd::Use(self)->kind_of(robot_id(id)); })
      .def("add_robot",
           [](PythonCrowd& self, py::handle position, const py::int_& kind) {
             const PythonCrowd::Use use(self);
             return self.add_robot(vector(position, "position"), kind_id(kind));
           })
      .def("add_robots", &add_robots)
      .def("remove_robot",
           [](PythonCrowd& self, const py::int_& id) {
             const PythonCrowd::Use use(self);
             self.remove_robot(robot_id(id));
           })
      .def("add_obstacles",
           [](PythonCrowd& self, const Obstacles& obstacles) {
             const PythonCrowd::Use use(self);
             std::vector<formation::ObstacleId> ids;
             const py::gil_scoped_release released;
             try {
               for (const formation::SceneObstacle& obstacle : obstacles.list)
                 ids.push_back(self.crowd().add_obstacle(obstacle.shape));
             } catch (...) {  // all or none
               for (const formation::ObstacleId id : ids) self.crowd().remove_obstacle(id);
               throw;
             }
             return ids;
           })
      .def("remove_obstacle", [](PythonCrowd& self, std::uint32_t id) { PythonCrowd::Use(self)->remove_obstacle(id); })
      .def("__len__", [](PythonCrowd& self) { return self.crowd().size(); })
      .def("step", [](PythonCrowd& self, std::size_t count) { return as_tuple(self.step(count)); })
      .def("head_for",
           [](PythonCrowd& self, py::handle goals, py::handle speed) {
             const Doubles array = doubles(goals, "goals", {static_cast<py::ssize_t>(self.crowd().id_end()), 2});
             self.head_for(array, positive_or_infinite(speed, "speed"));
           })
      .def("follow_preferred", &PythonCrowd::follow_preferred)
      .def_property_readonly("positions", [](PythonCrowd& self) { return self.positions().view(false); })
      .def_property_readonly("velocities", [](PythonCrowd& self) { return self.velocities().view(false); })
      .def_property_readonly("kept", [](PythonCrowd& self) { return self.kept().view(false); })
      .def_property_readonly("preferred", [](PythonCrowd& self) { return self.preferred().view(true); })
      .def_property_readonly("steps", &PythonCrowd::steps)
      .def("set_steps", &PythonCrowd::set_steps)
      .def_property_readonly("time_step", [](PythonCrowd& self) { return self.crowd().options().time_step; })
      .def_property_readonly("digest",
                             [](PythonCrowd& self) {
                               const PythonCrowd::Use use(self);
                               const py::gil_scoped_release released;
                               return self.crowd().digest();
                             })
      .def("explain",
           [](PythonCrowd& self, const py::int_& id) {
             const PythonCrowd::Use use(self);
             const RobotId robot = robot_id(id);
             const formation::CrowdExplanation explained = without_gil([&] { return self.crowd().explain(robot); });
             return as_dict(explained);
           })
      .def("snapshot", &snapshot);
  module.attr("crowd_target") = formation::crowd_target();
}

}  // namespace exactvo::python
