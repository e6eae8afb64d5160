// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo validate: every problem of obstacle files, with its place, code and coordinates.
#include <fmt/format.h>

#include "support/terminal.h"
#include "verb.h"
#include "verbs/obstacles/obstacle_files.h"

namespace exactvo::tools {

namespace {

struct ValidateFlags {
  std::vector<std::string> files;
  ReadingFlags reading;
  bool json = false;
  bool strict = false;
};

std::string to_json(const std::vector<FileAnswer>& answers, bool strict) {
  OrderedJson files = OrderedJson::array();
  for (const FileAnswer& answer : answers) files.push_back(json_of(answer));
  return text_of({{"valid", exit_code(answers, strict) == ExitCode::success}, {"files", files}});
}

ExitCode validate(const ValidateFlags& flags) {
  const std::vector<FileAnswer> answers = read_each(flags.files, reading_options(flags.reading));
  if (flags.json) {
    print(to_json(answers, flags.strict));
  } else {
    for (const FileAnswer& answer : answers) {
      print(lines_of(answer));
      if (answer.content) message(counts_line(answer, "would be repaired"));
      if (const std::string hint = repair_hint(answer); !hint.empty()) message(hint);
    }
  }
  return exit_code(answers, flags.strict);
}

void declare_validate(CLI::App& app, ValidateFlags& flags) {
  app.add_option("files", flags.files, "Obstacle files of any readable format")->required();
  declare_reading_flags(app, flags.reading);
  app.add_flag("--json", flags.json, "Everything as JSON on stdout");
  app.add_flag("--strict", flags.strict,
               "Status 1 also for problems that every verb repairs as it reads: winding, closure, repeated vertices");
}

}  // namespace

Verb validate_verb() {
  return {"validate", "List every problem of obstacle files with place, code and coordinates",
          "  exactvo validate buildings.geojson walls.wkt\n"
          "  exactvo validate --json --strict maps/*.yaml\n"
          "    (status 0: every obstacle can be used; 1: some cannot; 2: a file cannot be read. Codes: "
          "docs/guide/codes.md)\n",
          with_flags(declare_validate, validate)};
}

}  // namespace exactvo::tools
