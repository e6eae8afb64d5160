// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 by the processor's instructions and without them: what one machine has written another must know again.
#include "sha256.h"

#include <gtest/gtest.h>

#include "support/seeded_random.h"

namespace exactvo::datasets::test {
namespace {

std::string digest(Sha256::Way way, const std::string& bytes, std::size_t piece) {
  Sha256 hash(way);
  for (std::size_t at = 0; at < bytes.size(); at += piece) hash.add(std::string_view(bytes).substr(at, piece));
  return hash.digest();
}

TEST(Sha256, IsTheSameBothWays) {
  exactvo::test::SeededRandom random(exactvo::test::seed_of_run(41));
  std::string bytes;
  for (int length = 0; length < 300; ++length) {
    for (const std::size_t piece : {std::size_t{1}, std::size_t{63}, std::size_t{1000}})
      ASSERT_EQ(digest(Sha256::Way::portable, bytes, piece), digest(Sha256::Way::quickest, bytes, 1000)) << length;
    bytes += static_cast<char>(random.integer(0, 255));
  }
  EXPECT_EQ(digest(Sha256::Way::portable, "abc", 1),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace exactvo::datasets::test
