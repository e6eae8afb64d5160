// SPDX-License-Identifier: GPL-3.0-or-later
// Where rare lanes wait for a full register. Compiled once per SIMD target, hence the toggling guard.
#if defined(EXACTVO_BATCH_POOL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_POOL_H
#undef EXACTVO_BATCH_POOL_H
#else
#define EXACTVO_BATCH_POOL_H
#endif

#include "lp/lanes/pack.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Packs that make their rounds together, at most: with fewer a processor waits, more gain nothing.
inline constexpr std::size_t kPacks = 6;

/// Bytes of lines that are to be under way: those of all packs of ten lines, three numbers each, in registers of 64
/// bytes; twenty lines then go three packs a round, fifty two. As many are asked for ahead and others pass through, and
/// all are meant to stay in a first cache of 32 to 48 KiB. With AVX-512, ns a problem in double at half, at these and
/// at twice as many bytes: twenty random lines 14.2, 13.2, 14.6; fifty 33.2, 29.1, 33.8; ten and a hundred alike.
inline constexpr std::size_t kLinesUnderWay = kPacks * 10 * 3 * 64;

/// Packs of this many lines that make their rounds together.
template <class D>
std::size_t packs_under_way(std::size_t lines) {
  const std::size_t pack = 3 * std::max<std::size_t>(1, lines) * hn::MaxLanes(D()) * sizeof(hn::TFromD<D>);
  return std::min(kPacks, (kLinesUnderWay + pack - 1) / pack);
}

/// With packs of this many lines the next group does not come from memory in time: blocks beyond it are asked for too,
/// into the second cache, in the order in which they lie. On an AMD EPYC, AVX2, ns a problem in double and float: fifty
/// lines out of a set of 39 MB 193 and 105 without, 173 and 88 with; twenty lines, 16 MB, 98 and 52 without, 94 and 50
/// with.
inline constexpr std::size_t kFarLines = 16;

/// How many blocks beyond the next group; with one, fifty lines take 175 and 91 ns.
inline constexpr std::size_t kBlocksBeyond = 3;

template <class D>
HWY_INLINE std::uint64_t bits_of(D d, hn::Mask<D> m) {
  constexpr std::size_t kBytes = (hn::MaxLanes(D()) + 7) / 8;
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(d, m, bytes);
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < kBytes; ++k) bits |= std::uint64_t{bytes[k]} << (8 * k);
  return bits;
}

/// Few problems of many packs, as a structure of arrays: their lines and what is known of them, dense.
template <class D>
class Pool {
 public:
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;

  /// It is emptied when a pack is full; before that is seen, all lanes of the packs under way may come.
  static constexpr std::size_t slots() { return (kPacks + 1) * hn::MaxLanes(D()); }
  static std::size_t numbers(std::size_t lines) { return (kState + 3 * lines) * slots(); }

  Pool(T* memory, std::size_t lines) : memory_(memory), lines_(lines) {}

  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }

  Rows<T> rows(std::size_t from) const {
    const T* x = row(kState) + from;
    return {x, x + slots(), x + 2 * slots(), 3 * slots(), lines_};
  }

  /// Adds the lanes in `which` of a pack whose lines stand at `from`: number by number, since they are few, and a
  /// register that is stored across two cache lines costs as much as a lane.
  HWY_INLINE void push(const Pack<D>& p, M which, const Rows<T>& from) {
    std::uint64_t bits = bits_of(D(), which);
    if (bits == 0) return;
    HWY_ALIGN T state[kState][hn::MaxLanes(D())];
    const V id = hn::BitCast(D(), p.id);
    std::size_t known = 0;
    for_each_row(p, id, [&](const V& v) { hn::Store(v, D(), state[known++]); });
    for (; bits != 0; bits &= bits - 1, ++size_) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
      for (std::size_t r = 0; r < kState; ++r) row(r)[size_] = state[r][lane];
      const T *x = from.x + lane, *y = from.y + lane, *c = from.c + lane;
      T* to = row(kState) + size_;
      for (std::size_t k = 0; k < lines_; ++k, x += from.stride, y += from.stride, c += from.stride) {
        to[0] = *x;
        to[slots()] = *y;
        to[2 * slots()] = *c;
        to += 3 * slots();
      }
    }
  }

  /// The lanes from `from` on as a pack, of which `lanes` hold a problem; the others hold what was there before,
  /// without hard lines.
  HWY_INLINE void load(std::size_t from, M lanes, Pack<D>& p) const {
    const D d;
    V id = hn::Zero(d);
    std::size_t known = 0;
    for_each_row(p, id, [&](V& v) { v = hn::LoadU(d, row(known++) + from); });
    p.id = hn::BitCast(hn::RebindToUnsigned<D>(), id);
    p.hard_count = hn::IfThenElseZero(lanes, p.hard_count);
    p.derive();
    p.vx = p.vy = p.level = hn::Zero(d);
    p.violated = p.none();
    p.relaxing = hn::Not(p.violated);
  }

 private:
  /// What is known of a problem, a row each: five numbers and four lines. `id` stands for the pack's.
  static constexpr std::size_t kState = 5 + 4 * 4;

  template <class P, class Id, class Visit>
  static HWY_INLINE void for_each_row(P& p, Id& id, Visit visit) {
    visit(p.px);
    visit(p.py);
    visit(p.speed);
    visit(p.hard_count);
    visit(id);
    const auto visit_line = [&](auto& line) {
      visit(line.x);
      visit(line.y);
      visit(line.c);
      visit(line.index);
    };
    visit_line(p.entering);
    visit_line(p.first);
    visit_line(p.second);
    visit_line(p.third);
  }

  T* row(std::size_t r) const { return memory_ + r * slots(); }

  T* memory_;
  std::size_t lines_;
  std::size_t size_ = 0;
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
