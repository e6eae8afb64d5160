// SPDX-License-Identifier: GPL-3.0-or-later
#include "sha256.h"

#if defined(__x86_64__) && defined(__GNUC__)
#include <cpuid.h>
#include <immintrin.h>
#define EXACTVO_SHA_INSTRUCTIONS 1
#endif

namespace exactvo::datasets {
namespace {

constexpr std::size_t kBlock = 64;

/// FIPS 180-4, section 4.2.2: the fractional parts of the cube roots of the first 64 primes.
constexpr std::array<std::uint32_t, 64> kRound{
    0x428a2f98u, 0x71374491u, 0xb5c0fbcfu, 0xe9b5dba5u, 0x3956c25bu, 0x59f111f1u, 0x923f82a4u, 0xab1c5ed5u,
    0xd807aa98u, 0x12835b01u, 0x243185beu, 0x550c7dc3u, 0x72be5d74u, 0x80deb1feu, 0x9bdc06a7u, 0xc19bf174u,
    0xe49b69c1u, 0xefbe4786u, 0x0fc19dc6u, 0x240ca1ccu, 0x2de92c6fu, 0x4a7484aau, 0x5cb0a9dcu, 0x76f988dau,
    0x983e5152u, 0xa831c66du, 0xb00327c8u, 0xbf597fc7u, 0xc6e00bf3u, 0xd5a79147u, 0x06ca6351u, 0x14292967u,
    0x27b70a85u, 0x2e1b2138u, 0x4d2c6dfcu, 0x53380d13u, 0x650a7354u, 0x766a0abbu, 0x81c2c92eu, 0x92722c85u,
    0xa2bfe8a1u, 0xa81a664bu, 0xc24b8b70u, 0xc76c51a3u, 0xd192e819u, 0xd6990624u, 0xf40e3585u, 0x106aa070u,
    0x19a4c116u, 0x1e376c08u, 0x2748774cu, 0x34b0bcb5u, 0x391c0cb3u, 0x4ed8aa4au, 0x5b9cca4fu, 0x682e6ff3u,
    0x748f82eeu, 0x78a5636fu, 0x84c87814u, 0x8cc70208u, 0x90befffau, 0xa4506cebu, 0xbef9a3f7u, 0xc67178f2u};

constexpr std::uint32_t turned(std::uint32_t x, int bits) {
  return (x >> bits) | (x << (32 - bits));
}

std::uint32_t big_endian(const unsigned char* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | std::uint32_t{p[3]};
}

/// Section 6.2.2, step 1.
std::array<std::uint32_t, 64> schedule(const unsigned char* block) {
  std::array<std::uint32_t, 64> w{};
  for (std::size_t t = 0; t < 16; ++t) w[t] = big_endian(block + 4 * t);
  for (std::size_t t = 16; t < 64; ++t) {
    const std::uint32_t s0 = turned(w[t - 15], 7) ^ turned(w[t - 15], 18) ^ (w[t - 15] >> 3);
    const std::uint32_t s1 = turned(w[t - 2], 17) ^ turned(w[t - 2], 19) ^ (w[t - 2] >> 10);
    w[t] = s1 + w[t - 7] + s0 + w[t - 16];
  }
  return w;
}

using State = std::array<std::uint32_t, 8>;

/// Section 6.2.2.
void compress_block(State& state, const unsigned char* block) {
  const std::array<std::uint32_t, 64> w = schedule(block);
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t t = 0; t < 64; ++t) {
    const std::uint32_t t1 =
        h + (turned(e, 6) ^ turned(e, 11) ^ turned(e, 25)) + ((e & f) ^ (~e & g)) + kRound[t] + w[t];
    const std::uint32_t t2 = (turned(a, 2) ^ turned(a, 13) ^ turned(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
    h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
  }
  const State mixed{a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < 8; ++i) state[i] += mixed[i];
}

#ifdef EXACTVO_SHA_INSTRUCTIONS

/// What the processor says of itself: the instructions for SHA-256, and SSSE3 and SSE4.1 for the bytes' order.
bool ask_processor() {
  constexpr unsigned kSsse3AndSse41 = 1u << 9 | 1u << 19;  // leaf 1, ecx
  constexpr unsigned kSha = 1u << 29;                      // leaf 7, ebx
  unsigned a = 0;
  unsigned b = 0;
  unsigned c = 0;
  unsigned d = 0;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & kSsse3AndSse41) != kSsse3AndSse41) return false;
  return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && (b & kSha) != 0;
}

__attribute__((target("sha,ssse3,sse4.1"))) __m128i four_words(const void* words) {
  return _mm_loadu_si128(static_cast<const __m128i*>(words));
}

/// compress_block, four rounds a step. The instructions want the state as (a, b, e, f) and (c, d, g, h), first word
/// highest; each makes two rounds, after which the former pair is the new second one.
__attribute__((target("sha,ssse3,sse4.1"))) void compress_block_by_instructions(State& state,
                                                                                const unsigned char* block) {
  const __m128i big_endian_order = _mm_set_epi8(12, 13, 14, 15, 8, 9, 10, 11, 4, 5, 6, 7, 0, 1, 2, 3);
  const auto word = [&state](std::size_t k) { return static_cast<int>(state[k]); };
  const __m128i abef_before = _mm_set_epi32(word(0), word(1), word(4), word(5));
  const __m128i cdgh_before = _mm_set_epi32(word(2), word(3), word(6), word(7));
  __m128i abef = abef_before;
  __m128i cdgh = cdgh_before;
  __m128i w[4];
  for (std::size_t k = 0; k < 4; ++k) w[k] = _mm_shuffle_epi8(four_words(block + 16 * k), big_endian_order);
  for (std::size_t k = 0; k < 16; ++k) {
    __m128i& now = w[k % 4];
    const __m128i sum = _mm_add_epi32(now, four_words(&kRound[4 * k]));
    cdgh = _mm_sha256rnds2_epu32(cdgh, abef, sum);
    abef = _mm_sha256rnds2_epu32(abef, cdgh, _mm_shuffle_epi32(sum, 0x0e));  // the upper two words
    if (k >= 12) continue;
    // Four words on: w[t-16] + s0(w[t-15]), + w[t-7], + s1(w[t-2]).
    const __m128i last = w[(k + 3) % 4];
    const __m128i seven_back = _mm_alignr_epi8(last, w[(k + 2) % 4], 4);
    now = _mm_sha256msg2_epu32(_mm_add_epi32(_mm_sha256msg1_epu32(now, w[(k + 1) % 4]), seven_back), last);
  }
  alignas(16) std::uint32_t low_first[8];
  _mm_store_si128(reinterpret_cast<__m128i*>(low_first), _mm_add_epi32(abef, abef_before));
  _mm_store_si128(reinterpret_cast<__m128i*>(low_first + 4), _mm_add_epi32(cdgh, cdgh_before));
  const auto& [f, e, b, a, h, g, d, c] = low_first;
  state = {a, b, c, d, e, f, g, h};
}

#else

bool ask_processor() {
  return false;
}

void compress_block_by_instructions(State& state, const unsigned char* block) {
  compress_block(state, block);
}

#endif

}  // namespace

