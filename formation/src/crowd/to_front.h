// SPDX-License-Identifier: GPL-3.0-or-later
// No include guard: included once for each SIMD target, inside its namespace's file.

/// \file
/// Moves lanes of a mask to the front of registers of eight or fewer words. hn::Compress does, but on AVX2 GCC 12
/// copies its table of 1 KiB to the stack at each call.

#if !defined(EXACTVO_LANES_TO_FRONT)
#define EXACTVO_LANES_TO_FRONT
#include <cstdint>
namespace exactvo::formation::crowd {

/// from[bits][k]: the k-th of the lanes in the mask.
struct LanesToFront {
  std::uint8_t from[256][8] = {};

  constexpr LanesToFront() {
    for (std::size_t bits = 0; bits < 256; ++bits)
      for (std::uint8_t lane = 0, k = 0; lane < 8; ++lane)
        if (bits >> lane & 1U) from[bits][k++] = lane;
  }
};
inline constexpr LanesToFront kLanesToFront;

}  // namespace exactvo::formation::crowd
#endif

HWY_BEFORE_NAMESPACE();
namespace exactvo::formation::crowd::HWY_NAMESPACE {

/// Moves the same lanes of several columns to the front.
template <class D>
class ToFront {
 public:
  explicit HWY_INLINE ToFront(hwy::HWY_NAMESPACE::Mask<D> mask) : mask_(mask) {
#if HWY_TARGET == HWY_AVX2
    namespace hn = hwy::HWY_NAMESPACE;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(D(), mask, bits);
    from_ = hn::PromoteTo(D(), hn::LoadU(hn::Rebind<std::uint8_t, D>(), kLanesToFront.from[bits[0]]));
#endif
  }

  HWY_INLINE hwy::HWY_NAMESPACE::Vec<D> operator()(hwy::HWY_NAMESPACE::Vec<D> words) const {
    namespace hn = hwy::HWY_NAMESPACE;
#if HWY_TARGET == HWY_AVX2
    return hn::TableLookupLanes(words, hn::IndicesFromVec(D(), from_));
#else
    return hn::Compress(words, mask_);
#endif
  }

 private:
  hwy::HWY_NAMESPACE::Mask<D> mask_;
#if HWY_TARGET == HWY_AVX2
  hwy::HWY_NAMESPACE::Vec<D> from_;
#endif
};

}  // namespace exactvo::formation::crowd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
