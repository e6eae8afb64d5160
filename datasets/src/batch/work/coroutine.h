// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// A function that pushes (a reader, which calls back with every obstacle) as one that is pulled from.

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace exactvo::datasets::batch {

/// Thrown through a reader that is to stop where it is.
struct Stopped {};

/// The body has a thread of its own, which runs only while another one waits in `next`: the two never run at the same
/// time, so they take one processor.
template <class T>
class Coroutine {
 public:
  using Give = std::function<void(T)>;

  /// `body` calls what it is given with one value after the other.
  explicit Coroutine(std::function<void(const Give&)> body) : thread_([this, body = std::move(body)] { run(body); }) {}
  /// A body that is not through is left by Stopped.
  ~Coroutine() {
    pass_to_body(Turn::ended);
    thread_.join();
  }
  Coroutine(const Coroutine&) = delete;
  Coroutine& operator=(const Coroutine&) = delete;

  /// None once the body is through. Throws what the body threw. From one thread at a time.
  std::optional<T> next() {
    std::unique_lock<std::mutex> lock = pass_to_body(Turn::body);
    changed_.wait(lock, [this] { return turn_ != Turn::body; });
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    return std::exchange(value_, std::nullopt);
  }

 private:
  enum class Turn { caller, body, ended };

  std::unique_lock<std::mutex> pass_to_body(Turn turn) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (turn_ != Turn::ended) turn_ = turn;
    changed_.notify_all();
    return lock;
  }

  void run(const std::function<void(const Give&)>& body) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return turn_ != Turn::caller; });
    if (turn_ == Turn::body) {
      lock.unlock();
      std::exception_ptr failure;
      try {
        body([this](T value) { give(std::move(value)); });
      } catch (...) {
        failure = std::current_exception();
      }
      lock.lock();
      failure_ = failure;
    }
    turn_ = Turn::ended;
    changed_.notify_all();
  }

  void give(T value) {
    std::unique_lock<std::mutex> lock(mutex_);
    value_ = std::move(value);
    turn_ = Turn::caller;
    changed_.notify_all();
    changed_.wait(lock, [this] { return turn_ != Turn::caller; });
    if (turn_ == Turn::ended) throw Stopped{};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  Turn turn_ = Turn::caller;
  std::optional<T> value_;
  std::exception_ptr failure_;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace exactvo::datasets::batch
