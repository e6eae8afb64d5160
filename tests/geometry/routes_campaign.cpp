// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of routes by the hundred thousand, run by hand:
//
//     routes_campaign verdicts 100000 1     answers at critical radii: each the right one, and accepted by the checker
//     routes_campaign mutations 100000 1    certificates with one thing changed: refused, or still true by the verdict
//                                           of route_verdict.h
#include "routes_campaign.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <map>
#include <string>

#include "options/program_options.h"
#include "route_mutations.h"
#include "route_verdict.h"

namespace {

using namespace exactvo::test;
using exactvo::geometry::RouteAnswer;
using exactvo::geometry::RouteMap;
using exactvo::geometry::RoutePlan;

struct Flags {
  std::string kind;
  std::size_t count = 10000;
  std::uint64_t seed = 1;
};

void print_failures(const std::vector<std::string>& failures) {
  for (const std::string& failure : failures) std::printf("%s\n", failure.c_str());
}

RouteField next_field(SeededRandom& random, std::size_t number) {
  return route_field(random, kFieldKinds[number % std::size(kFieldKinds)]);
}

int run_verdicts(const Flags& flags) {
  SeededRandom random(flags.seed);
  RouteCampaign campaign;
  std::size_t worlds = 0;
  while (campaign.cases < flags.count) check_field(next_field(random, worlds++), random, campaign);
  print_failures(campaign.failures);
  std::printf("longest for its bound: %s\n", campaign.worst.c_str());
  std::printf(
      "seed %llu: %zu cases in %zu worlds: %zu routes, %zu chains, %zu blocked; length over lower bound %.4f in the "
      "mean, %.4f at most; %zu without a route that could be proven, %zu failures\n",
      static_cast<unsigned long long>(flags.seed), campaign.cases, worlds, campaign.routes, campaign.chains,
      campaign.blocked, campaign.sum_of_ratios / std::max<double>(1.0, static_cast<double>(campaign.routes)),
      campaign.worst_ratio, campaign.unproven, campaign.failures.size());
  return campaign.failures.empty() ? 0 : 1;
}

struct Tally {
  std::size_t refused = 0, still_true = 0;
};

/// Mutants of one kind of answer after another, and what became of them.
class Mutations {
 public:
  Mutations(std::size_t count, std::uint64_t seed) : left_(count), random_(seed) {}

  void run() {
    for (std::size_t k = 0; left_ > 0; ++k) {
      RouteField f = next_field(random_, k);
      const RouteMap map(f.obstacles);
      if (random_.integer(0, 3)) choose_ends_apart(f, map, random_);
      const double widest = map.widest_radius(f.start, f.goal);
      for (const double radius : {widest, std::nextafter(widest, kLargestRadius), widest * random_.uniform(0.2, 1.0),
                                  widest + random_.uniform(0.0, 1.0), 0.0})
        if (radius == 0.0 || radius >= kLeastRadius) mutate_answer(f, map, radius);
    }
  }

  std::map<std::string, Tally> by_change;
  std::vector<std::string> failures;
  std::size_t certificates = 0;

 private:
  static constexpr double kLeastRadius = 0x1p-100;       // m, of plans
  static constexpr std::size_t kOfEach[] = {30, 60, 5};  // mutants of one route, chain, block

  void mutate_answer(const RouteField& f, const RouteMap& map, double radius) {
    static const char* const kKinds[] = {"route", "chain", "block"};
    Certificate original{{radius, f.start, f.goal}, {}};
    try {
      original.answer = RoutePlan(map, radius).query(f.start, f.goal);
    } catch (const exactvo::geometry::RouteNotProven& e) {
      failures.push_back(e.what() + ("\n" + corpus_line({f, radius})));
      return;
    }
    ++certificates;
    const std::string wrong = check(f.obstacles, original.question, original.answer);
    if (!wrong.empty() || verdict_on(f.obstacles, original.question, original.answer) == RouteVerdict::wrong)
      failures.push_back("an answer refused: " + wrong + "\n" + corpus_line({f, radius}));
    for (std::size_t k = 0; k < kOfEach[original.answer.index()] && left_ > 0; ++k, --left_) {
      const Mutant mutant = mutated(f.obstacles, original, random_);
      const std::string kind = kKinds[original.answer.index()];
      check_mutant(f, map, mutant, by_change[kind + ", " + mutant.change]);
    }
  }

  void check_mutant(const RouteField& f, const RouteMap& map, const Mutant& mutant, Tally& tally) {
    const auto& [question, answer] = mutant.certificate;
    const std::string wrong = check(f.obstacles, question, answer);
    const RouteVerdict verdict = verdict_on(f.obstacles, question, answer);
    const auto fail = [&](const std::string& why) {
      failures.push_back(why + " (" + mutant.change + "): " + to_string(mutant.certificate) + "\n" +
                         corpus_line({f, question.radius}));
    };
    if (wrong.empty() && verdict == RouteVerdict::wrong) fail("accepted, and wrong");
    if (!wrong.empty() && verdict == RouteVerdict::proven) fail("refused as '" + wrong + "', and true");
    ++(wrong.empty() ? tally.still_true : tally.refused);
    // What is accepted must be the answer that the map gives too.
    if (!wrong.empty() || !map.covers(question.start) || !map.covers(question.goal)) return;
    if (question.radius != 0.0 && question.radius < kLeastRadius) return;
    const double widest = map.widest_radius(question.start, question.goal);
    const bool has_route = question.radius > 0.0 ? question.radius <= widest : widest > 0.0;
    if (std::holds_alternative<exactvo::geometry::Route>(answer) != has_route) fail("accepted against the map");
  }

  std::size_t left_;
  SeededRandom random_;
};

int run_mutations(const Flags& flags) {
  Mutations mutations(flags.count, flags.seed);
  mutations.run();
  print_failures(mutations.failures);
  Tally all;
  for (const auto& [change, tally] : mutations.by_change) {
    std::printf("%-28s %7zu refused %6zu still true\n", change.c_str(), tally.refused, tally.still_true);
    all.refused += tally.refused;
    all.still_true += tally.still_true;
  }
  std::printf("seed %llu: %zu mutants of %zu certificates: %zu refused, %zu still true; %zu failures\n",
              static_cast<unsigned long long>(flags.seed), all.refused + all.still_true, mutations.certificates,
              all.refused, all.still_true, mutations.failures.size());
  return mutations.failures.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  using exactvo::tools::ProgramOptions;
  return exactvo::tools::run_program("routes_campaign", [&] {
    Flags flags;
    ProgramOptions options("routes_campaign", "Are answers about routes right, and certificates checked rightly?",
                           "Exit status 1: an answer or a verdict was wrong; it is printed as a line of the corpus.");
    options.word("KIND", flags.kind, {"verdicts", "mutations"},
                 "Answers at critical radii, or certificates with one thing changed", true);
    options.whole_number("COUNT", flags.count, 1, "Answers or changed certificates, at least");
    options.whole_number("SEED", flags.seed, 0, "Of worlds and changes");
    if (!options.parse(argc, argv)) return 0;
    return flags.kind == "verdicts" ? run_verdicts(flags) : run_mutations(flags);
  });
}
