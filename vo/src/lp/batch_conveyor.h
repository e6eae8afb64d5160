// SPDX-License-Identifier: GPL-3.0-or-later
// How packs of problems travel. A round is a chain of divisions and comparisons that a processor cannot look past, so
// some packs make each round together: the gaps of one are filled by the others. Both walks go on side by side in a
// pack, each lane on its own; what it computes does not depend on its company. Compiled once a SIMD target, hence the
// toggling guard.
#if defined(EXACTVO_BATCH_CONVEYOR_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_CONVEYOR_H
#undef EXACTVO_BATCH_CONVEYOR_H
#else
#define EXACTVO_BATCH_CONVEYOR_H
#endif

#include "batch_pool.h"
#include "batch_proof.h"
#include "batch_relax.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Called for problem i that the walk could not settle or prove; true where exact arithmetic was needed.
template <class T>
using Leftover = bool (*)(const BatchProblems<T>&, const BatchAnswers<T>&, std::size_t);

template <class D, bool kHard, bool kProve, bool kActive>
class Conveyor {
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using U = hwy::MakeUnsigned<T>;

 public:
  /// How many numbers of memory a conveyor wants.
  static std::size_t memory(std::size_t lines) { return Pool<D>::numbers(lines) + stage_numbers(lines); }

  Conveyor(const BatchProblems<T>& in, const BatchAnswers<T>& out, Leftover<T> leftover, T* memory)
      : in_(in),
        out_(out),
        leftover_(leftover),
        rare_(memory, in.lines),
        stage_(memory + Pool<D>::numbers(in.lines)),
        packs_(packs_under_way<D>(in.lines)) {}

  BatchCounts run(std::size_t first, std::size_t last) {
    std::size_t at = first;
    const std::size_t ragged = std::min(last, (first + kLanes - 1) / kLanes * kLanes);
    if (at < ragged) run_copied(at, ragged - at), at = ragged;
    while (at + kLanes <= last) {
      const std::size_t packs = std::min(packs_, (last - at) / kLanes);
      run_in_place(at, packs);
      at += packs * kLanes;
    }
    if (at < last) run_copied(at, last - at);
    descend();
    return counts_;
  }

 private:
  static constexpr bool kIndex = kHard || kActive;  ///< whether numbers of lines are asked for
  static constexpr std::size_t kLanes = hn::MaxLanes(D());

  static std::size_t stage_numbers(std::size_t lines) { return (3 * lines + 4) * kLanes; }

  /// A pack on its way.
  struct Way {
    Pack<D> pack;
    Rows<T> rows;
    M lanes;     ///< that hold a problem
    M walking;   ///< still on the first walk
    M relaxing;  ///< still on the second walk
    M gone;      ///< handed over: their answers come from elsewhere
    M answered;  ///< those whose answers have come
    int rounds;
    const T* ahead[3];  ///< x, y and c of a pack to come, one for each of the first rounds

    HWY_INLINE void begin(M which) {
      lanes = walking = which;
      relaxing = gone = answered = pack.none();
      rounds = 0;
    }
    HWY_INLINE bool busy() const { return !hn::AllFalse(D(), hn::Or(walking, relaxing)); }
  };

  using Ways = Way[kPacks];

  template <class Do>
  static HWY_INLINE void for_all(Ways& ways, std::size_t packs, Do what) {
    for (std::size_t k = 0; k < packs; ++k) what(ways[k]);
  }

  /// Packs from `at` on, where they lie.
  void run_in_place(std::size_t at, std::size_t packs) {
    Ways ways;
    for (std::size_t k = 0; k < packs; ++k) load(at + k * kLanes, ways[k]);
    solve(ways, packs);
    for (std::size_t k = 0; k < packs; ++k) finish(ways[k], at + k * kLanes);
    if (rare_.size() >= kLanes) descend();
  }

