// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/session.h"

#include <algorithm>
#include <cstdlib>
#include <thread>
#include <utility>

#include "batch/formats/features.h"
#include "batch/formats/picture.h"
#include "batch/work/coroutine.h"
#include "exactvo/datasets/ordered_work.h"
#include "exactvo/datasets/provenance.h"
#include "gdal/vector_library.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {
namespace {

int workers_of(const BatchRun& run) {
  if (run.workers > 0) return run.workers;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

void append_shape_options(JsonWriter& json, const geometry::ShapeOptions& o) {
  json.key("shapes").begin_object();
  json.member("facade_tolerance", o.facades.tolerance).member("partition", name(o.partition));
  json.member("minor_to_major", o.facade_ellipses.minor_to_major);
  json.member("fixed_minor", o.facade_ellipses.fixed_minor).member("facade_margin", o.facade_ellipses.margin);
  json.member("margin", o.enclosure.margin).member("slack", o.enclosure.slack);
  json.member("least_margin", o.enclosure.least_margin).member("least_slack", o.enclosure.least_slack);
  json.member("clear_of_ends", o.enclosure.clear_of_ends).member("most_inflation", o.enclosure.most_inflation);
  json.end_object();
}

void append_robot(JsonWriter& json, const BatchRobot& robot) {
  json.key("robot").begin_object().member("radius", robot.radius).member("time_horizon", robot.time_horizon);
  json.member("velocity", robot.velocity).member("positions", robot.positions).member("goal", robot.goal).end_object();
}

/// Canonical: what changes the results and nothing else.
std::string to_json(const BatchConfiguration& c) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("format", c.reading.format).member("units", name(c.reading.units));
  json.member("unknown", name(c.reading.unknown))
      .member("cell_size", c.reading.cell_size)
      .member("repair", c.reading.repair);
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

/// Said before the work, not after.
void refuse_the_unavailable(const BatchConfiguration& configuration, const BatchRun& run) {
  const bool in_degrees = configuration.geojson && !configuration.geojson_in_metres;
  if (!(configuration.geopackage || in_degrees)) return;
  if (built_with_gdal()) {
    vector_library();  // throws where its module is not installed
    return;
  }
  throw DataError(DataCode::format_unavailable, run.out.string(), "",
                  "a GeoPackage or GeoJSON in degrees to write, and a build without GDAL",
                  "a build with EXACTVO_WITH_GDAL=ON, or GeoJSON in metres");
}

std::uint64_t nanoseconds_since(std::chrono::steady_clock::time_point start) {
  const auto spent = std::chrono::steady_clock::now() - start;
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
}

double ratio(double part, std::uint64_t whole) {
  return whole > 0 ? part / static_cast<double>(whole) : 1.0;
}

// --- The end ---

/// JSON; the same in every output and at any time.
std::string provenance_of(const Identity& identity, const BatchRun& run) {
  Provenance provenance = make_provenance(run.command_line, 0);
  for (const Input& input : identity.inputs) {
    provenance.inputs.push_back({input.name, input.hashes.sha256});
    provenance.inputs.insert(provenance.inputs.end(), input.hashes.read_with.begin(), input.hashes.read_with.end());
  }
  provenance.written_at = "see summary.json";
  return to_json(provenance);
}

/// Whether every input has its facts.
bool all_there(const Journal& journal, std::size_t inputs) {
  for (std::size_t k = 0; k < inputs; ++k)
    if (!journal.is_there(journal.input_facts(k))) return false;
  return true;
}

/// Whatever a batch may write to OUT, of this configuration or another.
bool is_output(const std::string& name) {
  if (name == "measurements.jsonl" || name == "obstacles.gpkg" || name == page_name(0)) return true;
  for (const Layer& layer : layers()) {
    if (name == std::string(layer.name) + ".geojson") return true;
  }
  const std::size_t number = std::strtoull(name.c_str() + std::min<std::size_t>(name.size(), 5), nullptr, 10);
  return number > 1 && name == page_name(number - 1);
}

/// Writes index.html and the pages after it, small pictures of every input's first obstacles, to
/// `journal.final_folder()`, from the parts on disk. `facts` are those of every input, `words` stand at the head of
/// each page. Throws DataError (E_FILE_UNWRITABLE; E_FORMAT_SYNTAX for a part that is none).
void write_pages(const Journal& journal, const Identity& identity, const std::vector<InputFacts>& facts,
                 const std::string& words, const std::string& provenance) {
  const std::size_t pages = std::max<std::size_t>(1, (facts.size() + kInputsOfPage - 1) / kInputsOfPage);
  for (std::size_t page = 0; page < pages; ++page) {
    const std::unique_ptr<AtomicFile> file = output_file(journal.final_folder() / page_name(page));
    file->write(page_head(page, pages, words));
    const std::size_t end = std::min(facts.size(), (page + 1) * kInputsOfPage);
    for (std::size_t input = page * kInputsOfPage; input < end; ++input) {
      file->write(input_head(identity.inputs[input].name, words_of(facts[input])));
      if (facts[input].chunks > 0) file->write(read_pictures(journal, input));
      file->write(input_foot());
    }
    file->write(page_foot(provenance));
    file->commit();
  }
}

}  // namespace

Session::Session(const BatchConfiguration& configuration, const BatchRun& run, std::vector<Input> inputs,
                 BatchWatch watch)
    : configuration_(configuration),
      run_(run),
      identity_(identity_of(configuration, std::move(inputs))),
      provenance_(provenance_of(identity_, run)),
      watch_(std::move(watch)),
      journal_(run.out),
      memory_(configuration.memory_limit),
      start_(std::chrono::steady_clock::now()) {
  refuse_the_unavailable(configuration, run);
}

// --- Progress ---

void Session::plan(const std::vector<std::size_t>& inputs) {
  progress_.inputs = inputs.size();
  for (const std::size_t k : inputs) progress_.input_bytes += identity_.inputs[k].size;
}

bool Session::look(const std::string& doing, double input_bytes) {
  if (!watch_) return true;
  progress_.doing = doing;
  progress_.obstacles = counted().obstacles;
  progress_.share_done = ratio(static_cast<double>(bytes_done_) + input_bytes, progress_.input_bytes);
  return watch_(progress_);
}

Counts Session::counted() const {
  const std::lock_guard<std::mutex> lock(counting_);
  return counts_;
}

Counts Session::take_counts() {
  const std::lock_guard<std::mutex> lock(counting_);
  return std::exchange(counts_, Counts{});
}

void Session::count(const Counts& more) {
  const std::lock_guard<std::mutex> lock(counting_);
  counts_ += more;
}

// --- The pipeline ---

void Session::merge_ahead() {
  const auto do_not_wait = [] { return false; };
  if (journal_.lock(do_not_wait) != Journal::Lock::held) return;
  outputs_ = std::make_unique<Outputs>(journal_, configuration_, provenance_);
  is_merging_ = true;
}

void Session::process(const std::vector<std::size_t>& inputs) {
  Coroutine<Piece> pieces([&](const GivePiece& give) {
    for (const std::size_t input : inputs) read(input, give);
  });
  run_in_order(workers_of(run_), [&]() -> std::optional<OrderedTask> {
    std::optional<Piece> next = pieces.next();
    if (!next) return std::nullopt;
    if (next->chunk) next->memory = memory_.take(memory_of(*next->chunk));
    const auto piece = std::make_shared<Piece>(std::move(*next));
    return OrderedTask{[this, piece] { work_on(*piece); }, [this, piece] { finish_piece(*piece); }};
  });
}

/// In the reader's thread. Of an input that another run, or another process, has finished, parts are merged if
/// anybody's are.
void Session::read(std::size_t number, const GivePiece& give) {
  const Input& input = identity_.inputs[number];
  if (!is_through(journal_, number)) {
    if (!look(input.name)) throw Stopped{};
    const auto size = static_cast<double>(input.size);
    read_input(
        input, number, configuration_, journal_, [&](double share) { return look(input.name, share * size); }, give);
  } else if (is_merging_) {
    const std::uint64_t chunks = read_facts(journal_, number).chunks;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      Piece piece{number, chunk};
      piece.has_part = true;
      give(std::move(piece));
    }
  }
  ++progress_.inputs_done;
  bytes_done_ += identity_.inputs[number].size;
}

