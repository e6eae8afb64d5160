// SPDX-License-Identifier: GPL-3.0-or-later
// Random edits of recordings, each audited and held beside a second opinion: `audit_edits 100000`.
#include <cstdio>

#include "audit/verdicts.h"
#include "options/program_options.h"

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("audit_edits", [&] {
    std::size_t count = 100000, first = 0;
    std::uint64_t seed = 1;
    tools::ProgramOptions options("audit_edits", "Does the audit reject every edit of a recording that is not true?",
                                  "Prints a table of fields and verdicts, and of each edit that wrongly passed a line "
                                  "for tests/corpus/audit/edits.jsonl. Exit status 1: there was one.");
    options.whole_number("COUNT", count, 1, "Edits");
    options.whole_number("SEED", seed, 0, "Of the edits");
    options.whole_number("FIRST", first, 0, "The number of the first edit");
    if (!options.parse(argc, argv)) return 0;
    datasets::test::Campaign campaign;
    campaign.run(datasets::test::short_runs(), seed, first, count);
    std::fputs(campaign.table().c_str(), stdout);
    for (const std::string& line : campaign.wrong) std::printf("%s\n", line.c_str());
    return campaign.wrong.empty() ? 0 : 1;
  });
}
