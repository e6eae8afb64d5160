// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/process.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <new>
#include <utility>

#include "batch/plan/input_record.h"
#include "batch/plan/inputs.h"
#include "batch/work/part.h"

namespace exactvo::datasets::batch {
namespace {

using Clock = std::chrono::steady_clock;

/// A chunk ends at so many obstacles or vertices: some hundredths of a second of work.
constexpr std::size_t kItemsOfChunk = 512;
constexpr std::size_t kVerticesOfChunk = 8192;
/// What a vertex takes until its chunk is written: shapes, features, text. Measured: 3 to 5 kB with everything wanted.
constexpr std::uint64_t kBytesOfVertex = 6000;
/// What a file that is read whole takes, times its size, at most.
constexpr std::uint64_t kBytesOfByte = 20;

/// The batch's own failure on its way out of a reader, which must not take it for the file's.
struct Failure {
  std::exception_ptr cause;
};

/// An input under way: whoever finishes the last of its chunks writes its facts. An input of one chunk is a single
/// file.
struct InputWork {
  std::filesystem::path facts_path;
  std::string facts;                 ///< set before the reader lets go
  std::atomic<std::size_t> open{1};  ///< chunks under way, and the reader
};

/// Cuts what a reader gives into chunks and hands them to the pool.
class Chunker {
 public:
  Chunker(const Input& input, std::size_t number, const WorkContext& context, const InputWatch& watch)
      : input_(input), number_(number), context_(context), watch_(watch) {
    work_->facts_path = context.journal.input_facts(number);
    start_chunk();
  }

  void add(ChunkItem item, std::size_t vertices) {
    if (!is_offset_chosen_ && !item.rejected) choose_offset(item.obstacle.shape);
    chunk_->vertices += vertices;
    chunk_->items.push_back(std::move(item));
    if (chunk_->items.size() >= kItemsOfChunk || chunk_->vertices >= kVerticesOfChunk) hand_over();
  }

  /// Of what is added from now on.
  void set_plane(const LocalPlane& plane) {
    if (!chunk_->items.empty()) hand_over();
    plane_ = chunk_->plane = plane;
    is_offset_chosen_ = plane.is_placed();
  }

  void show(double share) { share_ = share; }

  /// The input is read: what is left of it, and its facts once the last chunk is there. Without `with_chunks` what was
  /// made of it counts for nothing.
  void finish(InputFacts facts, bool with_chunks) {
    const bool is_single = next_ == 0 && !chunk_->items.empty() && with_chunks;
    if (!is_single && !chunk_->items.empty()) hand_over();
    facts.chunks = with_chunks ? std::max<std::size_t>(next_, is_single ? 1 : 0) : 0;
    if (context_.merge != nullptr) context_.merge->close(number_, facts.chunks);
    work_->facts = to_json(facts) + "\n";
    if (is_single) return hand_over_whole();
    let_go(*work_, context_.journal);
  }

 private:
  void start_chunk() {
    chunk_ = std::make_shared<Chunk>();
    chunk_->file = input_.name;
    chunk_->number = next_;
    chunk_->first = first_;
    chunk_->plane = plane_;
  }

  /// Of a plane without a place on earth, by the first obstacle: the others are not known yet.
  void choose_offset(const geometry::Obstacle& shape) {
    const std::vector<geometry::Vec2> points = geometry::vertices_of(shape);
    plane_.offset = chunk_->plane.offset = offset_for(points.front(), points.front());
    is_offset_chosen_ = true;
  }

  void hand_over() {
    if (!watch_(share_)) throw Stopped{};
    first_ += chunk_->items.size();
    const std::filesystem::path path = context_.journal.part(number_, next_);
    if (!context_.journal.is_there(path)) {
      ++work_->open;
      give([work = work_, path, &journal = context_.journal](const std::string& part) {
        journal.write(path, part);
        let_go(*work, journal);
      });
    } else if (context_.merge != nullptr) {
      context_.merge->found({number_, next_});
    }
    ++next_;
    start_chunk();
  }

  void hand_over_whole() {
    give([work = work_, &journal = context_.journal](const std::string& part) {
      journal.write(work->facts_path, work->facts + part);
    });
  }

  /// The chunk goes with its job.
  template <class Write>
  void give(Write write) {
    context_.pool.run(
        [chunk = chunk_, write, key = PartKey{number_, next_}, context = context_] {
          const auto bytes = std::make_shared<const std::string>(make(*chunk, context));
          put_away(key, bytes, write, context);
        },
        kBytesOfVertex * chunk_->vertices);
  }

  static std::string make(const Chunk& chunk, const WorkContext& context) {
    const auto start = Clock::now();
    Part part = part_of(chunk, context.configuration);
    context.counters.obstacles += part.counts.obstacles;
    context.counters.vertices += part.counts.vertices;
    std::string bytes = to_bytes(std::move(part));
    context.counters.nanoseconds_of_jobs +=
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count());
    return bytes;
  }

  /// Queued for the disk before it is merged. Where the merge does not keep it in memory, it is told when the disk has
  /// it.
  template <class Write>
  static void put_away(PartKey key, const std::shared_ptr<const std::string>& bytes, const Write& write,
                       const WorkContext& context) {
    context.pool.put_away([bytes, write] { write(*bytes); }, bytes->size());
    OrderedMerge* const merge = context.merge;
    if (merge == nullptr || merge->take(key, bytes)) return;
    context.pool.put_away([key, merge] { merge->found(key); }, 0);
  }

  static void let_go(InputWork& work, const Journal& journal) {
    if (--work.open == 0) journal.write(work.facts_path, work.facts);
  }

