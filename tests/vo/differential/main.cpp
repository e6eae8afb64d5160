// SPDX-License-Identifier: GPL-3.0-or-later
// differential_cgal [TOPIC|all] [RANDOM] [CONSTRUCTED] [SEED]: compares the library with CGAL's exact parts.
// The whole numbers: differential_cgal all 100000 10000. Exit status 1 where anything differs.
#include <ctime>
#include <string>
#include <vector>

#include "options/program_options.h"
#include "vo/differential/tally.h"

namespace exactvo::test {
namespace {

struct Topic {
  const char* name;
  Tally (*compare)(const Asked&);
};
constexpr Topic kTopics[] = {{"distances", compare_distances}, {"offsets", compare_offsets},
                             {"conics", compare_conics},       {"legs", compare_legs},
                             {"ellipses", compare_ellipses},   {"sums", compare_sums}};

int run(const std::string& wanted, const Asked& asked) {
  bool same = true;
  for (const Topic& topic : kTopics) {
    if (wanted != "all" && wanted != topic.name) continue;
    const std::clock_t start = std::clock();
    const Tally tally = topic.compare(asked);
    std::printf("%-9s  random %ld  constructed %ld  contacts %ld  given up %ld  mismatches %ld  (%.1f s)\n", topic.name,
                tally.random_cases(), tally.constructed_cases(), tally.contacts(), tally.given_up(), tally.mismatches(),
                static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    std::fflush(stdout);
    same = same && tally.mismatches() == 0;
  }
  return same ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::test

int main(int argc, char** argv) {
  using namespace exactvo;
  return tools::run_program("differential_cgal", [&] {
    std::string topic = "all";
    test::Asked asked{100000, 10000, 1};
    std::vector<std::string> topics = {"all"};
    for (const test::Topic& known : test::kTopics) topics.emplace_back(known.name);
    tools::ProgramOptions options("differential_cgal", "Compares the library with CGAL's exact parts.",
                                  "Exit status 1: something differs.");
    options.word("TOPIC", topic, topics, "all, or one of distances offsets conics legs ellipses sums");
    options.whole_number("RANDOM", asked.random, 0, "Random cases per topic");
    options.whole_number("CONSTRUCTED", asked.constructed, 0, "Constructed cases per topic");
    options.whole_number("SEED", asked.seed, 0, "Of both");
    return options.parse(argc, argv) ? test::run(topic, asked) : 0;
  });
}
