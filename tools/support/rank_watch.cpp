// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that the handlers call is a system call: no allocation, no lock, no stdio.
#include "support/rank_watch.h"

#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <sstream>
#include <string>
#include <vector>

#include "support/stop.h"

namespace exactvo::tools {

namespace {

constexpr std::size_t kMostWatched = 4096;

std::atomic<bool> watching{false};
std::atomic<bool> has_snapshots{false};
int own_rank = 0, all_ranks = 1;
pid_t process_of[kMostWatched];  ///< by rank; 0: on another machine

/// Milliseconds to the end: the first rank says what it sees before the others end by themselves, and outlasts the
/// second.
constexpr int kFirst = 350, kSecond = 500, kOthers = 700, kAfterWords = 400;

std::string machine() {
  char name[256] = {};
  ::gethostname(name, sizeof name - 1);
  return name;
}

bool is_gone(int rank) {
  const pid_t process = process_of[rank];
  return process != 0 && ::kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

RankWatch::RankWatch(formation::Ranks& ranks) {
  const std::vector<std::string> given = ranks.gather(fmt::format("{} {}\n", machine(), ::getpid()));
  std::string lines;
  for (const std::string& line : given) lines += line;
  std::istringstream all(ranks.broadcast(lines));
  std::string where;
  pid_t process = 0;
  std::fill(process_of, process_of + kMostWatched, 0);
  for (std::size_t rank = 0; rank < kMostWatched && all >> where >> process; ++rank)
    process_of[rank] = where == machine() ? process : 0;
  own_rank = ranks.rank();
  all_ranks = std::min(ranks.size(), static_cast<int>(kMostWatched));
  has_snapshots = false;
  watching = true;
}

RankWatch::~RankWatch() {
  watching = false;
}

void RankWatch::keeps_snapshots() {
  has_snapshots = true;
}

bool watches_ranks() {
  return watching;
}

void begin_end_of_rank() {
  const int milliseconds = own_rank == 0 ? kFirst : own_rank == 1 ? kSecond : kOthers;
  itimerval timer{};
  timer.it_value.tv_usec = 1000 * milliseconds;
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

void say_which_rank_is_lost() {
  if (own_rank > 1 || (own_rank == 1 && !is_gone(0))) return;
  write_words("exactvo: error: ");
  int lost = 0;
  while (lost < all_ranks && !is_gone(lost)) ++lost;
  if (lost < all_ranks) {
    const fmt::format_int rank(lost), count(all_ranks);  // each has its own buffer: nothing is allocated in a handler
    for (const char* some : {"rank ", rank.c_str(), " of ", count.c_str(), " is gone"}) write_words(some);
  } else {
    write_words("a rank is gone, or all were told to end");
  }
  write_words(has_snapshots ? "; --resume goes on from the last snapshot [E_RANK_LOST]\n"
                            : "; nothing was written [E_RANK_LOST]\n");
  if (own_rank == 0) ::usleep(1000 * kAfterWords);
}

}  // namespace exactvo::tools
