// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo vo: velocity obstacles, their answers and certificates; the family; the free velocities.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/input_text.h"
#include "exactvo/geometry/counted.h"
#include "exactvo/vo/membership.h"
#include "figures/figure.h"
#include "support/fields.h"
#include "support/json_layout.h"
#include "support/robot_numbers.h"
#include "support/terminal.h"
#include "verb.h"
#include "verbs/vo/answer.h"

namespace exactvo::tools {

using datasets::DataCode;
using datasets::DataError;

namespace {

// --- Many velocities against the obstacles of one question, exactly: a line of the answer for each line of the input,
// in memory that does not grow with it ---

constexpr const char* kExpected = "two numbers, vx,vy, or JSON, [vx, vy] or {\"velocity\": [vx, vy]}";
class VelocityReader {
 public:
  explicit VelocityReader(const std::string& file) : lines_(file) {}

  /// The next one; nothing at the end.
  std::optional<Vec2> next() {
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (!std::exchange(has_begun_, true) && takes_header(line)) continue;
      const Vec2 v = velocity_in(line);
      if (!is_in_range(v)) lines_.refuse(DataCode::out_of_range, line, "velocities within 2^100 m/s");
      return v;
    }
    return std::nullopt;
  }
  std::size_t number() const { return lines_.number(); }

 private:
  /// Whether the line names columns; then says which are which.
  bool takes_header(std::string_view line) {
    const std::vector<std::string_view> names = fields_of(line);
    const auto find = [&](std::string_view name) {
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    };
    const std::size_t x = find("vx"), y = find("vy");
    if (x == names.size() || y == names.size()) return false;
    columns_ = {x, y, names.size()};
    return true;
  }

  Vec2 velocity_in(std::string_view line) const {
    if (line.front() == '{') return from_json(line);
    if (line.front() == '[') {
      // Nearly always two plain numbers; whatever else it is, the parser says.
      const auto plain = line.back() == ']' && line.find('"') == std::string_view::npos
                             ? from_fields(fields_of(trimmed(line.substr(1, line.size() - 2))), {0, 1, 2})
                             : std::nullopt;
      return plain ? *plain : from_json(line);
    }
    const std::optional<Vec2> v = from_fields(fields_of(line), columns_);
    if (!v)
      lines_.refuse(DataCode::number, line, columns_[2] == 2 ? kExpected : "a number in each of the columns vx and vy");
    return *v;
  }

  /// Which columns have x and y, and how many there are.
  using Columns = std::array<std::size_t, 3>;

  static std::optional<Vec2> from_fields(const std::vector<std::string_view>& fields, const Columns& columns) {
    if (fields.size() != columns[2]) return std::nullopt;
    const std::optional<double> x = number_in(fields[columns[0]]), y = number_in(fields[columns[1]]);
    if (!x || !y) return std::nullopt;
    return Vec2{*x, *y};
  }

  Vec2 from_json(std::string_view line) const {
    const nlohmann::json read = nlohmann::json::parse(line.begin(), line.end(), nullptr, /*allow_exceptions=*/false);
    if (read.is_discarded()) lines_.refuse(DataCode::json_syntax, line, kExpected);
    const bool is_object = read.is_object();
    if (is_object && !read.contains("velocity")) lines_.refuse(DataCode::format_syntax, line, kExpected);
    const nlohmann::json& pair = is_object ? read.at("velocity") : read;
    const bool is_pair = pair.is_array() && pair.size() == 2 && pair[0].is_number() && pair[1].is_number();
    if (!is_pair) lines_.refuse(DataCode::wrong_type, line, kExpected);
    return {pair[0].get<double>(), pair[1].get<double>()};
  }

  TableLines lines_;
  bool has_begun_ = false;
  Columns columns_{0, 1, 2};
};

/// Whether a - b is a double: Knuth's TwoDiff leaves nothing.
bool is_exact_difference(double a, double b) {
  const double d = a - b, b_of = a - d, a_of = d + b_of;
  return (a - a_of) + (b_of - b) == 0.0;
}

/// One convex shape, prepared for many velocities.
class PreparedCone {
 public:
  explicit PreparedCone(const vo::Encounter& e) : apex_(e.obstacle_velocity), membership_(cone_of(e)) {}

  /// Whether the absolute velocity v collides. Exact, also where v - apex has to be rounded.
  bool contains(Vec2 v) const {
    if (is_exact_difference(v.x, apex_.x) && is_exact_difference(v.y, apex_.y)) return membership_.contains(v - apex_);
    return membership_.obstacle().contains_sum({{v, -apex_}});
  }

 private:
  Vec2 apex_;
  vo::Membership membership_;
};

enum class Answer { free, collides, contact };

class Answers {
 public:
  Answers(const VoQuestion& question, bool json) : question_(question), json_(json) {
    for (std::size_t k = 0; k < question.encounters.size(); ++k) {
      if (cone_of(question.encounters[k]).overlaps()) {
        contact_ = k;
        return;
      }
    }
    for (const vo::Encounter& e : question.encounters) cones_.emplace_back(e);
  }

  void add(std::size_t line, Vec2 v) {
    const auto hit = std::find_if(cones_.begin(), cones_.end(), [&](const PreparedCone& c) { return c.contains(v); });
    const bool is_hit = hit != cones_.end();
    const Answer answer = contact_ ? Answer::contact : is_hit ? Answer::collides : Answer::free;
    const std::size_t with = contact_ ? *contact_ : static_cast<std::size_t>(hit - cones_.begin());
    out_.add((json_ ? json_of(line, v, answer, with) : words_of(v, answer, with)) + "\n");
    throw_if_reader_left();
  }
  void flush() { out_.flush(); }