  HWY_INLINE void first_rounds(Ways& ways, std::size_t packs) {
    for_all(ways, packs, [this](Way& w) { look<0>(w); });
    for_all(ways, packs, [this](Way& w) { walk<0>(w); });
    for_all(ways, packs, [this](Way& w) { look<1>(w); });
    for_all(ways, packs, [this](Way& w) { walk<1>(w); });
    for_all(ways, packs, [this](Way& w) { look<2>(w); });
  }

  /// The lines that bound last time enter first, unseen.
  HWY_INLINE void follow_hints(Ways& ways, std::size_t packs) {
    for_all(ways, packs, [this](Way& w) { follow<0>(w); });
    for_all(ways, packs, [this](Way& w) { follow<1>(w); });
    for_all(ways, packs, [this](Way& w) { follow<2>(w); });
    for_all(ways, packs, [this](Way& w) {
      w.walking = hn::AndNot(hn::Or(w.gone, w.pack.relaxing), w.lanes);
      relax(w);
      look<0>(w);
    });
  }

  template <int kSlot>
  HWY_INLINE void follow(Way& way) {
    Pack<D>& p = way.pack;
    const M still = hn::AndNot(hn::Or(way.gone, p.relaxing), way.lanes);
    p.entering = hinted(way, kSlot);
    const V by = excess(p.entering, p.vx, p.vy);
    way.walking = hn::And(hn::And(still, p.exists(p.entering)), hn::Gt(by, hn::Sub(p.noise, p.slack)));
    p.entering.c = hn::Add(p.entering.c, p.slack);
    walk<kSlot>(way);
  }

  HWY_INLINE LineV<D> hinted(const Way& way, std::size_t slot) const {
    const D d;
    const hn::Rebind<std::int32_t, D> words;
    const auto number = hint_numbers(static_cast<std::size_t>(hn::GetLane(way.pack.id)), slot);
    const auto known = hn::And(hn::Gt(number, hn::Set(words, kNoLine)),
                               hn::Lt(number, hn::Set(words, static_cast<std::int32_t>(in_.lines))));
    const auto stride = hn::Set(words, static_cast<std::int32_t>(way.rows.stride));
    const auto at = hn::Add(hn::Mul(hn::IfThenElseZero(known, number), stride), hn::Iota(words, 0));
    const V index = from_words(hn::IfThenElse(known, number, hn::Set(words, kNoLine)));
    const M exists = hn::Ge(index, hn::Zero(d));
    const V c = gather(way.rows.c, at);
    return {hn::IfThenElseZero(exists, gather(way.rows.x, at)), hn::IfThenElseZero(exists, gather(way.rows.y, at)),
            hn::IfThenElse(exists, c, hn::Set(d, T(-1))), index};
  }

  HWY_INLINE auto hint_numbers(std::size_t first, std::size_t slot) const {
    const hn::Rebind<std::int32_t, D> words;
    const std::int32_t* hints = in_.hint + slot * in_.hint_stride;
    if (first + kLanes <= in_.count) return hn::LoadU(words, hints + first);
    HWY_ALIGN std::int32_t some[kLanes];
    for (std::size_t lane = 0; lane < kLanes; ++lane) some[lane] = hints[std::min(first + lane, in_.count - 1)];
    return hn::LoadU(words, some);
  }

  template <class Words>
  static HWY_INLINE V from_words(Words words) {
    if constexpr (sizeof(T) == 8)
      return hn::PromoteTo(D(), words);
    else
      return hn::ConvertTo(D(), words);
  }

  template <class Words>
  static HWY_INLINE V gather(const T* base, Words at) {
    if constexpr (sizeof(T) == 8)
      return hn::GatherIndex(D(), base, hn::PromoteTo(hn::RebindToSigned<D>(), at));
    else
      return hn::GatherIndex(D(), base, at);
  }

