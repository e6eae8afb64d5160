// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/session.h"

#include <algorithm>
#include <thread>
#include <utility>

#include "batch/merge/assemble.h"
#include "batch/plan/input_record.h"
#include "exactvo/datasets/provenance.h"
#include "json_text.h"

namespace exactvo::datasets::batch {
namespace {

int workers_of(const BatchRun& run) {
  if (run.workers > 0) return run.workers;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

const char* name_of(Units units) {
  switch (units) {
    case Units::automatic:
      return "automatic";
    case Units::metres:
      return "metres";
    case Units::degrees:
      return "degrees";
  }
  return "automatic";
}

const char* name_of(geometry::PartitionMethod method) {
  switch (method) {
    case geometry::PartitionMethod::automatic:
      return "automatic";
    case geometry::PartitionMethod::greene:
      return "greene";
    case geometry::PartitionMethod::approximate:
      return "approximate";
    case geometry::PartitionMethod::optimal:
      return "optimal";
    case geometry::PartitionMethod::triangles:
      return "triangles";
  }
  return "automatic";
}

void append_shape_options(JsonWriter& json, const geometry::ShapeOptions& o) {
  json.key("shapes").begin_object();
  json.member("facade_tolerance", o.facades.tolerance).member("partition", name_of(o.partition));
  json.member("minor_to_major", o.facade_ellipses.minor_to_major);
  json.member("fixed_minor", o.facade_ellipses.fixed_minor).member("facade_margin", o.facade_ellipses.margin);
  json.member("margin", o.enclosure.margin).member("slack", o.enclosure.slack);
  json.member("least_margin", o.enclosure.least_margin).member("least_slack", o.enclosure.least_slack);
  json.member("clear_of_ends", o.enclosure.clear_of_ends).member("most_inflation", o.enclosure.most_inflation);
  json.member("exact_smallest_ellipse", o.exact_smallest_ellipse).end_object();
}

void append_robot(JsonWriter& json, const BatchRobot& robot) {
  json.key("robot").begin_object().member("radius", robot.radius).member("time_horizon", robot.time_horizon);
  json.member("velocity", robot.velocity).key("positions").begin_array();
  for (const geometry::Vec2 p : robot.positions) json.value(p);
  json.end_array().member("goal", robot.goal).end_object();
}

/// Said before the work, not after.
void refuse_the_unavailable(const BatchConfiguration& configuration, const BatchRun& run) {
  const bool in_degrees = configuration.geojson && !configuration.geojson_in_metres;
  if (built_with_gdal() || !(configuration.geopackage || in_degrees)) return;
  throw DataError(DataCode::format_unavailable, run.out.string(), "",
                  "a GeoPackage or GeoJSON in degrees to write, and a build without GDAL",
                  "a build with EXACTVO_WITH_GDAL=ON, or GeoJSON in metres");
}

}  // namespace

double share_of(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 1.0;
}

std::string to_json(const BatchConfiguration& c) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("format", c.reading.format).member("units", name_of(c.reading.units));
  json.member("cell_size", c.reading.cell_size).member("repair", c.reading.repair);
  json.member("memory_limit", c.memory_limit);
  append_shape_options(json, c.shapes);
  if (c.robot) append_robot(json, *c.robot);
  json.member("geopackage", c.geopackage).member("geojson", c.geojson);
  json.member("geojson_in_metres", c.geojson_in_metres).member("pictures", c.pictures);
  return json.end_object().take();
}

Identity identity_of(const BatchConfiguration& configuration, std::vector<Input> inputs) {
  const Provenance program = make_provenance({}, 0);
  return {program.version, program.commit, to_json(configuration), std::move(inputs)};
}

Session::Session(const BatchConfiguration& configuration, const BatchRun& run, Identity identity, BatchWatch watch)
    : configuration_(configuration),
      run_(run),
      identity_(std::move(identity)),
      provenance_(provenance_of(identity_, run)),
      watch_(std::move(watch)),
      journal_(run.out),
      pool_(workers_of(run), configuration.memory_limit),
      start_(std::chrono::steady_clock::now()) {
  refuse_the_unavailable(configuration, run);
}

void Session::plan(std::vector<std::size_t> inputs) {
  progress_.inputs = inputs.size();
  for (const std::size_t k : inputs) bytes_planned_ += identity_.inputs[k].size;
  progress_.input_bytes = bytes_planned_;
}

bool Session::look(const std::string& doing, double share) {
  if (!watch_) return true;
  progress_.doing = doing;
  progress_.obstacles = counters_.obstacles;
  progress_.share_done = share;
  return watch_(progress_);
}

void Session::merge_ahead() {
  FileLock claim = journal_.claim_merge();
  if (claim.is_held()) merge_.emplace(journal_, std::move(claim), configuration_, provenance_);
}

WorkContext Session::context() {
  return {configuration_, journal_, counters_, pool_, merge_ ? &*merge_ : nullptr};
}

/// Of an input that another process has finished meanwhile.
void Session::tell_merge_of(std::size_t input) {
  const std::uint64_t chunks = read_facts(journal_, input).chunks;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) merge_->found({input, chunk});
  merge_->close(input, chunks);
}

