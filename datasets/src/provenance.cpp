// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/provenance.h"

#include <gmp.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <utility>

#include "exactvo/datasets/obstacle_file.h"
#include "exactvo_commit.h"
#include "files/sha256.h"
#include "files/system_error.h"
#include "files/text_file.h"
#include "provenance_json.h"

namespace exactvo::datasets {
namespace {

std::string utc(std::time_t time) {
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  char text[32];
  const std::size_t length = std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text, length};
}

}  // namespace

bool built_with_gdal() {
  return std::string_view(EXACTVO_GDAL_RELEASE) != "none";
}

std::string sha256_of(std::string_view bytes) {
  Sha256 hash;
  hash.add(bytes);
  return hash.digest();
}

std::string sha256_of_file(const std::filesystem::path& path) {
  read_beginning(path, 0);  // refuses what is missing and what is no regular file: a pipe would be waited for
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) throw cannot_read(path, errno);
  Sha256 hash;
  char block[1 << 16];
  for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, file.get())) > 0;) hash.add({block, got});
  if (std::ferror(file.get())) throw cannot_read(path, errno);
  return hash.digest();
}

Provenance make_provenance(std::vector<std::string> command_line, std::uint64_t seed,
                           const std::vector<std::filesystem::path>& inputs) {
  Provenance facts;
  facts.version = EXACTVO_VERSION;
  facts.commit = EXACTVO_COMMIT;
  facts.compiler = EXACTVO_COMPILER;
  facts.build_type = EXACTVO_BUILD_TYPE;
  facts.cgal = EXACTVO_CGAL_VERSION;
  facts.gmp = std::to_string(__GNU_MP_VERSION) + "." + std::to_string(__GNU_MP_VERSION_MINOR) + "." +
              std::to_string(__GNU_MP_VERSION_PATCHLEVEL);
  facts.gdal = EXACTVO_GDAL_RELEASE;  // known without loading GDAL
  facts.seed = seed;
  facts.command_line = std::move(command_line);
  for (const std::filesystem::path& input : inputs) {
    // What came through a pipe can't be read again.
    facts.inputs.push_back({input.string(), is_pipe(input) ? std::string() : sha256_of_file(input)});
  }
  const char* fixed = std::getenv("SOURCE_DATE_EPOCH");  // where a reproducible output is wanted
  facts.written_at = utc(fixed != nullptr && *fixed != '\0' ? std::strtoll(fixed, nullptr, 10) : std::time(nullptr));
  return facts;
}

std::string to_json(const Provenance& provenance) {
  JsonWriter json(JsonWriter::Layout::compact);
  append_value(json, provenance);
  return json.take();
}

Provenance parse_provenance(const std::string& json, const std::string& file_name) {
  const Json tree = parse_json(json, file_name);
  Provenance facts;
  read_value(JsonCursor(tree, file_name, ""), facts);
  return facts;
}

}  // namespace exactvo::datasets
