// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 in pieces of any length: what one machine has written another must know again.
#include "files/sha256.h"

#include <gtest/gtest.h>

namespace exactvo::datasets::test {
namespace {

std::string digest(const std::string& bytes, std::size_t piece) {
  Sha256 hash;
  for (std::size_t at = 0; at < bytes.size(); at += piece) hash.add(std::string_view(bytes).substr(at, piece));
  return hash.digest();
}

/// FIPS 180-4's examples of one and two blocks, NIST's of 896 bits, and the empty message.
TEST(Sha256, AnswersArePublishedOnes) {
  const std::pair<const char*, const char*> known[] = {
      {"", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855"},
      {"abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"},
      {"abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
       "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1"},
      {"abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmnhijklmno"
       "ijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu",
       "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1"}};
  for (const auto& [message, answer] : known)
    for (const std::size_t piece : {std::size_t{1}, std::size_t{63}, std::size_t{1000}})
      EXPECT_EQ(digest(message, piece), answer) << message;
}

TEST(Sha256, AnswersThePublishedOneOfAMillionLetters) {
  const std::string letters(1000000, 'a');
  for (const std::size_t piece : {std::size_t{997}, letters.size()})
    EXPECT_EQ(digest(letters, piece), "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

/// All lengths across three ends of blocks, as the digest of their digests. From Python's hashlib:
///   t = bytes((k*k + 7*k) % 256 for k in range(200)); h = lambda b: hashlib.sha256(b).hexdigest()
///   h("".join(h(t[:n]) for n in range(201)).encode())
TEST(Sha256, OfEveryLengthIsThatOfAnotherImplementation) {
  std::string bytes;
  std::string digests;
  for (int k = 0; k <= 200; ++k) {
    digests += digest(bytes, 1000);
    bytes += static_cast<char>((k * k + 7 * k) % 256);
  }
  EXPECT_EQ(digest(digests, digests.size()), "736112a80d49cdbba8c36c630fea09e0ef66dc1a7e5bda51bcd596b786a389a3");
}

}  // namespace
}  // namespace exactvo::datasets::test