  const Input& input_;
  std::size_t number_;
  const WorkContext& context_;
  const InputWatch& watch_;
  std::shared_ptr<InputWork> work_ = std::make_shared<InputWork>();
  std::shared_ptr<Chunk> chunk_;
  std::size_t next_ = 0;
  std::uint64_t first_ = 0;
  double share_ = 0.0;
  LocalPlane plane_;
  bool is_offset_chosen_ = false;
};

/// Runs a part of the batch inside a reader.
template <class Action>
void outside_the_reader(const Action& action) {
  try {
    action();
  } catch (const Stopped&) {
    throw;
  } catch (...) {
    throw Failure{std::current_exception()};
  }
}

bool is_read_whole(const std::string& format) {
  return format != "wkt" && format != "jupedsim-wkt" && format != "gdal";
}

void refuse_large_file(const Input& input, const ReadOptions& options, std::uint64_t memory_limit) {
  if (memory_limit == 0 || input.size <= memory_limit / kBytesOfByte) return;
  const std::string format = options.format.empty() ? format_of(input.path) : options.format;
  if (!is_read_whole(format)) return;
  throw DataError(DataCode::size, input.name, "", "a " + format + " file of " + std::to_string(input.size) + " bytes",
                  "at most a " + std::to_string(kBytesOfByte) + "th of the memory allowed: it is read whole");
}

/// The file's outcome is the best of its obstacles'; all rejected is rejected, by the first one's code.
void judge(InputFacts& facts, const ReadCounts& counts, const std::optional<DataError>& first_rejected) {
  facts.tally.read = counts.done + counts.repaired + counts.rejected;
  facts.tally.done = counts.done;
  facts.tally.repaired = counts.repaired;
  facts.passed_over = counts.passed_over;
  if (counts.done + counts.repaired == 0 && first_rejected) {
    facts.outcome = "rejected";
    facts.code = code_name(first_rejected->code());
    facts.message = first_rejected->what();
  } else {
    facts.outcome = counts.repaired > 0 ? "repaired" : "done";
  }
}

void reject(InputFacts& facts, const char* code, const std::string& message) {
  facts.outcome = "rejected";
  facts.code = code;
  facts.message = message;
}

/// A pipe would be waited for, a folder is no file.
void refuse_irregular_file(const Input& input) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(input.path, error);
  if (error || !std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  const bool is_folder = std::filesystem::is_directory(status);
  throw DataError(DataCode::file_unreadable, input.name, "", is_folder ? "a link to a folder" : "no regular file",
                  is_folder ? "files, and folders named by themselves" : "a regular file");
}

/// Reads the file into the chunker; what is wrong with it becomes its facts.
void read_input(const Input& input, const ReadOptions& given, std::uint64_t memory_limit, Chunker& chunker,
                InputFacts& facts) {
  ReadOptions options = given;
  options.keep_going = true;
  std::optional<DataError> first_rejected;
  ObstacleStream stream;
  stream.obstacle = [&](formation::SceneObstacle obstacle, bool repaired) {
    outside_the_reader([&] {
      const std::size_t vertices = geometry::vertices_of(obstacle.shape).size();
      chunker.add({std::move(obstacle), repaired, std::nullopt}, vertices);
    });
  };
  stream.rejected = [&](DataError error) {
    ++facts.tally.rejected[code_name(error.code())];
    if (!first_rejected) first_rejected = error;
    outside_the_reader([&] { chunker.add({{}, false, std::move(error)}, 1); });
  };
  stream.progress = [&](double share) { chunker.show(share); };
  stream.plane = [&](const LocalPlane& plane) { outside_the_reader([&] { chunker.set_plane(plane); }); };
  try {
    refuse_irregular_file(input);
    refuse_large_file(input, options, memory_limit);
    const ObstacleFile file = read_obstacles(input.path, options, stream);
    facts.format = file.format;
    facts.origin = file.origin;
    facts.extent = file.extent;
    facts.coverage = file.coverage;
    for (const DataNote& note : file.notes) facts.notes.push_back(note.text);
    judge(facts, file.counts, first_rejected);
  } catch (const DataError& error) {
    facts.tally = {};
    reject(facts, code_name(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    facts.tally = {};
    reject(facts, code_name(DataCode::size), input.name + ": more memory wanted than there is");
  } catch (const std::exception& error) {
    facts.tally = {};
    reject(facts, code_name(DataCode::library), input.name + ": " + error.what());
  }
}

/// Parts of other bytes than the journal's must not be found by a resumption.
void refuse_changed_input(const Input& input, std::size_t number, const std::string& format, const Journal& journal,
                          ThreadPool& pool) {
  if (identity_of_input(input.path, format) == input.sha256) return;
  pool.finish();
  std::error_code ignored;
  std::filesystem::remove_all(journal.part(number, 0).parent_path(), ignored);
  throw DataError(DataCode::other_run, input.name, "", "a file that changed under the batch",
                  "files that stay as they are; another --out, or an empty one");
}

}  // namespace

void process_input(const Input& input, std::size_t number, const WorkContext& context, const InputWatch& watch) {
  const BatchConfiguration& configuration = context.configuration;
  Chunker chunker(input, number, context, watch);
  InputFacts facts;
  try {
    read_input(input, configuration.reading, configuration.memory_limit, chunker, facts);
  } catch (const Failure& failure) {
    std::rethrow_exception(failure.cause);
  }
  refuse_changed_input(input, number, configuration.reading.format, context.journal, context.pool);
  // Of a file that turned out to be broken further on nothing is used.
  const bool with_chunks = facts.code.empty() || facts.tally.read > 0;
  chunker.finish(std::move(facts), with_chunks);
}

}  // namespace exactvo::datasets::batch
