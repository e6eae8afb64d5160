// SPDX-License-Identifier: GPL-3.0-or-later
// How packs of problems travel. A round is a chain of divisions and comparisons that a processor cannot look past, so
// some packs make each round together: the gaps of one are filled by the others. Both phases go on side by side in a
// pack, each lane on its own; what it computes does not depend on its company. Compiled once per SIMD target, hence the
// toggling guard.
#if defined(EXACTVO_BATCH_CONVEYOR_H) == defined(HWY_TARGET_TOGGLE)
#ifdef EXACTVO_BATCH_CONVEYOR_H
#undef EXACTVO_BATCH_CONVEYOR_H
#else
#define EXACTVO_BATCH_CONVEYOR_H
#endif

#include "lp/lanes/pack_proof.h"
#include "lp/lanes/pool.h"
#include "lp/lanes/relaxation.h"

HWY_BEFORE_NAMESPACE();
namespace exactvo::lp::HWY_NAMESPACE {

/// Called for problem i that the search could not settle or prove; true where exact arithmetic was needed.
template <class T>
using Leftover = bool (*)(const BatchProblems<T>&, const BatchAnswers<T>&, std::size_t);

/// kHard: some lines may be hard; kIndex: numbers of lines are asked for. Hard lines are known by their numbers too,
/// but few packs of the feasibility phase need them, and those look them up. Two flags and no more: every flag doubles
/// what is compiled for every target, so what is asked once a pack is asked at run time.
template <class D, bool kHard, bool kIndex>
class Lockstep {
  static_assert(!kIndex || !kHard, "with hard lines numbers are looked up");
  static constexpr bool kNumbers = kIndex || kHard;  ///< on the relaxation phase
  using T = hn::TFromD<D>;
  using V = hn::Vec<D>;
  using M = hn::Mask<D>;
  using U = hwy::MakeUnsigned<T>;

 public:
  /// How many numbers of memory a driver wants.
  static std::size_t memory(std::size_t lines) { return Pool<D>::numbers(lines) + stage_numbers(lines); }

  Lockstep(const BatchProblems<T>& in, const BatchAnswers<T>& out, Leftover<T> leftover, T* memory)
      : in_(in),
        out_(out),
        leftover_(leftover),
        rare_(memory, in.lines),
        stage_(memory + Pool<D>::numbers(in.lines)),
        packs_(packs_under_way<D>(in.lines)),
        asks_beyond_(in.lines >= kFarLines && in.block < in.count) {}

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
    flush_deferred();
    return counts_;
  }

 private:
  static constexpr bool kMayProve = sizeof(T) == 8;
  static constexpr std::size_t kLanes = hn::MaxLanes(D());

  static std::size_t stage_numbers(std::size_t lines) { return (3 * lines + 4) * kLanes; }

  struct PackState {
    Pack<D> pack;
    Rows<T> rows;
    M lanes;      ///< that hold a problem
    M searching;  ///< still on the feasibility phase
    M relaxing;   ///< still on the relaxation phase
    M gone;       ///< handed over: their answers come from elsewhere
    M answered;   ///< those whose answers have come
    int rounds;
    Ahead<T> ahead[3];  ///< x, y and c of packs to come, one for each of the first rounds

    HWY_INLINE void begin(M which) {
      lanes = searching = which;
      relaxing = gone = answered = pack.none();
      rounds = 0;
    }
    HWY_INLINE bool busy() const { return !hn::AllFalse(D(), hn::Or(searching, relaxing)); }
  };

  using PackStates = PackState[kPacks];

  template <class Do>
  static HWY_INLINE void for_all(PackStates& states, std::size_t packs, Do what) {
    for (std::size_t k = 0; k < packs; ++k) what(states[k]);
  }

  /// Packs from `at` on, where they lie.
  void run_in_place(std::size_t at, std::size_t packs) {
    PackStates states;
    for (std::size_t k = 0; k < packs; ++k) load(at + k * kLanes, states[k]);
    solve(states, packs);
    for (std::size_t k = 0; k < packs; ++k) finish(states[k], at + k * kLanes);
    if (rare_.size() >= kLanes) flush_deferred();
  }

