// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/plan/journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <thread>

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/data_error.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/counted.h"
#include "files/file_names.h"
#include "files/system_error.h"
#include "files/text_file.h"
#include "json/json_text.h"

namespace exactvo::datasets::batch {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFinal = "final.";
/// Between two questions for the lock: short to who presses a key, long to a processor.
constexpr std::chrono::milliseconds kBetweenLooks{20};

std::string number_text(std::size_t number) {
  char text[24];
  std::snprintf(text, sizeof text, "%06zu", number);
  return text;
}

DataError other_run(const fs::path& path, const std::string& found, const std::string& expected) {
  return {DataCode::other_run, path.string(), "", found, expected};
}

std::string text_at(const Json& object, const char* key) {
  const auto at = object.find(key);
  return at != object.end() && at->is_string() ? at->get<std::string>() : std::string();
}

void refuse_other_inputs(const Json& there, const Identity& identity, const fs::path& path) {
  const std::string file = path.string();
  const JsonCursor inputs = JsonCursor(there, file, "").at("inputs");
  const std::size_t count = inputs.size();
  if (count != identity.inputs.size()) {
    throw other_run(
        path, "an output of " + geometry::counted(count, "input"),
        geometry::counted(identity.inputs.size(), "input") + " as named now; another --out, or an empty one");
  }
  for (std::size_t k = 0; k < count; ++k) {
    const Input& input = identity.inputs[k];
    Input before;
    read_value(inputs.at(k), before);
    if (before.name == input.name && before.hashes == input.hashes) continue;
    throw other_run(path, "an output of " + before.name + " as it was",
                    input.name + " as it is now; another --out, or an empty one");
  }
}

/// "/repair false": the first option in which they differ, as it stands in `there`.
std::string option_that_differs(const Json& there, const Json& now) {
  const Json changes = Json::diff(there, now);
  if (changes.empty()) return "";
  const Json::json_pointer path(changes.front().at("path").get<std::string>());
  return path.to_string() + " " + (there.contains(path) ? there.at(path).dump() : "not given");
}

DataError other_options(const Json& there, const Identity& identity, const fs::path& path) {
  const auto options = there.find("configuration");
  const std::string differs =
      options != there.end() ? option_that_differs(*options, parse_json(identity.configuration, path.string())) : "";
  return other_run(path, "an output of other options" + (differs.empty() ? "" : ": " + differs),
                   "the same options; another --out, or an empty one");
}

/// `there` is run.json or summary.json: both hold these members.
void refuse_other_batch(const Json& there, const Identity& identity, const fs::path& path) {
  const std::string release = text_at(there, "version") + " " + text_at(there, "commit");
  if (release != identity.version + " " + identity.commit) {
    throw other_run(path, "an output of version " + release,
                    "version " + identity.version + " " + identity.commit + "; another --out, or an empty one");
  }
  if (text_at(there, "configuration_sha256") != sha256_of(identity.configuration)) {
    throw other_options(there, identity, path);
  }
  refuse_other_inputs(there, identity, path);
}

bool holds_nothing_but(const fs::path& folder, const fs::path& allowed) {
  std::error_code error;
  if (!fs::exists(folder, error)) return true;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path() != allowed) return false;
  }
  return true;
}

void rename_or_throw(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw cannot_write(to, error.value());
}

void remove_or_throw(const fs::path& path) {
  std::error_code error;
  fs::remove(path, error);
  if (error) throw cannot_write(path, error.value());
}

/// In order.
std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (auto at = fs::directory_iterator(folder, error); !error && at != fs::directory_iterator(); at.increment(error)) {
    names.push_back(at->path().filename().string());
  }
  if (error) throw cannot_write(folder, error.value());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

bool is_of_a_batch(const fs::path& file) {
  // What stands before this member is counts, a code and two numbers each.
  constexpr std::size_t kBeginning = std::size_t{1} << 16;
  if (!is_regular(file)) return false;
  try {
    return read_beginning(file, kBeginning).find("\n  \"configuration_sha256\": \"") != std::string::npos;
  } catch (const DataError&) {
    return false;
  }
}

std::string to_json(const Identity& identity) {
  JsonWriter json(JsonWriter::Layout::indented);
  json.begin_object().member("version", identity.version).member("commit", identity.commit);
  json.member("configuration_sha256", sha256_of(identity.configuration));
  json.key("configuration").raw(identity.configuration);
  return json.member("inputs", identity.inputs).end_object().take() + "\n";
}

