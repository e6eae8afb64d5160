// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The bytes of a recording of a crowd (docs/guide/crowd-recordings.md): a mark, the head, rows, the end, each a block
/// behind its size and checksum. crowd_recording_write.cpp writes them, crowd_recording_read.cpp reads them.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "exactvo/datasets/crowd_recording.h"

namespace exactvo::datasets {

/// EXACTVR1 has no bodies, EXACTVR2 no ids, EXACTVR4 wheels, EXACTVR5 also the tracking error, the radii of robots'
/// bodies and the ids of obstacles. EXACTVR1 and EXACTVR4 are read, and no longer written.
inline constexpr std::string_view kCrowdMarks[] = {"EXACTVR1", "EXACTVR2", "EXACTVR3", "EXACTVR4", "EXACTVR5"};
inline constexpr std::size_t kCrowdMarkSize = kCrowdMarks[0].size();

/// The version that a mark is of, from 1; 0 where it is none.
unsigned crowd_version(std::string_view mark);

inline constexpr char kCrowdRow = 'R', kCrowdEnd = 'E';

std::uint64_t checksum(std::string_view bytes);

/// The checksum of all blocks so far and of one more.
std::uint64_t chained(std::uint64_t sum, std::uint64_t next);

template <class T>
void append(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

/// Zigzag, seven bits a byte, the lowest first.
void append_difference(std::string& to, std::int64_t difference);

/// Bytes of a row or head that has been checked.
class CrowdBytes {
 public:
  CrowdBytes(std::string_view left, const std::string& file, std::uint64_t at) : left_(left), file_(file), at_(at) {}

  template <class T>
  T get() {
    need(sizeof(T));
    T value{};
    std::memcpy(&value, left_.data(), sizeof value);
    skip(sizeof value);
    return value;
  }
  /// A finite number of which `factor` times as much is no more than kLargestCoordinate.
  double number(const char* what, double factor = 1.0) {
    const auto value = get<double>();
    if (!std::isfinite(value)) refuse(std::string(what) + " that is not finite");
    require_in_range(value, factor, what);
    return value;
  }
  std::string text(std::size_t size) {
    need(size);
    std::string out(left_.substr(0, size));
    skip(size);
    return out;
  }
  /// As `append_difference` writes it.
  std::int64_t difference() {
    std::uint64_t value = 0;
    for (unsigned shift = 0;; shift += 7) {
      const auto byte = get<std::uint8_t>();
      if (shift >= 63) refuse("a number of more than nine bytes");
      value |= std::uint64_t{byte & 0x7FU} << shift;
      if (byte < 0x80) break;
    }
    return static_cast<std::int64_t>(value >> 1U) ^ -static_cast<std::int64_t>(value & 1U);
  }
  void require_end() const {
    if (!left_.empty()) refuse("more bytes than it needs");
  }
  void require(bool holds, const char* found) const {
    if (!holds) refuse(found);
  }
  /// E_RANGE where `value` times `factor` is beyond kLargestCoordinate.
  void require_in_range(double value, double factor, const char* what) const;
  [[noreturn]] void refuse(const std::string& found) const;

 private:
  void need(std::size_t size) const {
    if (left_.size() < size) refuse("its end too early");
  }
  void skip(std::size_t size) {
    left_.remove_prefix(size);
    at_ += size;
  }

  std::string_view left_;
  const std::string& file_;
  std::uint64_t at_;
};

/// Appends a robot's id behind another's, as how many bytes it shares with that from the beginning, and the rest: few
/// bytes where ids have a prefix and a number.
void append_id(std::string& to, std::string_view id, std::string_view before);

/// The version of a head: 5 with obstacles, wheels or a tracking error, else 3 or, without ids, 2.
unsigned version_of(const CrowdRecordingHead& head, bool has_ids);

/// `ids`: those of all robots, as `append_id` writes them, or none; head.ids is not looked at.
std::string to_bytes(const CrowdRecordingHead& head, std::string_view ids);

/// Throws DataError where it is not as `to_bytes` writes it, or did in an earlier version (E_FORMAT_SYNTAX), or has
/// numbers beyond kLargestCoordinate (E_RANGE).
CrowdRecordingHead to_head(CrowdBytes in, unsigned version);

}  // namespace exactvo::datasets
