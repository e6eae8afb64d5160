// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "recordings/crowd_recording_format.h"

namespace exactvo::datasets {
namespace {

constexpr std::int64_t kFarthestBody = std::int64_t{1} << 52;

}  // namespace

struct CrowdRecordingReader::Parts {
  std::string name;
  std::ifstream in;
  CrowdRecordingHead head;
  std::vector<std::int32_t> x, y;
  std::vector<std::int64_t> body_x, body_y;
  std::string block;
  std::uint64_t at = 0, block_at = 0;  ///< bytes read, and before the block
  std::uint64_t rows = 0, sum = 0;     ///< of the blocks read
  bool cut_off = false, ended = false;

  /// False where the file ends before.
  bool read(char* to, std::size_t size) {
    in.read(to, static_cast<std::streamsize>(size));
    at += static_cast<std::uint64_t>(in.gcount());
    return static_cast<std::size_t>(in.gcount()) == size;
  }

  /// A block behind its size and checksum. In pieces: a size that was changed asks for no more memory than there is.
  bool read_block() {
    constexpr std::uint64_t kAtOnce = 1U << 20U;
    std::uint64_t size = 0, stated = 0;
    block.clear();
    block_at = at;
    if (!read(reinterpret_cast<char*>(&size), sizeof size) || !read(reinterpret_cast<char*>(&stated), sizeof stated))
      return false;
    block_at = at;
    while (block.size() < size) {
      const std::size_t had = block.size();
      block.resize(had + static_cast<std::size_t>(std::min(kAtOnce, size - had)));
      if (!read(block.data() + had, block.size() - had)) return false;
    }
    if (checksum(block) != stated) bytes().refuse("another checksum than its content has");
    return true;
  }
  /// Behind the last row. REQUIRES: its block was read.
  void check_end() {
    CrowdBytes seal = bytes();
    const auto all_rows = seal.get<std::uint64_t>(), all_sum = seal.get<std::uint64_t>();
    seal.require_end();
    if (all_rows != rows || all_sum != sum) bytes().refuse("an end of other rows than these");
    if (in.peek() != std::ifstream::traits_type::eof()) bytes().refuse("bytes after the end");
  }
  CrowdBytes bytes() const { return {block, name, block_at}; }
};

CrowdRecordingReader::CrowdRecordingReader(const std::filesystem::path& path) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error))
    throw DataError(DataCode::file_missing, p.name, "", "no such file", "a recording of a crowd");
  p.in.open(path, std::ios::binary);
  if (!p.in)
    throw DataError(DataCode::file_unreadable, p.name, "", "a file that cannot be read", "a recording of a crowd");
  char mark[kCrowdMark.size()] = {};
  const bool whole = p.read(mark, sizeof mark), has_bodies = std::string_view(mark, sizeof mark) == kCrowdMarkOfBodies;
  if (!whole || (!has_bodies && std::string_view(mark, sizeof mark) != kCrowdMark))
    throw DataError(DataCode::format_syntax, p.name, "byte 0", "another beginning",
                    "\"EXACTVR1\" or \"EXACTVR2\", of a recording of a crowd");
  if (!p.read_block()) p.bytes().refuse("its end within the head");
  p.head = to_head(p.bytes(), has_bodies);
  p.sum = checksum(p.block);
  p.x.assign(p.head.kind_of.size(), 0);
  p.y = p.x;
  p.body_x.assign(p.head.bodies.size(), 0);
  p.body_y = p.body_x;
}

CrowdRecordingReader::~CrowdRecordingReader() = default;

const CrowdRecordingHead& CrowdRecordingReader::head() const {
  return parts_->head;
}

bool CrowdRecordingReader::is_cut_off() const {
  return parts_->cut_off;
}

bool CrowdRecordingReader::next(CrowdRow& row) {
  Parts& p = *parts_;
  if (p.ended) return false;
  char tag = 0;
  if (!p.read(&tag, 1) || ((tag == kCrowdRow || tag == kCrowdEnd) && !p.read_block())) {
    p.cut_off = p.ended = true;
    return false;
  }
  if (tag == kCrowdEnd) {
    p.check_end();
    p.ended = true;
    return false;
  }
  if (tag != kCrowdRow) p.bytes().refuse("what begins neither a row nor the end");
  CrowdBytes in = p.bytes();
  row.step = in.get<std::uint32_t>();
  for (std::vector<std::int32_t>* column : {&p.x, &p.y})
    for (std::int32_t& value : *column) {
      const std::int64_t next = value + in.difference();
      in.require(std::abs(next) <= std::int64_t{1} << 30, "a position beyond the lattice");
      value = static_cast<std::int32_t>(next);
    }
  for (std::vector<std::int64_t>* column : {&p.body_x, &p.body_y})
    for (std::int64_t& value : *column) {
      const std::int64_t difference = in.difference();
      in.require(std::abs(difference) <= kFarthestBody && std::abs(value + difference) <= kFarthestBody,
                 "a body beyond the lattice");
      value += difference;
    }
  row.x = p.x;
  row.y = p.y;
  row.body_x = p.body_x;
  row.body_y = p.body_y;
  row.kept.resize(p.x.size());
  for (std::size_t first = 0; first < row.kept.size(); first += 8) {
    const auto bits = in.get<std::uint8_t>();
    for (std::size_t k = first; k < std::min(first + 8, row.kept.size()); ++k) row.kept[k] = bits >> (k - first) & 1U;
  }
  in.require_end();
  p.sum = chained(p.sum, checksum(p.block));
  ++p.rows;
  return true;
}

bool begins_crowd_recording(std::string_view bytes) {
  return bytes.substr(0, kCrowdMark.size()) == kCrowdMark || bytes.substr(0, kCrowdMark.size()) == kCrowdMarkOfBodies;
}

CrowdTable write_crowd_csv(const std::filesystem::path& from, AtomicFile& to) {
  CrowdRecordingReader reader(from);
  const CrowdRecordingHead& head = reader.head();
  to.write("step,time,robot,x,y,kept\n");
  CrowdRow row;
  CrowdTable table;
  for (; reader.next(row); ++table.rows) {
    char line[160];
    for (std::size_t i = 0; i < row.x.size(); ++i) {
      const int size =
          std::snprintf(line, sizeof line, "%u,%.17g,%zu,%.17g,%.17g,%u\n", row.step, row.step * head.time_step, i,
                        head.position_step * row.x[i], head.position_step * row.y[i], unsigned{row.kept[i]});
      to.write({line, static_cast<std::size_t>(size)});
    }
  }
  table.cut_off = reader.is_cut_off();
  return table;
}

}  // namespace exactvo::datasets