Journal::Journal(fs::path out)
    : out_(std::move(out)), parts_(out_ / ".parts"), final_(parts_.path() / (kFinal + unique_word())) {}

Journal::State Journal::look(const Identity& identity, bool resume) const {
  std::error_code error;
  if (fs::exists(out_, error) && !fs::is_directory(out_, error)) {
    throw DataError(DataCode::file_unwritable, out_.string(), "", "a file of that name", "a folder to write to");
  }
  fs::remove_all(stale_parts(), error);
  if (is_open()) {
    if (!resume) {
      throw other_run(
          out_, "an unfinished batch",
          "--resume to go on with it, or to join the process at work on it; another --out, or an empty one");
    }
    require_same(identity);
    return State::unfinished;
  }
  const fs::path summary = out_ / "summary.json";
  if (is_of_a_batch(summary)) {
    if (!resume) return State::fresh;
    refuse_other_batch(parse_json(read_text_file(summary), summary.string()), identity, summary);
    return State::complete;
  }
  if (holds_nothing_but(out_, parts_.path())) return State::fresh;
  throw DataError(DataCode::file_unwritable, out_.string(), "",
                  "a folder with other files in it, and no summary.json of a batch",
                  "a folder that does not exist, is empty, or holds an earlier output");
}

void Journal::begin(const Identity& identity) const {
  std::error_code error;
  fs::create_directories(parts_.path(), error);
  if (error) throw cannot_write(out_, error.value());
  if (!is_open()) write_file_atomically(run_file(), to_json(identity));
}

void Journal::require_same(const Identity& identity) const {
  refuse_other_batch(parse_json(read_text_file(run_file()), run_file().string()), identity, run_file());
}

fs::path Journal::part(std::size_t input, std::size_t chunk) const {
  return parts_.path() / number_text(input) / number_text(chunk);
}

fs::path Journal::input_facts(std::size_t input) const {
  return parts_.path() / (number_text(input) + ".input");
}

bool Journal::another_finished(const Identity& identity) const {
  if (is_open() || !is_there(out_ / "summary.json")) return false;
  try {
    return look(identity, true) == State::complete;
  } catch (const DataError&) {
    return false;
  }
}

Journal::~Journal() {
  if (lock_file_ >= 0) ::close(lock_file_);
}

// Asked again and again: a call that waits is resumed after a signal, and the user could not stop it.
Journal::Lock Journal::lock(const std::function<bool()>& keep_waiting) {
  if (lock_file_ >= 0) return Lock::held;
  const fs::path path = parts_.path() / "lock";
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0 && !is_there(path) && is_open()) throw cannot_write(path, errno);
  Lock state = Lock::unlockable;
  while (file >= 0) {
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) {
      lock_file_ = file;
      return Lock::held;
    }
    const bool is_taken = errno == EWOULDBLOCK || errno == EINTR;
    if (is_taken) state = Lock::taken;
    if (!is_taken || !keep_waiting()) break;
    std::this_thread::sleep_for(kBetweenLooks);
  }
  if (file >= 0) ::close(file);
  return state;
}

void Journal::start_final() const {
  if (lock_file_ >= 0) {
    std::error_code ignored;
    for (const std::string& name : names_in(parts_.path())) {
      if (name.rfind(kFinal, 0) == 0) fs::remove_all(parts_.path() / name, ignored);
    }
  }
  std::error_code error;
  fs::create_directory(final_, error);
  if (error) throw cannot_write(final_, error.value());
}

void Journal::publish(const std::string& last, const std::function<bool(const std::string&)>& is_output) const {
  std::vector<std::string> names = names_in(final_);
  names.erase(std::remove(names.begin(), names.end(), last), names.end());
  for (const std::string& name : names) rename_or_throw(final_ / name, out_ / name);
  for (const std::string& name : names_in(out_)) {
    const bool is_ours = name == last || std::binary_search(names.begin(), names.end(), name);
    if (!is_ours && is_output(name)) remove_or_throw(out_ / name);
  }
  rename_or_throw(final_ / last, out_ / last);
  sync_directory(out_);
  rename_or_throw(parts_.path(), stale_parts());
  std::error_code ignored;
  fs::remove_all(stale_parts(), ignored);
}

}  // namespace exactvo::datasets::batch
