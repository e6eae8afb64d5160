// SPDX-License-Identifier: GPL-3.0-or-later
// differential_cgal [TOPIC|all] [RANDOM] [CONSTRUCTED] [SEED]: compares the library with CGAL's exact parts.
// The whole numbers: differential_cgal all 100000 10000. Exit status 1 where anything differs.
#include <cstdlib>
#include <cstring>
#include <ctime>

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

int run(const char* wanted, const Asked& asked) {
  bool known = false, same = true;
  for (const Topic& topic : kTopics) {
    if (std::strcmp(wanted, "all") != 0 && std::strcmp(wanted, topic.name) != 0) continue;
    known = true;
    const std::clock_t start = std::clock();
    const Tally tally = topic.compare(asked);
    std::printf("%-9s  random %ld  constructed %ld  contacts %ld  given up %ld  mismatches %ld  (%.1f s)\n", topic.name,
                tally.random_cases(), tally.constructed_cases(), tally.contacts(), tally.given_up(), tally.mismatches(),
                static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    std::fflush(stdout);
    same = same && tally.mismatches() == 0;
  }
  if (!known) std::fprintf(stderr, "topics: all distances offsets conics legs ellipses sums\n");
  return known && same ? 0 : 1;
}

}  // namespace
}  // namespace exactvo::test

int main(int argc, char** argv) {
  const auto number = [&](int k, long fallback) { return argc > k ? std::atol(argv[k]) : fallback; };
  return exactvo::test::run(argc > 1 ? argv[1] : "all",
                            {number(2, 100000), number(3, 10000), static_cast<std::uint64_t>(number(4, 1))});
}