void Session::work_on(Piece& piece) {
  if (!piece.chunk) return;
  const auto start = std::chrono::steady_clock::now();
  Part part = part_of(*piece.chunk, configuration_);
  piece.chunk.reset();
  Counts counts = part.counts;
  const std::string bytes = to_bytes(std::move(part));
  counts.nanoseconds = nanoseconds_since(start);
  count(counts);
  if (piece.is_whole_input)
    journal_.write(journal_.input_facts(piece.input), to_json(*piece.facts) + "\n" + bytes);
  else
    journal_.write(journal_.part(piece.input, piece.number), bytes);
  piece.memory.reset();
}

void Session::finish_piece(Piece& piece) {
  // Parts of other bytes than the journal's must not be found by a resumption.
  if (piece.has_changed) {
    std::error_code ignored;
    std::filesystem::remove_all(journal_.part(piece.input, 0).parent_path(), ignored);
    throw DataError(DataCode::other_run, identity_.inputs[piece.input].name, "", "a file that changed under the batch",
                    "files that stay as they are; another --out, or an empty one");
  }
  if (piece.has_part && outputs_) merge(piece);
  if (piece.facts) finish_input(piece);
}

void Session::merge(const Piece& piece) {
  const std::string bytes = read_part_bytes(journal_, piece.input, piece.number);
  outputs_->add(view_of_part(bytes, journal_.part(piece.input, piece.number)));
  last_merged_ = piece.input;
}