  /// Where the half-plane is that can be proven then.
  void note_contact() const {
    if (!contact_) return;
    message(
        fmt::format("the robot touches or overlaps obstacle {}: no velocity is free; vo with --velocity instead of "
                    "--velocities shows the half-plane of contact",
                    place_of(question_, *contact_).obstacle));
  }

 private:
  std::string json_of(std::size_t line, Vec2 v, Answer answer, std::size_t with) const {
    constexpr const char* kCollides[] = {"false", "true", "null"};
    const std::string text = fmt::format("{{\"line\": {}, \"velocity\": [{}, {}], \"collides\": {}", line,
                                         unsigned_zero(v.x), unsigned_zero(v.y), kCollides[static_cast<int>(answer)]);
    if (answer == Answer::free) return text + "}";
    const Place place = place_of(question_, with);
    return text + fmt::format(", \"obstacle\": {}, \"cone\": {}}}", place.obstacle, place.cone);
  }

  std::string words_of(Vec2 v, Answer answer, std::size_t with) const {
    constexpr const char* kWords[] = {"free", "collides", "contact"};
    const std::string text =
        fmt::format("{},{} {}", unsigned_zero(v.x), unsigned_zero(v.y), kWords[static_cast<int>(answer)]);
    if (answer == Answer::free || question_.encounters.size() == 1) return text;
    const Place place = place_of(question_, with);
    const bool has_pieces = question_.obstacles[place.obstacle].encounters > 1;
    return text +
           fmt::format(" with obstacle {}{}", place.obstacle, has_pieces ? fmt::format(", piece {}", place.cone) : "");
  }

  const VoQuestion& question_;
  bool json_;
  std::vector<PreparedCone> cones_;     ///< none in contact
  std::optional<std::size_t> contact_;  ///< the first encounter in which the robot touches or overlaps the obstacle
  ChunkedOutput out_;
};

/// Reads the file without an answer, so that a line that is wrong is refused before the first answer.
void check(const std::string& file) {
  VelocityReader velocities(file);
  while (velocities.next()) {
  }
}

/// `file`: two numbers a line, "vx,vy" or "vx vy"; CSV with a first line that names columns `vx` and `vy`; JSON Lines,
/// [vx, vy] or {"velocity": [vx, vy]}. "-" is stdin. Blank lines, and those that begin with #, have no answer. Throws
/// DataError with the line that is wrong: before the first answer if `file` is a regular file, which is read twice;
/// otherwise, as a pipe is answered while it is read, with the number of answers that stand by then.
void answer_velocities(const VoQuestion& question, const std::string& file, bool json) {
  std::error_code no_file;
  if (file != "-" && std::filesystem::is_regular_file(file, no_file)) check(file);
  VelocityReader velocities(file);
  Answers answers(question, json);
  answers.note_contact();
  std::size_t count = 0;
  try {
    for (; const std::optional<Vec2> v = velocities.next(); ++count) answers.add(velocities.number(), *v);
  } catch (const DataError& error) {
    answers.flush();
    throw DataError(error.code(), error.file(), error.place(), error.found(),
                    error.expected() + "; answered before it: " + geometry::counted(count, "velocity", "velocities"));
  } catch (...) {
    answers.flush();
    throw;
  }
  answers.flush();
  if (count == 0)
    throw DataError(DataCode::format_syntax, datasets::name_of_input(file), "", "no velocity", "vx,vy on each line");
}

// --- The verb ---

ExitCode show(const VoFlags& flags) {
  const VoQuestion question = question_of(flags);
  if (!flags.velocities.empty()) {
    answer_velocities(question, flags.velocities, flags.json);
    return ExitCode::success;
  }
  const VoAnswer answer = answer_of(question);
  if (!flags.figure.empty()) write_figure(vo_figure(answer), flags.figure);
  const std::string text = flags.json ? to_json(answer) : in_words(answer);
  print(text);
  return ExitCode::success;
}

}  // namespace

Verb vo_verb() {
  return {"vo", "One velocity obstacle or several: legs, certified half-planes, the family, free velocities",
          "  exactvo vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --enclose ellipse --position 0,0 \\\n"
          "      --velocity 1,0.2 --radius 0.5 --time-horizon 2 --json --figure out/cone.svg\n"
          "  exactvo vo --obstacle 'POLYGON((2 -1, 4 -1, 4 1, 2 1, 2 -1))' --obstacle-velocity=-0.6,0.1 \\\n"
          "      --position 0,0 --velocity 1,0.2 --radius 0.5 --time-horizon 2 --responsibility 0.5 --variant all \\\n"
          "      --figure out/family.svg\n"
          "  exactvo vo --obstacle 'POLYGON((2 -1, 3 -1, 3 1, 2 1, 2 -1))' --free \\\n"
          "      --obstacle 'LINESTRING(-1 2, 0 2)' --max-speed 1.5 --position 0,0 \\\n"
          "      --velocity 1,0.2 --radius 0.5 --time-horizon 2 --figure out/free.svg\n"
          "  printf '1,0.2\\n0,1\\n' | exactvo vo --obstacle 'DISC(4 0, 1)' --velocities - --position 0,0 \\\n"
          "      --radius 0.5 --time-horizon 2\n",
          with_flags(declare_options, show)};
}

}  // namespace exactvo::tools