  /// Two rounds, with no line and with one in hand, then as many as it takes.
  HWY_INLINE void solve(Ways& ways, std::size_t packs) {
    for_all(ways, packs, [](Way& w) {
      w.pack.derive();
      w.pack.start();
    });
    for_all(ways, packs, [this](Way& w) { turn_away(w); });
    if (in_.hint)
      follow_hints(ways, packs);
    else
      first_rounds(ways, packs);
    Way* busy[kPacks];
    std::size_t count = 0;
    for (std::size_t k = 0; k < packs; ++k) {
      busy[count] = ways + k;
      count += ways[k].busy();
    }
    while (count > 0) {
      for (std::size_t k = 0; k < count; ++k) walk<2>(*busy[k]);
      for (std::size_t k = 0; k < count; ++k) relax(*busy[k]);
      for (std::size_t k = 0; k < count; ++k) look(*busy[k]);
      std::size_t left = 0;
      for (std::size_t k = 0; k < count; ++k) {
        busy[left] = busy[k];
        left += busy[k]->busy();
      }
      count = left;
    }
  }

  /// Lanes whose numbers are too large or too small to square.
  HWY_INLINE void turn_away(Way& way) {
    const M odd = hn::AndNot(way.pack.in_range(), way.lanes);
    if (hn::AllFalse(D(), odd)) return;
    way.walking = hn::AndNot(odd, way.walking);
    leave(way, odd);
  }

  static constexpr int kNothing = -1;

  /// What is violated now, and by that who goes on. In passing, x, y or c (0, 1, 2) of a pack to come are asked for.
  template <int kAsked = kNothing>
  HWY_INLINE void look(Way& way) {
    if constexpr (kAsked == kNothing)
      price<kHard, kIndex, false>(way.rows, way.pack);
    else
      price<kHard, kIndex, true>(way.rows, way.pack, way.ahead[kAsked]);
    way.walking = hn::And(way.walking, way.pack.violated);
    way.relaxing = hn::And(way.relaxing, way.pack.violated);
    if (++way.rounds < kMostLockstepRounds) return;
    const M old = hn::Or(way.walking, way.relaxing);
    way.walking = way.relaxing = way.pack.none();
    leave(way, old);
  }

  /// A round of the first walk; the lanes that contradict begin the second.
  template <int kKept>
  HWY_INLINE void walk(Way& way) {
    if (kKept > 1 && hn::AllFalse(D(), way.walking)) return;
    const M contradict = step<kKept, kIndex>(way.pack, way.walking);
    if (hn::AllFalse(D(), contradict)) return;
    way.walking = hn::AndNot(contradict, way.walking);
    way.pack.third = pick<kIndex>(contradict, way.pack.entering, way.pack.third);
    start_relaxing<kHard, kIndex>(way.pack, contradict);
    const M ready = hn::And(contradict, surround_zero<kHard>(way.pack));
    way.relaxing = hn::Or(way.relaxing, ready);
    way.pack.relaxing = hn::Or(way.pack.relaxing, ready);
    set_aside(way, hn::AndNot(ready, contradict));
  }

  /// A round of the second walk.
  HWY_INLINE void relax(Way& way) {
    if (hn::AllFalse(D(), way.relaxing)) return;
    const M other = pivot<kHard, kIndex>(way.pack, way.relaxing);
    way.relaxing = hn::AndNot(other, way.relaxing);
    set_aside(way, other);
  }

  /// Lanes whose second walk needs more than three soft planes.
  HWY_INLINE void set_aside(Way& way, M which) {
    if (hn::AllFalse(D(), which)) return;
    way.gone = hn::Or(way.gone, which);
    rare_.push(way.pack, which, way.rows);
  }

  HWY_INLINE void load(std::size_t at, Way& way) const {
    const D d;
    const std::size_t start = first_line_of(in_, at);
    way.rows = {in_.normal_x + start, in_.normal_y + start, in_.offset + start, in_.block, in_.lines};
    Pack<D>& p = way.pack;
    p.px = hn::LoadU(d, in_.preferred_x + at);
    p.py = hn::LoadU(d, in_.preferred_y + at);
    p.speed = hn::LoadU(d, in_.disc + at);
    p.hard_count = hn::Zero(d);
    if (kHard) p.hard_count = load_counts(in_.hard + at);
    p.id = numbers_from(at);
    way.begin(hn::FirstN(d, kLanes));
    ask_for(std::min(at + packs_ * kLanes, (in_.count - 1) / kLanes * kLanes), way);
  }