bool has_sha256_instructions() {
  static const bool kHas = ask_processor();
  return kHas;
}

void Sha256::compress(std::string_view blocks) {
  const auto compress_one = by_instructions_ ? compress_block_by_instructions : compress_block;
  for (; !blocks.empty(); blocks.remove_prefix(kBlock)) {
    compress_one(state_, reinterpret_cast<const unsigned char*>(blocks.data()));
  }
}

void Sha256::add(std::string_view bytes) {
  length_ += bytes.size();
  pending_ += bytes;
  const std::size_t whole = pending_.size() - pending_.size() % kBlock;
  compress(std::string_view(pending_).substr(0, whole));
  pending_.erase(0, whole);
}

std::string Sha256::digest() {
  const std::uint64_t bits = length_ * 8;
  std::string padding(1, '\x80');
  padding.append((kBlock + 56 - 1 - pending_.size() % kBlock) % kBlock, '\0');
  for (int shift = 56; shift >= 0; shift -= 8) padding += static_cast<char>((bits >> shift) & 0xffu);
  add(padding);
  std::string text;
  for (const std::uint32_t word : state_) {
    for (int shift = 28; shift >= 0; shift -= 4) text += "0123456789abcdef"[(word >> shift) & 0xfu];
  }
  return text;
}

}  // namespace exactvo::datasets
