// SPDX-License-Identifier: GPL-3.0-or-later
// routes_campaign WORLDS SEED: routes at critical radii, as many worlds as asked for; exit status 1 where one fails.
#include "routes_campaign.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>

int main(int argc, char** argv) {
  using namespace exactvo::test;
  const int worlds = argc > 1 ? std::atoi(argv[1]) : 1000;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  SeededRandom random(seed);
  RouteCampaign campaign;
  for (int k = 0; k < worlds; ++k)
    check_field(route_field(random, kFieldKinds[static_cast<std::size_t>(k) % std::size(kFieldKinds)]), random,
                campaign);
  for (std::size_t k = 0; k < campaign.failures.size() && k < 20; ++k)
    std::printf("%s\n", campaign.failures[k].c_str());
  std::printf(
      "seed %llu: %zu cases: %zu routes, %zu chains, %zu blocked; length over lower bound %.4f in the mean, "
      "%.4f at most; %zu failures\n",
      static_cast<unsigned long long>(seed), campaign.cases, campaign.routes, campaign.chains, campaign.blocked,
      campaign.sum_of_ratios / std::max<double>(1.0, static_cast<double>(campaign.routes)), campaign.worst_ratio,
      campaign.failures.size());
  std::printf("longest for its bound: %s\n", campaign.worst.c_str());
  return campaign.failures.empty() ? 0 : 1;
}