  HWY_INLINE void first_rounds(PackStates& states, std::size_t packs) {
    for_all(states, packs, [this](PackState& w) { price_all<0>(w); });
    for_all(states, packs, [this](PackState& w) { search<0>(w); });
    for_all(states, packs, [this](PackState& w) { price_all<1>(w); });
    for_all(states, packs, [this](PackState& w) { search<1>(w); });
    for_all(states, packs, [this](PackState& w) { price_all<2>(w); });
  }

  /// Two rounds, with no line and with one in the working set, then as many as it takes.
  HWY_INLINE void solve(PackStates& states, std::size_t packs) {
    for_all(states, packs, [this](PackState& w) {
      w.pack.derive();
      number_lines(w.pack);
      w.pack.start();
    });
    for_all(states, packs, [this](PackState& w) { turn_away(w); });
    first_rounds(states, packs);
    PackState* busy[kPacks];
    std::size_t count = 0;
    for (std::size_t k = 0; k < packs; ++k) {
      busy[count] = states + k;
      count += states[k].busy();
    }
    while (count > 0) {
      for (std::size_t k = 0; k < count; ++k) search<2>(*busy[k]);
      for (std::size_t k = 0; k < count; ++k) relax(*busy[k]);
      for (std::size_t k = 0; k < count; ++k) price_all(*busy[k]);
      std::size_t left = 0;
      for (std::size_t k = 0; k < count; ++k) {
        busy[left] = busy[k];
        left += busy[k]->busy();
      }
      count = left;
    }
  }

  /// While lanes relax hard lines are told by their numbers; of the others they are kept where they are asked for.
  HWY_INLINE void number_lines(Pack<D>& p) const {
    if (!kHard) return;
    p.numbered = in_.lines;
    if (out_.active) return;
    const auto hard = static_cast<std::size_t>(hn::GetLane(hn::MaxOfLanes(D(), p.hard_count)));
    p.numbered = std::min(p.numbered, hard);
  }

  /// Lanes whose numbers are too large or too small to square.
  HWY_INLINE void turn_away(PackState& state) {
    const M odd = hn::AndNot(state.pack.in_range(), state.lanes);
    if (hn::AllFalse(D(), odd)) return;
    state.searching = hn::AndNot(odd, state.searching);
    leave(state, odd);
  }

  static constexpr int kNothing = -1;

  /// The lines that are violated now, and so the lanes that go on. In passing, x, y or c (0, 1, 2) of a pack to come
  /// are fetched.
  template <int kAsked = kNothing>
  HWY_INLINE void price_all(PackState& state) {
    if constexpr (kAsked == kNothing)
      price<kHard, kIndex, Ask::nothing>(state.rows, state.pack);
    else if (asks_beyond_)
      price<kHard, kIndex, Ask::both>(state.rows, state.pack, state.ahead[kAsked]);
    else
      price<kHard, kIndex, Ask::next>(state.rows, state.pack, state.ahead[kAsked]);
    state.searching = hn::And(state.searching, state.pack.violated);
    state.relaxing = hn::And(state.relaxing, state.pack.violated);
    if (++state.rounds < kMostLockstepRounds) return;
    const M old = hn::Or(state.searching, state.relaxing);
    state.searching = state.relaxing = state.pack.none();
    leave(state, old);
  }

  /// A round of the feasibility phase; the lanes that contradict begin the second.
  template <int kKept>
  HWY_INLINE void search(PackState& state) {
    if (kKept > 1 && hn::AllFalse(D(), state.searching)) return;
    const M contradict = step<kKept, kIndex>(state.pack, state.searching);
    if (hn::AllFalse(D(), contradict)) return;
    state.searching = hn::AndNot(contradict, state.searching);
    state.pack.third = pick<kIndex>(contradict, state.pack.entering, state.pack.third);
    if (kHard) number_basis(state.rows, state.pack.numbered, contradict, state.pack);
    start_relaxing<kHard, kNumbers>(state.pack, contradict);
    const M ready = hn::And(contradict, surround_zero<kHard>(state.pack));
    state.relaxing = hn::Or(state.relaxing, ready);
    state.pack.relaxing = hn::Or(state.pack.relaxing, ready);
    set_aside(state, hn::AndNot(ready, contradict));
  }