  /// What the pack at `at` will need: its lines little by little, since a burst of them stops the processor.
  HWY_INLINE void ask_for(std::size_t at, Way& way) const {
    const std::size_t start = first_line_of(in_, at);
    way.ahead[0] = in_.normal_x + start;
    way.ahead[1] = in_.normal_y + start;
    way.ahead[2] = in_.offset + start;
    for (const T* numbers : {in_.preferred_x, in_.preferred_y, in_.disc}) hwy::Prefetch(numbers + at);
    for (const T* numbers : {out_.velocity_x, out_.velocity_y, out_.violation}) hwy::Prefetch(numbers + at);
    hwy::Prefetch(out_.status + at);
  }

  /// `Iota` from what is not a constant is stored lane by lane.
  static HWY_INLINE auto numbers_from(std::size_t at) {
    const hn::RebindToUnsigned<D> d;
    return hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<U>(at)));
  }

  static HWY_INLINE V load_counts(const std::int32_t* counts) {
    return from_words(hn::LoadU(hn::Rebind<std::int32_t, D>(), counts));
  }

  /// Less than a pack, at an end of the range: copied, so that nothing beyond is read. The lanes left over repeat one.
  void run_copied(std::size_t at, std::size_t count) {
    const D d;
    const std::size_t state = 3 * in_.lines * kLanes;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const std::size_t i = at + std::min(lane, count - 1), line = first_line_of(in_, i);
      for (std::size_t k = 0; k < in_.lines; ++k) {
        stage_[3 * k * kLanes + lane] = in_.normal_x[line + k * in_.block];
        stage_[(3 * k + 1) * kLanes + lane] = in_.normal_y[line + k * in_.block];
        stage_[(3 * k + 2) * kLanes + lane] = in_.offset[line + k * in_.block];
      }
      stage_[state + lane] = in_.preferred_x[i];
      stage_[state + kLanes + lane] = in_.preferred_y[i];
      stage_[state + 2 * kLanes + lane] = in_.disc[i];
      stage_[state + 3 * kLanes + lane] = kHard ? static_cast<T>(in_.hard[i]) : T(0);
    }
    Ways ways;
    Pack<D>& p = ways[0].pack;
    p.px = hn::LoadU(d, stage_ + state);
    p.py = hn::LoadU(d, stage_ + state + kLanes);
    p.speed = hn::LoadU(d, stage_ + state + 2 * kLanes);
    p.hard_count = hn::LoadU(d, stage_ + state + 3 * kLanes);
    p.id = numbers_from(at);
    ways[0].rows = {stage_, stage_ + kLanes, stage_ + 2 * kLanes, 3 * kLanes, in_.lines};
    ways[0].begin(hn::FirstN(d, count));
    std::fill_n(ways[0].ahead, 3, stage_);
    solve(ways, 1);
    finish_some(p, hn::AndNot(ways[0].gone, ways[0].lanes));
    descend();
  }

  /// All that waits for the general second walk.
  void descend() {
    const D d;
    const std::size_t size = rare_.size();
    rare_.clear();
    for (std::size_t from = 0; from < size; from += kLanes) {
      const M lanes = hn::FirstN(d, std::min(kLanes, size - from));
      Pack<D> p;
      rare_.load(from, p);
      Descent<D> descent(p);
      descent.template run<kHard, kIndex>(rare_.rows(from), lanes);
      finish_some(p, hn::AndNot(descent.unsettled, lanes));
      leave(p, hn::And(descent.unsettled, lanes));
    }
  }

  void leave(Way& way, M which) {
    way.gone = hn::Or(way.gone, which);
    way.answered = hn::Or(way.answered, which);
    leave(way.pack, which);
  }

  void leave(const Pack<D>& p, M which) {
    if (hn::AllFalse(p.d, which)) return;
    HWY_ALIGN U ids[kLanes];
    hn::Store(p.id, hn::RebindToUnsigned<D>(), ids);
    for (std::uint64_t bits = bits_of(p.d, which); bits != 0; bits &= bits - 1) {
      counts_.exact += leftover_(in_, out_, static_cast<std::size_t>(ids[hwy::Num0BitsBelowLS1Bit_Nonzero64(bits)]));
      ++counts_.scalar;
    }
  }

  /// The answers of a pack in their places, all at once; those of lanes that are gone come later and are written over,
  /// unless they have come.
  HWY_INLINE void finish(Way& way, std::size_t at) {
    const D d;
    const Pack<D>& p = way.pack;
    const M done = hn::AndNot(way.gone, way.lanes);
    if (!hn::AllFalse(d, way.answered)) return finish_some(p, done);
    hn::StoreU(p.vx, d, out_.velocity_x + at);
    hn::StoreU(p.vy, d, out_.velocity_y + at);
    hn::StoreU(violation(p), d, out_.violation + at);
    const std::uint64_t relaxed = bits_of(d, p.relaxing);
    if (relaxed == 0)
      std::memset(out_.status + at, 0, kLanes);
    else
      for (std::size_t lane = 0; lane < kLanes; ++lane) out_.status[at + lane] = relaxed >> lane & 1U;
    if (kActive) put_active(p, done);
    if (!kProve) return;
    std::memset(out_.proven + at, 1, kLanes);
    leave_unproven(p, done);
  }

  static HWY_INLINE V violation(const Pack<D>& p) {
    return hn::IfThenElseZero(p.relaxing, hn::Max(p.level, hn::Zero(D())));
  }

  void finish_some(const Pack<D>& p, M done) {
    const D d;
    HWY_ALIGN T x[kLanes], y[kLanes], by[kLanes];
    HWY_ALIGN U ids[kLanes];
    hn::Store(p.vx, d, x);
    hn::Store(p.vy, d, y);
    hn::Store(violation(p), d, by);
    hn::Store(p.id, hn::RebindToUnsigned<D>(), ids);
    const std::uint64_t relaxed = bits_of(d, p.relaxing);
    for (std::uint64_t bits = bits_of(d, done); bits != 0; bits &= bits - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero64(bits), i = static_cast<std::size_t>(ids[lane]);
      out_.velocity_x[i] = x[lane];
      out_.velocity_y[i] = y[lane];
      out_.violation[i] = by[lane];
      out_.status[i] = relaxed >> lane & 1U;
      if (kProve) out_.proven[i] = 1;
    }
    if (kActive) put_active(p, done);
    if (kProve) leave_unproven(p, done);
  }

  HWY_INLINE void leave_unproven(const Pack<D>& p, M done) {
    const D d;
    const M relaxed = hn::And(done, p.relaxing), optimal = hn::AndNot(p.relaxing, done);
    if (!hn::AllFalse(d, optimal)) leave(p, hn::AndNot(Proof<D>(p).optimum(), optimal));
    if (!hn::AllFalse(d, relaxed)) leave(p, hn::AndNot(Proof<D>(p).relaxation(), relaxed));
  }

  void put_active(const Pack<D>& p, M done) const {
    const D d;
    HWY_ALIGN T lines[3][kLanes];
    HWY_ALIGN U ids[kLanes];
    hn::Store(p.first.index, d, lines[0]);
    hn::Store(p.second.index, d, lines[1]);
    hn::Store(p.third.index, d, lines[2]);
    hn::Store(p.id, hn::RebindToUnsigned<D>(), ids);
    for (std::uint64_t bits = bits_of(p.d, done); bits != 0; bits &= bits - 1) {
      const std::size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero64(bits);
      for (std::size_t slot = 0; slot < 3; ++slot)
        out_.active[slot * out_.stride + ids[lane]] = static_cast<std::int32_t>(lines[slot][lane]);
    }
  }

  const BatchProblems<T>& in_;
  const BatchAnswers<T>& out_;
  Leftover<T> leftover_;
  Pool<D> rare_;
  T* stage_;
  std::size_t packs_;
  BatchCounts counts_;
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
