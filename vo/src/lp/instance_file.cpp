// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <cstring>
#include <istream>

#include "exactvo/geometry/told_apart.h"
#include "exactvo/vo/lp/instances.h"

namespace exactvo::lp {
namespace {

/// No instance of a million lines is worth a file of this format; a larger count is a broken file, not a reservation.
constexpr std::int32_t kMostLines = 1 << 20;

std::uint32_t little_endian(const unsigned char* bytes) {
  return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8 |
         static_cast<std::uint32_t>(bytes[2]) << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

class Reader {
 public:
  explicit Reader(std::istream& in) : in_(in) {}

  std::int32_t integer(const char* what) { return static_cast<std::int32_t>(word(what)); }

  double number(const char* what) {
    const std::uint32_t bits = word(what);
    float value = 0.0F;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) throw InstanceError(place(what), std::to_string(value), "a finite number");
    return static_cast<double>(value);
  }

  std::int32_t integer_within(const char* what, std::int32_t low, std::int32_t high) {
    const std::int32_t value = integer(what);
    if (value < low || value > high)
      throw InstanceError(place(what), std::to_string(value), std::to_string(low) + " to " + std::to_string(high));
    return value;
  }

  /// The last word belongs to the last instance.
  void need_end() {
    if (in_.peek() == std::istream::traits_type::eof()) return;
    throw InstanceError("byte " + std::to_string(offset_) + ", after the last instance", "more bytes",
                        "the end of the file, as the count says");
  }

  std::string place(const char* what) const {
    return "byte " + std::to_string(offset_ < 4 ? 0 : offset_ - 4) + ", " + what;
  }

 private:
  std::uint32_t word(const char* what) {
    unsigned char bytes[4];
    in_.read(reinterpret_cast<char*>(bytes), 4);
    if (in_.gcount() != 4)
      throw InstanceError("byte " + std::to_string(offset_) + ", " + what, "the end of the file", "four more bytes");
    offset_ += 4;
    return little_endian(bytes);
  }

  std::istream& in_;
  std::size_t offset_ = 0;
};

Constraint read_line(Reader& reader, Priority priority) {
  const double px = reader.number("point x"), py = reader.number("point y");
  const double dx = reader.number("direction x"), dy = reader.number("direction y");
  if (dx == 0.0 && dy == 0.0) throw InstanceError(reader.place("direction"), "(0, 0)", "a direction");
  const Vec2 normal = {-dy, dx};
  return {{normal, dot(normal, {px, py})}, priority, -1};
}

Problem read_instance(Reader& reader) {
  Problem problem;
  const std::int32_t m = reader.integer_within("m", 0, kMostLines);
  const std::int32_t hard = reader.integer_within("m_hard", 0, m);
  problem.bound.disc = reader.number("v_max");
  if (problem.bound.disc < 0.0)
    throw InstanceError(reader.place("v_max"), geometry::lossless(problem.bound.disc), "0 or more");
  problem.preferred.x = reader.number("v_pref x");
  problem.preferred.y = reader.number("v_pref y");
  for (std::int32_t k = 0; k < m; ++k)
    problem.constraints.push_back(read_line(reader, k < hard ? Priority::hard : Priority::soft));
  return problem;
}

}  // namespace

InstanceError::InstanceError(std::string where, std::string what_was_found, std::string what_was_expected)
    : std::runtime_error(where + ": found " + what_was_found + ", expected " + what_was_expected),
      place(std::move(where)),
      found(std::move(what_was_found)),
      expected(std::move(what_was_expected)) {}

std::vector<Problem> read_instances(std::istream& in) {
  Reader reader(in);
  const std::int32_t count = reader.integer("count");
  if (count < 0) throw InstanceError("byte 0, count", std::to_string(count), "0 or more");
  std::vector<Problem> problems;
  for (std::int32_t k = 0; k < count; ++k) problems.push_back(read_instance(reader));
  reader.need_end();
  return problems;
}

}  // namespace exactvo::lp
