// SPDX-License-Identifier: GPL-3.0-or-later
// Everything that the handler calls is a system call: no allocation, no lock, no stdio.
#include "support/stop.h"

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <climits>
#include <csignal>
#include <cstring>

#include "support/terminal.h"

namespace exactvo::tools {

namespace {

std::atomic<int> at_once{0};
std::atomic<const char*> termination_words{""};
std::array<std::atomic<pid_t>, kMostChildren> children{};  ///< 0: none

struct Slot {
  std::atomic<bool> is_taken{false};
  std::atomic<bool> is_set{false};
  char path[PATH_MAX] = {};
};
std::array<Slot, 16> slots;

static_assert(std::atomic<int>::is_always_lock_free && std::atomic<const char*>::is_always_lock_free &&
                  std::atomic<bool>::is_always_lock_free,
              "a signal handler reads them");

/// By a process of its own: a handler allocates nothing, and other threads may go on writing meanwhile.
void remove_folder(const char* path) {
  for (int pass = 0; pass < 4 && ::access(path, F_OK) == 0; ++pass) {
    const pid_t child = ::_Fork();
    if (child == 0) {
      ::execl("/bin/rm", "rm", "-rf", "--", path, nullptr);
      ::_exit(127);
    }
    if (child > 0) ::waitpid(child, nullptr, 0);
  }
}

}  // namespace

TerminateOnSignal::TerminateOnSignal(const char* words) {
  termination_words = words;
  ++at_once;
  if (!interrupted()) return;
  --at_once;
  throw Interrupted();  // it came before, and nothing would look at it
}
TerminateOnSignal::~TerminateOnSignal() {
  --at_once;
}
const char* words_of_termination() {
  return at_once > 0 ? termination_words.load() : nullptr;
}

RemoveFolderOnSignal::RemoveFolderOnSignal(const std::string& folder) : slot_(-1) {
  if (folder.size() >= PATH_MAX) return;
  for (std::size_t k = 0; k < slots.size() && slot_ < 0; ++k)
    if (!slots[k].is_taken.exchange(true)) slot_ = static_cast<int>(k);
  if (slot_ < 0) return;
  Slot& mine = slots[static_cast<std::size_t>(slot_)];
  std::memcpy(mine.path, folder.c_str(), folder.size() + 1);
  mine.is_set = true;
}

RemoveFolderOnSignal::~RemoveFolderOnSignal() {
  if (slot_ < 0) return;
  Slot& mine = slots[static_cast<std::size_t>(slot_)];
  while (!mine.is_set.exchange(false)) ::pause();  // a handler in another thread has taken it: the program ends
  mine.is_taken = false;
}

void KillChildrenOnSignal::add(pid_t child) {
  children.at(count_++) = child;
}
KillChildrenOnSignal::~KillChildrenOnSignal() {
  for (std::atomic<pid_t>& child : children) child = 0;
}

void write_words(const char* words) {
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, words, std::strlen(words));
}

void remove_what_is_unfinished() {
  for (const std::atomic<pid_t>& child : children)
    if (child > 0) ::kill(child, SIGKILL);
  for (const std::atomic<pid_t>& child : children)
    if (child > 0) ::waitpid(child, nullptr, 0);
  for (Slot& slot : slots)
    if (slot.is_set.exchange(false)) remove_folder(slot.path);
}

}  // namespace exactvo::tools
