// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/work/process.h"

#include <filesystem>
#include <new>
#include <utility>

#include "batch/plan/inputs.h"
#include "batch/work/coroutine.h"

namespace exactvo::datasets::batch {
namespace {

/// A chunk ends at this many obstacles or vertices: some hundredths of a second of work.
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

/// Cuts what a reader gives into chunks.
class Chunker {
 public:
  Chunker(const Input& input, std::size_t number, const Journal& journal, const InputWatch& watch,
          const GivePiece& give)
      : input_(input), number_(number), journal_(journal), watch_(watch), give_(give) {
    start_chunk();
  }

  void add(ChunkItem item, std::size_t vertices) {
    if (!is_offset_chosen_ && !item.rejected) choose_offset(item.obstacle.shape);
    chunk_.vertices += vertices;
    chunk_.items.push_back(std::move(item));
    if (chunk_.items.size() >= kItemsOfChunk || chunk_.vertices >= kVerticesOfChunk) end_chunk();
  }

  /// The plane of what is added from now on.
  void set_plane(const LocalPlane& plane) {
    if (!chunk_.items.empty()) end_chunk();
    plane_ = chunk_.plane = plane;
    is_offset_chosen_ = plane.is_placed();
  }

  void show(double share) { share_ = share; }

  /// The input is read: what is left of it, and its facts. Without `with_chunks` what was given of it counts for
  /// nothing.
  void finish(InputFacts facts, bool with_chunks) {
    Piece last = with_chunks && !chunk_.items.empty() ? piece_of_chunk() : Piece{number_};
    facts.chunks = with_chunks ? next_ : 0;
    last.is_whole_input = last.chunk && facts.chunks == 1;
    last.facts = std::move(facts);
    give_(std::move(last));
  }

 private:
  void start_chunk() {
    chunk_ = {};
    chunk_.file = input_.name;
    chunk_.number = next_;
    chunk_.first = first_;
    chunk_.plane = plane_;
  }

  /// The offset of a plane without a place on earth, by the first obstacle: the others are not known yet.
  void choose_offset(const geometry::Obstacle& shape) {
    const std::vector<geometry::Vec2> points = geometry::vertices_of(shape);
    plane_.offset = chunk_.plane.offset = offset_for(points.front(), points.front());
    is_offset_chosen_ = true;
  }

  Piece piece_of_chunk() {
    Piece piece{number_, next_};
    piece.has_part = true;
    first_ += chunk_.items.size();
    if (!is_part_there(journal_, number_, next_)) piece.chunk = std::move(chunk_);
    ++next_;
    return piece;
  }

  void end_chunk() {
    if (!watch_(share_)) throw Stopped{};
    give_(piece_of_chunk());
    start_chunk();
  }

  const Input& input_;
  std::size_t number_;
  const Journal& journal_;
  const InputWatch& watch_;
  const GivePiece& give_;
  Chunk chunk_;
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

void refuse_large_file(const Input& input, const ReadOptions& options, std::uint64_t memory_limit) {
  if (memory_limit == 0 || input.size <= memory_limit / kBytesOfByte) return;
  const std::string format = options.format.empty() ? format_of(input.path) : options.format;
  if (format == "wkt" || format == "jupedsim-wkt" || format == "gdal") return;  // not read whole
  throw DataError(DataCode::size, input.name, "", "a " + format + " file of " + std::to_string(input.size) + " bytes",
                  "at most a " + std::to_string(kBytesOfByte) + "th of the memory allowed: it is read whole");
}

/// The file's outcome is the best of its obstacles'; all rejected is rejected, by the first one's code.
void set_outcome(InputFacts& facts, const ReadCounts& counts, const std::optional<DataError>& first_rejected) {
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

/// As a whole.
void reject(InputFacts& facts, const char* code, const std::string& message) {
  facts.tally = {};
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
InputFacts read_into(Chunker& chunker, const Input& input, const ReadOptions& given, std::uint64_t memory_limit) {
  InputFacts facts;
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
    facts.distortion = file.distortion;
    for (const DataNote& note : file.notes)
      facts.notes.push_back(note.place.empty() ? note.text : note.place + ": " + note.text);
    set_outcome(facts, file.counts, first_rejected);
  } catch (const DataError& error) {
    reject(facts, code_name(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    reject(facts, code_name(DataCode::size), input.name + ": more memory wanted than there is");
  } catch (const std::exception& error) {
    reject(facts, code_name(DataCode::library), input.name + ": " + error.what());
  }
  return facts;
}

}  // namespace

std::uint64_t memory_of(const Chunk& chunk) {
  return kBytesOfVertex * chunk.vertices;
}

void read_input(const Input& input, std::size_t number, const BatchConfiguration& configuration, const Journal& journal,
                const InputWatch& watch, const GivePiece& give) {
  Chunker chunker(input, number, journal, watch, give);
  try {
    InputFacts facts = read_into(chunker, input, configuration.reading, configuration.memory_limit);
    if (!(hashes_of_input(input.path, configuration.reading.format) == input.hashes)) {
      Piece changed{number};
      changed.has_changed = true;
      return give(std::move(changed));
    }
    // Nothing is used of a file that turned out to be broken further on.
    const bool with_chunks = facts.code.empty() || facts.tally.read > 0;
    chunker.finish(std::move(facts), with_chunks);
  } catch (const Failure& failure) {
    std::rethrow_exception(failure.cause);
  }
}

}  // namespace exactvo::datasets::batch
