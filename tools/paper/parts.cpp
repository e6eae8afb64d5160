// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <fstream>
#include <iterator>
#include <mutex>
#include <optional>
#include <thread>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/provenance.h"
#include "support/terminal.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

fs::path file_of(const PartTask& task, const PartsOptions& options) {
  return options.folder / (task.name + ".part");
}

/// The first line of a part: what it was made under, and a digest of the rest.
std::string seal(const std::string& key, const std::string& text) {
  return "exactvo-part " + datasets::sha256_of(key) + " " + datasets::sha256_of(text) + "\n";
}

std::optional<std::string> finished_part(const PartTask& task, const PartsOptions& options) {
  std::ifstream file(file_of(task, options), std::ios::binary);
  if (!file) return std::nullopt;
  const std::string all{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const std::size_t end = all.find('\n');
  if (end == std::string::npos) return std::nullopt;
  const std::string text = all.substr(end + 1);
  if (all.substr(0, end + 1) != seal(options.key, text)) return std::nullopt;
  return text;
}

/// The parts still to do, handed out in order to however many threads.
class Workers {
 public:
  Workers(const std::vector<PartTask>& tasks, const PartsOptions& options, std::vector<std::string>& texts)
      : tasks_(tasks), options_(options), texts_(texts) {
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      std::optional<std::string> text = finished_part(tasks[i], options);
      if (text) {
        texts_[i] = std::move(*text);
      } else {
        open_.push_back(i);
      }
    }
  }

  std::size_t open() const { return open_.size(); }

  void run() {
    std::vector<std::thread> threads;
    const std::size_t count = std::min<std::size_t>(std::max(options_.jobs, 1u), open_.size());
    alive_ = count;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back([this] { work(); });
    watch();
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    if (interrupted()) throw Interrupted();
  }

 private:
  void work() {
    while (!stop_ && !interrupted()) {
      const std::size_t next = next_++;
      if (next >= open_.size()) break;
      try {
        do_part(open_[next]);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!failure_) failure_ = std::current_exception();
        stop_ = true;
      }
    }
    --alive_;
  }

  void do_part(std::size_t i) {
    const std::string text = tasks_[i].work();
    if (interrupted()) return;  // what was cut short is no part
    datasets::write_file_atomically(file_of(tasks_[i], options_), seal(options_.key, text) + text);
    texts_[i] = text;
    ++done_;
  }

  /// Says how far the threads have come: on a terminal always, elsewhere a line now and then.
  void watch() {
    constexpr std::chrono::milliseconds kLook{100};
    constexpr std::chrono::seconds kSay{30};
    ProgressLine line(static_cast<double>(open_.size()), "parts");
    const auto start = std::chrono::steady_clock::now();
    auto said = start;
    while (alive_ > 0) {
      const std::size_t done = done_;
      line.show(static_cast<double>(done), done < open_.size() ? tasks_[open_[done]].name : "");
      const auto now = std::chrono::steady_clock::now();
      if (now - said >= kSay && done > 0 && !line.enabled()) {
        said = now;
        const double elapsed = std::chrono::duration<double>(now - start).count();
        message(fmt::format("{} of {} parts, about {:.0f} s left", done, open_.size(),
                            elapsed * static_cast<double>(open_.size() - done) / static_cast<double>(done)));
      }
      std::this_thread::sleep_for(kLook);
    }
  }

  const std::vector<PartTask>& tasks_;
  const PartsOptions& options_;
  std::vector<std::string>& texts_;
  std::vector<std::size_t> open_;
  std::atomic<std::size_t> next_{0}, done_{0}, alive_{0};
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr failure_;
};

}  // namespace

std::vector<std::string> run_parts(const std::vector<PartTask>& tasks, const PartsOptions& options) {
  std::vector<std::string> texts(tasks.size());
  Workers workers(tasks, options, texts);
  const std::size_t kept = tasks.size() - workers.open();
  if (kept > 0 && workers.open() > 0) message(fmt::format("{} of {} parts are there already", kept, tasks.size()));
  workers.run();
  return texts;
}

std::string program_key() {
  const fs::path self = "/proc/self/exe";
  std::error_code error;
  if (fs::exists(self, error)) return datasets::sha256_of_file(self);
  const datasets::Provenance p = datasets::make_provenance({}, 0);
  return p.version + " " + p.commit + " " + p.compiler + " " + p.build_type;
}

}  // namespace exactvo::tools
