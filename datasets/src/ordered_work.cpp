// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/ordered_work.h"

#include <tbb/global_control.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <memory>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>
#endif

namespace exactvo::datasets {
namespace {

/// A task that takes long holds up the finishing of all after it, but not their work until so many wait for it.
constexpr std::size_t kMostUnfinished = 1000;

/// Tells ThreadSanitizer of what several threads take in turns: it sees nothing of oneTBB (geometry/seen_by_tsan.h).
#if defined(__SANITIZE_THREAD__)
class Turn {
 public:
  explicit Turn(const void* with) : with_(const_cast<void*>(with)) { __tsan_acquire(with_); }
  ~Turn() { __tsan_release(with_); }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  void* with_;
};
#else
struct Turn {
  explicit Turn(const void*) {}
};
#endif

struct Token {
  std::optional<OrderedTask> task;
  std::exception_ptr failure;
};
using TokenPtr = std::shared_ptr<Token>;

class Pipeline {
 public:
  explicit Pipeline(const std::function<std::optional<OrderedTask>()>& next) : next_(next) {}

  /// Null at the end.
  TokenPtr take() {
    const Turn in_order(&next_);
    if (has_failed_) return nullptr;
    auto token = std::make_shared<Token>();
    const Turn of_token(token.get());
    attempt(token->failure, [&] { token->task = next_(); });
    return token->task || token->failure ? token : nullptr;
  }

  void work(Token& token) {
    const Turn of_token(&token);
    if (!token.failure) attempt(token.failure, token.task->work);
  }

  void finish(Token& token) {
    const Turn in_order(&failure_);
    const Turn of_token(&token);
    if (failure_) return;
    failure_ = token.failure;
    if (!failure_) attempt(failure_, token.task->finish);
    token.task.reset();
  }

  void rethrow() const {
    const Turn in_order(&failure_);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  /// Nothing is thrown into oneTBB, which would drop the tasks before this one as well.
  template <class Action>
  void attempt(std::exception_ptr& failure, const Action& action) {
    try {
      action();
    } catch (...) {
      failure = std::current_exception();
      has_failed_ = true;
    }
  }

  const std::function<std::optional<OrderedTask>()>& next_;
  std::atomic<bool> has_failed_{false};
  std::exception_ptr failure_;  ///< of the first in order
};

}  // namespace

void run_in_order(int workers, const std::function<std::optional<OrderedTask>()>& next) {
  using tbb::filter_mode;
  const int threads = std::max(workers, 1);
  // As many as asked for, even if there are fewer processors.
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  Pipeline pipeline(next);
  const auto take = tbb::make_filter<void, TokenPtr>(filter_mode::serial_in_order, [&](tbb::flow_control& flow) {
    TokenPtr token = pipeline.take();
    if (!token) flow.stop();
    return token;
  });
  const auto work = tbb::make_filter<TokenPtr, TokenPtr>(filter_mode::parallel, [&](TokenPtr token) {
    pipeline.work(*token);
    return token;
  });
  const auto finish = tbb::make_filter<TokenPtr, void>(filter_mode::serial_in_order,
                                                       [&](const TokenPtr& token) { pipeline.finish(*token); });
  tbb::task_arena(threads).execute([&] { tbb::parallel_pipeline(kMostUnfinished, take & work & finish); });
  pipeline.rethrow();
}

}  // namespace exactvo::datasets