  /// A round of the relaxation phase.
  HWY_INLINE void relax(PackState& state) {
    if (hn::AllFalse(D(), state.relaxing)) return;
    const M other = pivot<kHard, kNumbers>(state.pack, state.relaxing);
    state.relaxing = hn::AndNot(other, state.relaxing);
    set_aside(state, other);
  }

  /// Lanes whose relaxation phase needs more than three soft planes.
  HWY_INLINE void set_aside(PackState& state, M which) {
    if (hn::AllFalse(D(), which)) return;
    state.gone = hn::Or(state.gone, which);
    rare_.push(state.pack, which, state.rows);
  }

  HWY_INLINE void load(std::size_t at, PackState& state) const {
    const D d;
    const std::size_t start = first_line_of(in_, at);
    state.rows = {in_.normal_x + start, in_.normal_y + start, in_.offset + start, in_.block, in_.lines};
    Pack<D>& p = state.pack;
    p.px = hn::LoadU(d, in_.preferred_x + at);
    p.py = hn::LoadU(d, in_.preferred_y + at);
    p.speed = hn::LoadU(d, in_.disc + at);
    p.hard_count = hn::Zero(d);
    if (kHard) p.hard_count = in_.hard ? load_counts(in_.hard + at) : hn::Zero(D());
    p.id = numbers_from(at);
    state.begin(hn::FirstN(d, kLanes));
    ask_for(std::min(at + packs_ * kLanes, (in_.count - 1) / kLanes * kLanes), state);
    if (asks_beyond_) ask_beyond(at, state);
  }

  /// What the pack at `at` will need: its lines little by little, since a burst of them stops the processor.
  HWY_INLINE void ask_for(std::size_t at, PackState& state) const {
    const std::size_t start = first_line_of(in_, at);
    const T* arrays[3] = {in_.normal_x, in_.normal_y, in_.offset};
    for (std::size_t k = 0; k < 3; ++k) state.ahead[k] = {arrays[k] + start, nullptr};
    for (const T* numbers : {in_.preferred_x, in_.preferred_y, in_.disc}) hwy::Prefetch(numbers + at);
    for (const T* numbers : {out_.velocity_x, out_.velocity_y, out_.violation}) hwy::Prefetch(numbers + at);
    hwy::Prefetch(out_.status + at);
  }

  /// What the blocks beyond the next group will need. The packs of a block ask for a block, each for a part of it.
  HWY_INLINE void ask_beyond(std::size_t at, PackState& state) const {
    const std::size_t blocks = kBlocksBeyond + (packs_ * kLanes + in_.block - 1) / in_.block;
    const std::size_t block = std::min(at / in_.block + blocks, (in_.count - 1) / in_.block);
    const std::size_t part = block * in_.block * in_.lines + at % in_.block * in_.lines;
    const T* arrays[3] = {in_.normal_x, in_.normal_y, in_.offset};
    for (std::size_t k = 0; k < 3; ++k) state.ahead[k].beyond = arrays[k] + part;
  }

  /// `Iota` from what is not a constant is stored lane by lane.
  static HWY_INLINE auto numbers_from(std::size_t at) {
    const hn::RebindToUnsigned<D> d;
    return hn::Add(hn::Iota(d, 0), hn::Set(d, static_cast<U>(at)));
  }

