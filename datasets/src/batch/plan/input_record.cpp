// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/plan/input_record.h"

#include <cerrno>
#include <fstream>

#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

void append_optional_facts(JsonWriter& json, const InputFacts& facts) {
  if (facts.origin) {
    json.key("origin").begin_object().member("longitude", facts.origin->longitude);
    json.member("latitude", facts.origin->latitude).end_object();
  }
  if (facts.extent) {
    json.key("extent").begin_object().member("low", facts.extent->low).member("high", facts.extent->high).end_object();
  }
  if (facts.coverage) {
    const Coverage& c = *facts.coverage;
    json.key("coverage").begin_object().member("cells", std::uint64_t{c.cells});
    json.member("occupied", std::uint64_t{c.occupied}).member("cell_area", c.cell_area).end_object();
  }
  if (facts.distortion) {
    json.key("distortion").begin_object().member("length", facts.distortion->length);
    json.member("area", facts.distortion->area).member("certified", facts.distortion->certified).end_object();
  }
}

void parse_optional_facts(const Json& json, InputFacts& facts) {
  if (const auto at = json.find("origin"); at != json.end()) {
    facts.origin = ProjectionOrigin{at->at("longitude").get<double>(), at->at("latitude").get<double>()};
  }
  if (const auto at = json.find("extent"); at != json.end()) {
    facts.extent = Extent{at->at("low").get<geometry::Vec2>(), at->at("high").get<geometry::Vec2>()};
  }
  if (const auto at = json.find("coverage"); at != json.end()) {
    facts.coverage = Coverage{at->at("cells").get<std::size_t>(), at->at("occupied").get<std::size_t>(),
                              at->at("cell_area").get<double>()};
  }
  if (const auto at = json.find("distortion"); at != json.end()) {
    facts.distortion =
        Distortion{at->at("length").get<double>(), at->at("area").get<double>(), at->at("certified").get<bool>()};
  }
}

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
  const std::string& line() const { return line_; }
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

void append_tally(JsonWriter& json, const BatchTally& tally) {
  json.member("read", tally.read).member("done", tally.done).member("repaired", tally.repaired);
  json.key("rejected").begin_object();
  for (const auto& [code, count] : tally.rejected) json.member(code, count);
  json.end_object();
}

BatchTally tally_of(const Json& object) {
  BatchTally tally;
  object.at("read").get_to(tally.read);
  object.at("done").get_to(tally.done);
  object.at("repaired").get_to(tally.repaired);
  for (const auto& [code, count] : object.at("rejected").items()) tally.rejected[code] = count.get<std::uint64_t>();
  return tally;
}

std::string to_json(const InputFacts& facts) {
  JsonWriter json(JsonWriter::Layout::compact);
  json.begin_object().member("outcome", facts.outcome);
  if (!facts.code.empty()) json.member("code", facts.code).member("message", facts.message);
  if (!facts.format.empty()) json.member("format", facts.format);
  append_tally(json, facts.tally);
  json.member("passed_over", facts.passed_over).member("chunks", facts.chunks);
  append_optional_facts(json, facts);
  json.key("notes").begin_array();
  for (const std::string& note : facts.notes) json.value(note);
  return json.end_array().end_object().take();
}

InputFacts parse_facts(std::string_view text, const std::string& file) {
  const Json json = parse_json(text, file);
  InputFacts facts;
  try {
    json.at("outcome").get_to(facts.outcome);
    facts.code = json.value("code", "");
    facts.message = json.value("message", "");
    facts.format = json.value("format", "");
    facts.tally = tally_of(json);
    json.at("passed_over").get_to(facts.passed_over);
    json.at("chunks").get_to(facts.chunks);
    parse_optional_facts(json, facts);
    json.at("notes").get_to(facts.notes);
  } catch (const nlohmann::detail::exception& error) {
    throw DataError(DataCode::wrong_type, file, "", error.what(), "facts of an input as a batch writes them");
  }
  return facts;
}

InputFacts read_facts(const Journal& journal, std::size_t input) {
  const RecordFile record(journal, input);
  return parse_facts(record.line(), record.path().string());
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
  const InputFacts facts = parse_facts(record.line(), record.path().string());
  for (std::size_t chunk = 0; chunk < facts.chunks; ++chunk) {
    if (!is_part_there(journal, input, chunk)) return false;
  }
  return true;
}

}  // namespace exactvo::datasets::batch