void Session::process(std::size_t number) {
  const Input& input = identity_.inputs[number];
  if (!is_through(journal_, number)) {
    const auto share_now = [&](double share) {
      const auto of_input = static_cast<std::uint64_t>(share * static_cast<double>(input.size));
      return share_of(bytes_done_ + of_input, bytes_planned_);
    };
    if (!look(input.name, share_now(0.0))) throw Stopped{};
    process_input(input, number, context(), [&](double share) { return look(input.name, share_now(share)); });
  } else if (merge_) {
    tell_merge_of(number);
  }
  ++progress_.inputs_done;
  bytes_done_ += input.size;
}

void Session::wait() {
  pool_.finish();
}

Counts Session::counted() const {
  return {counters_.obstacles, counters_.vertices, counters_.nanoseconds_of_jobs};
}

void Session::count(const Counts& more) {
  counters_.obstacles += more.obstacles;
  counters_.vertices += more.vertices;
  counters_.nanoseconds_of_jobs += more.nanoseconds_of_jobs;
}

BatchResult Session::finish() {
  pool_.finish();
  BatchResult result;
  result.end = BatchEnd::incomplete;
  if (!all_there(journal_, identity_.inputs.size()) && journal_.is_open()) return result;
  const FileLock lock =
      journal_.lock_end([this] { return look("waiting for the process that merges the parts", 1.0); });
  if (!journal_.is_open()) return result;  // another process was quicker
  if (lock.state() == FileLock::State::taken) return {BatchEnd::interrupted, {}, false};
  try {
    result.summary = put_together(result, lock.is_held());
  } catch (const Stopped&) {
    return {BatchEnd::interrupted, {}, false};
  } catch (const DataError&) {
    if (journal_.is_open() || lock.is_held()) throw;
    return result;  // another process was quicker here as well
  }
  result.end = BatchEnd::complete;
  return result;
}

void Session::look_before_a_part() {
  if (!look("putting the parts together", 1.0)) throw Stopped{};
}

/// What was merged while parts were made, if it is all of them; else all, from the disk.
std::unique_ptr<Outputs> Session::merged(BatchResult& result, bool is_alone) {
  const auto before_each = [this] { look_before_a_part(); };
  if (merge_) {
    std::unique_ptr<Outputs> outputs = merge_->finish(identity_.inputs.size(), before_each);
    result.was_merged_ahead = outputs != nullptr;
    if (outputs) return outputs;
    merge_.reset();
  }
  journal_.start_final(is_alone ? Journal::LockState::end : Journal::LockState::neither);
  return merge_all(journal_, identity_.inputs.size(), configuration_, provenance_, before_each);
}

BatchSummary Session::put_together(BatchResult& result, bool is_alone) {
  look_before_a_part();
  std::unique_ptr<Outputs> outputs = merged(result, is_alone);
  return finish_outputs(std::move(outputs), journal_, identity_, configuration_, provenance_, times());
}

Times Session::times() const {
  Times times;
  times.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  times.seconds_of_jobs = 1e-9 * static_cast<double>(counters_.nanoseconds_of_jobs);
  times.obstacles = counters_.obstacles;
  times.vertices = counters_.vertices;
  times.workers = processes_ * workers_of(run_);
  times.has_rates = run_.shards == 1;
  return times;
}

}  // namespace exactvo::datasets::batch