  static HWY_INLINE V load_counts(const std::int32_t* counts) {
    const auto words = hn::LoadU(hn::Rebind<std::int32_t, D>(), counts);
    if constexpr (sizeof(T) == 8)
      return hn::PromoteTo(D(), words);
    else
      return hn::ConvertTo(D(), words);
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
      stage_[state + 3 * kLanes + lane] = kHard && in_.hard ? static_cast<T>(in_.hard[i]) : T(0);
    }
    PackStates states;
    Pack<D>& p = states[0].pack;
    p.px = hn::LoadU(d, stage_ + state);
    p.py = hn::LoadU(d, stage_ + state + kLanes);
    p.speed = hn::LoadU(d, stage_ + state + 2 * kLanes);
    p.hard_count = hn::LoadU(d, stage_ + state + 3 * kLanes);
    p.id = numbers_from(at);
    states[0].rows = {stage_, stage_ + kLanes, stage_ + 2 * kLanes, 3 * kLanes, in_.lines};
    states[0].begin(hn::FirstN(d, count));
    std::fill_n(states[0].ahead, 3, Ahead<T>{stage_, stage_});
    solve(states, 1);
    leave(states[0], doubtful(states[0].pack, hn::AndNot(states[0].gone, states[0].lanes)));
    number_optima(states[0]);
    finish_some(p, hn::AndNot(states[0].gone, states[0].lanes));
    flush_deferred();
  }

  /// All that waits for the general relaxation phase.
  void flush_deferred() {
    const D d;
    const std::size_t size = rare_.size();
    rare_.clear();
    for (std::size_t from = 0; from < size; from += kLanes) {
      const M lanes = hn::FirstN(d, std::min(kLanes, size - from));
      Pack<D> p;
      rare_.load(from, lanes, p);
      number_lines(p);
      Descent<D> descent(p);
      descent.template run<kHard, kNumbers>(rare_.rows(from), lanes);
      const M left = hn::And(lanes, hn::Or(descent.unsettled, doubtful(p, lanes)));
      finish_some(p, hn::AndNot(left, lanes));
      leave(p, left);
    }
  }

  /// Lanes that relax and violate nothing: within the slack they contradict, but perhaps not at all. In float that is
  /// no less true of the lines, which were rounded.
  static HWY_INLINE M doubtful(const Pack<D>& p, M which) {
    if (sizeof(T) < 8) return p.none();
    return hn::And(hn::And(which, p.relaxing), hn::Le(p.level, hn::Zero(D())));
  }

  void leave(PackState& state, M which) {
    if (hn::AllFalse(D(), which)) return;
    state.gone = hn::Or(state.gone, which);
    state.answered = hn::Or(state.answered, which);
    leave(state.pack, which);
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
  HWY_INLINE void finish(PackState& state, std::size_t at) {
    const D d;
    const Pack<D>& p = state.pack;
    leave(state, doubtful(p, hn::AndNot(state.gone, state.lanes)));
    number_optima(state);
    const M done = hn::AndNot(state.gone, state.lanes);
    if (!hn::AllFalse(d, state.answered)) return finish_some(p, done);
    hn::StoreU(p.vx, d, out_.velocity_x + at);
    hn::StoreU(p.vy, d, out_.velocity_y + at);
    hn::StoreU(violation(p), d, out_.violation + at);
    const std::uint64_t relaxed = bits_of(d, p.relaxing);
    if (relaxed == 0)
      std::memset(out_.status + at, 0, kLanes);
    else
      for (std::size_t lane = 0; lane < kLanes; ++lane) out_.status[at + lane] = relaxed >> lane & 1U;
    if (kNumbers && out_.active) put_active(p, done);
    if (!proves()) return;
    std::memset(out_.proven + at, 1, kLanes);
    leave_unproven(p, done);
  }

  /// Lanes that did not relax have no numbers yet.
  HWY_INLINE void number_optima(PackState& state) const {
    if (kHard && out_.active) number_basis(state.rows, in_.lines, hn::Not(state.pack.relaxing), state.pack);
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
      if (proves()) out_.proven[i] = 1;
    }
    if (kNumbers && out_.active) put_active(p, done);
    if (proves()) leave_unproven(p, done);
  }

  HWY_INLINE bool proves() const { return kMayProve && out_.proven; }

  HWY_NOINLINE void leave_unproven(const Pack<D>& p, M done) {
    if constexpr (kMayProve) {
      const D d;
      const M relaxed = hn::And(done, p.relaxing), optimal = hn::AndNot(p.relaxing, done);
      if (!hn::AllFalse(d, optimal)) leave(p, hn::AndNot(Proof<D>(p).optimum(), optimal));
      if (!hn::AllFalse(d, relaxed)) leave(p, hn::AndNot(Proof<D>(p).relaxation(), relaxed));
    }
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
  bool asks_beyond_;
  BatchCounts counts_;
};

}  // namespace exactvo::lp::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
