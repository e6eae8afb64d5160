// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/vo/question.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <locale>
#include <optional>
#include <string_view>
#include <system_error>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo/geometry/pi.h"
#include "support/fields.h"
#include "support/usage.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

namespace fs = std::filesystem;
using geometry::ConvexShape;
using geometry::Vec2;

namespace {

constexpr const char* kShapeWords = "DISC(x y, r), ELLIPSE(cx cy, l11 l21 l22) or ELLIPSE(cx cy, a b, degrees)";

/// Numbers between blanks, as WKT has them; so large at most that their squares and those of their sums stay far within
/// doubles.
std::optional<std::vector<double>> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char* at = text.c_str();
  for (;;) {
    while (std::isspace(static_cast<unsigned char>(*at))) ++at;
    if (*at == '\0') return numbers;
    char* end = nullptr;
    numbers.push_back(std::strtod(at, &end));
    const bool whole = *end == '\0' || std::isspace(static_cast<unsigned char>(*end));
    if (end == at || !whole || !(std::fabs(numbers.back()) <= datasets::kLargestCoordinate)) return std::nullopt;
    at = end;
  }
}

/// A word before a bracket, and the groups of numbers between commas within; nothing where the text is no such thing.
struct Call {
  std::string word;
  std::vector<std::vector<double>> groups;

  bool has(std::initializer_list<std::size_t> sizes) const {
    return std::equal(groups.begin(), groups.end(), sizes.begin(), sizes.end(),
                      [](const std::vector<double>& group, std::size_t size) { return group.size() == size; });
  }
};

std::string word_before_bracket(const std::string& text) {
  return boost::to_upper_copy(std::string(trimmed(std::string_view(text).substr(0, text.find('(')))),
                              std::locale::classic());
}

Call call_in(const std::string& text) {
  Call call{word_before_bracket(text), {}};
  const std::string whole(trimmed(text));
  if (whole.empty() || whole.back() != ')') return call;
  const auto open = whole.find('(');
  const std::string within = whole.substr(open + 1, whole.size() - open - 2);
  std::vector<std::string> texts;
  for (const std::string& group : boost::split(texts, within, boost::is_any_of(","))) {
    const auto numbers = numbers_in(group);
    if (!numbers) return {call.word, {}};
    call.groups.push_back(*numbers);
  }
  return call;
}

geometry::Ellipse ellipse_by_axes(Vec2 center, double a, double b, double degrees) {
  const double turned = a >= b ? degrees : degrees + 90.0;
  return geometry::ellipse_from_axes(center, {std::max(a, b), std::min(a, b), turned * geometry::kPi / 180.0});
}

std::optional<ConvexShape> shape_of(const Call& call) {
  const auto& g = call.groups;
  if (call.word == "DISC" && call.has({2, 1}) && g[1][0] >= 0.0) return geometry::Disc{{g[0][0], g[0][1]}, g[1][0]};
  if (call.word != "ELLIPSE") return std::nullopt;
  const Vec2 center = g.empty() || g[0].size() != 2 ? Vec2{} : Vec2{g[0][0], g[0][1]};
  if (call.has({2, 3})) return geometry::Ellipse{center, g[1][0], g[1][1], g[1][2]};
  if (call.has({2, 2, 1}) && g[1][0] >= 0.0 && g[1][1] >= 0.0)
    return ellipse_by_axes(center, g[1][0], g[1][1], g[2][0]);
  return std::nullopt;
}

/// What begins WKT; EMPTY and Z, M are the reader's to validate.
bool begins_wkt(const std::string& word) {
  for (const char* known :
       {"POLYGON", "LINESTRING", "POINT", "MULTI", "GEOMETRYCOLLECTION", "TRIANGLE", "LINEARRING", "SRID"})
    if (word.rfind(known, 0) == 0) return true;
  return false;
}

bool ends_in_empty(const std::string& text) {
  const std::string whole = word_before_bracket(text);
  return whole != "EMPTY" && boost::ends_with(whole, "EMPTY");
}

datasets::ObstacleFile read(const std::string& option, const std::string& text, const datasets::ReadOptions& reading) {
  if (is_there(text)) {
    datasets::ObstacleFile file = datasets::read_obstacles(text, reading);
    say_notes(file);
    return file;
  }
  if ((text.find('(') == std::string::npos && !ends_in_empty(text)) || !begins_wkt(word_before_bracket(text)))
    throw UsageError(option, text, std::string("a file that is there, WKT (POLYGON(...), ...), ") + kShapeWords);
  datasets::ObstacleFile file = datasets::parse_wkt(text, option, {});
  say_notes(file);
  return file;
}

}  // namespace

bool is_there(const std::string& text) {
  std::error_code too_long;
  return fs::exists(text, too_long);
}

std::vector<GivenObstacle> obstacles_in(const std::string& option, const std::string& text,
                                        const datasets::ReadOptions& reading) {
  const Call call = text.find('(') == std::string::npos || is_there(text) ? Call{} : call_in(text);
  if (call.word == "DISC" || call.word == "ELLIPSE") {
    const std::optional<ConvexShape> shape = shape_of(call);
    if (!shape) throw UsageError(option, text, std::string(kShapeWords) + ", lengths >= 0 m, within 2^100 m");
    return {*shape};
  }
  std::vector<GivenObstacle> given;
  for (auto& obstacle : read(option, text, reading).obstacles) given.emplace_back(std::move(obstacle.shape));
  if (given.empty())
    throw UsageError(option, text, "a polygon or a line (a point is no obstacle, but DISC(x y, 0) is one)");
  return given;
}

}  // namespace exactvo::tools
