// SPDX-License-Identifier: GPL-3.0-or-later
// Entries of tables of whole numbers, one for each lane. On AVX2 they are loaded one by one: the instruction that
// gathers them takes twice as long on AMD's processors. Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_CROWD_ENTRIES_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_CROWD_ENTRIES_H
#undef EXACTVO_CROWD_ENTRIES_H
#else
#define EXACTVO_CROWD_ENTRIES_H
#endif

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

/// `D`: a tag of std::int32_t.
template <class D>
class Entries {
  using W = hwy::HWY_NAMESPACE::Vec<D>;

 public:
  /// REQUIRES: at >= 0.
#if HWY_TARGET == HWY_AVX2
  HWY_INLINE explicit Entries(W at) {
    if constexpr (kHalves == 2) {
      take(_mm256_castsi256_si128(at.raw), 0);
      take(_mm256_extracti128_si256(at.raw, 1), 2);
    } else {
      take(at.raw, 0);
    }
  }

  HWY_INLINE W of(const std::int32_t* table) const {
    if constexpr (kHalves == 2)
      return W{_mm256_set_m128i(half(table, 2), half(table, 0))};
    else
      return W{half(table, 0)};
  }

 private:
  static constexpr std::size_t kHalves = hwy::HWY_NAMESPACE::MaxLanes(D()) / 4;
  static_assert(kHalves == 1 || kHalves == 2);

  HWY_INLINE void take(__m128i at, std::size_t k) {
    two_[k] = static_cast<std::uint64_t>(_mm_cvtsi128_si64(at));
    two_[k + 1] = static_cast<std::uint64_t>(_mm_extract_epi64(at, 1));
  }
  HWY_INLINE __m128i half(const std::int32_t* table, std::size_t k) const {
    const auto low = [&](std::size_t of) { return table[static_cast<std::uint32_t>(two_[of])]; };
    const auto high = [&](std::size_t of) { return table[two_[of] >> 32U]; };
    return _mm_setr_epi32(low(k), high(k), low(k + 1), high(k + 1));
  }

  std::uint64_t two_[2 * kHalves];
#else
  HWY_INLINE explicit Entries(W at) : at_(at) {}
  HWY_INLINE W of(const std::int32_t* table) const { return hwy::HWY_NAMESPACE::GatherIndex(D(), table, at_); }

 private:
  W at_;
#endif
};

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // EXACTVO_CROWD_ENTRIES_H
