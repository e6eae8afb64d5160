// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/plan/input_record.h"

#include <cerrno>
#include <fstream>

#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

/// An input's file, past the line of its facts.
class RecordFile {
 public:
  RecordFile(const Journal& journal, std::size_t input)
      : path_(journal.input_facts(input)), file_(path_, std::ios::binary) {
    if (!file_) throw cannot_read(path_, errno);
    std::getline(file_, line_);
    is_whole_line_ = !file_.eof();
  }

  const fs::path& path() const { return path_; }
  InputFacts facts() const {
    const std::string file = path_.string();
    const Json json = parse_json(line_, file);
    InputFacts facts;
    read_value(JsonCursor(json, file, ""), facts);
    return facts;
  }
  bool is_whole_line() const { return is_whole_line_; }
  /// What follows the line.
  std::istream& rest() { return file_; }
  bool has_part() { return file_.peek() != std::istream::traits_type::eof(); }

 private:
  fs::path path_;
  std::ifstream file_;
  std::string line_;
  bool is_whole_line_ = false;
};

}  // namespace

std::string to_json(const InputFacts& facts) {
  JsonWriter json(JsonWriter::Layout::compact);
  append_value(json, facts);
  return json.take();
}

InputFacts read_facts(const Journal& journal, std::size_t input) {
  return RecordFile(journal, input).facts();
}

bool is_part_there(const Journal& journal, std::size_t input, std::size_t chunk) {
  std::ifstream file(journal.part(input, chunk), std::ios::binary);
  return file && holds_whole_part(file);
}

std::string read_part_bytes(const Journal& journal, std::size_t input, std::size_t chunk) {
  const fs::path path = journal.part(input, chunk);
  if (journal.is_there(path)) return read_text_file(path);
  std::string bytes = read_text_file(journal.input_facts(input));
  bytes.erase(0, bytes.find('\n') + 1);
  return bytes;
}

std::string read_pictures(const Journal& journal, std::size_t input) {
  const fs::path path = journal.part(input, 0);
  if (journal.is_there(path)) {
    std::ifstream file(path, std::ios::binary);
    return pictures_at_start(file, path);
  }
  RecordFile record(journal, input);
  return pictures_at_start(record.rest(), record.path());
}

bool is_through(const Journal& journal, std::size_t input) {
  if (!journal.is_there(journal.input_facts(input))) return false;
  RecordFile record(journal, input);
  if (!record.is_whole_line()) return false;
  if (record.has_part()) return holds_whole_part(record.rest());
  const InputFacts facts = record.facts();
  for (std::size_t chunk = 0; chunk < facts.chunks; ++chunk) {
    if (!is_part_there(journal, input, chunk)) return false;
  }
  return true;
}

}  // namespace exactvo::datasets::batch