/// Its parts are there. If they were merged and count for nothing, because the file is broken further on, what was
/// merged is of no use.
void Session::finish_input(const Piece& last) {
  if (!last.is_whole_input) journal_.write(journal_.input_facts(last.input), to_json(*last.facts) + "\n");
  if (last.facts->chunks > 0 || last_merged_ != last.input) return;
  is_merging_ = false;
  outputs_.reset();
}

// --- The end ---

BatchResult Session::finish() {
  BatchResult result;
  result.end = BatchEnd::incomplete;
  if (!all_there(journal_, identity_.inputs.size()) && journal_.is_open()) return result;
  const Journal::Lock lock = journal_.lock([this] { return look("waiting for the process that merges the parts"); });
  if (!journal_.is_open()) return result;  // another process was quicker
  if (lock == Journal::Lock::taken) return {BatchEnd::interrupted, {}, false};
  try {
    result.summary = put_together(result);
  } catch (const Stopped&) {
    return {BatchEnd::interrupted, {}, false};
  } catch (const DataError&) {
    if (journal_.is_open() || lock == Journal::Lock::held) throw;
    return result;  // another process was quicker here as well
  }
  result.end = BatchEnd::complete;
  return result;
}

BatchSummary Session::put_together(BatchResult& result) {
  const auto look_before_a_part = [this] {
    if (!look("putting the parts together")) throw Stopped{};
  };
  look_before_a_part();
  result.was_merged_ahead = outputs_ != nullptr;
  if (!outputs_) {
    outputs_ = std::make_unique<Outputs>(journal_, configuration_, provenance_);
    for (std::size_t input = 0; input < identity_.inputs.size(); ++input) {
      const std::uint64_t chunks = read_facts(journal_, input).chunks;
      for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        look_before_a_part();
        merge(Piece{input, chunk});
      }
    }
  }
  return publish();
}

/// Finishes `outputs_`, which hold all parts, writes what is missing beside them, and moves everything to its place.
BatchSummary Session::publish() {
  std::vector<InputFacts> facts;
  for (std::size_t k = 0; k < identity_.inputs.size(); ++k) facts.push_back(read_facts(journal_, k));
  const Counts& out = outputs_->counts();
  BatchSummary summary = summary_of(identity_, facts);
  summary.obstacles_out = out.obstacles;
  summary.certified = out.certified;
  summary.uncertified = out.obstacles - out.certified;
  summary.vertices = out.vertices;
  summary.no_half_plane = out.no_half_plane;
  outputs_->finish();
  if (configuration_.pictures) {
    const std::string words = words_of(summary.files, "file") + ". " + words_of(summary.obstacles, "obstacle") + ".";
    write_pages(journal_, identity_, facts, words, provenance_);
  }
  const Times taken = times();
  const auto last = output_file(journal_.final_folder() / "summary.json");
  last->write(to_json(summary, identity_, provenance_, facts, taken));
  last->commit();
  journal_.publish("summary.json", is_output);
  summary.seconds = taken.seconds;
  summary.obstacles_now = taken.made.obstacles;
  summary.vertices_now = taken.made.vertices;
  return summary;
}

Times Session::times() const {
  Times times;
  times.made = counted();
  times.seconds = 1e-9 * static_cast<double>(nanoseconds_since(start_));
  times.workers = progress_.ranks * workers_of(run_);
  times.has_rates = run_.shards == 1;
  times.written_at = make_provenance({}, 0).written_at;
  return times;
}

}  // namespace exactvo::datasets::batch
