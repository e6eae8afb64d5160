// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <utility>

#include "exactvo/datasets/part_folder.h"
#include "exactvo/datasets/provenance.h"
#include "exactvo/geometry/require.h"
#include "files/file_names.h"
#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets {

namespace {

/// Bytes kept back before a write call.
constexpr std::size_t kBufferSize = std::size_t{1} << 18;
/// Bytes of a large file that are sent on to the disk while the rest is being made; `commit` then waits for less.
constexpr std::size_t kSentAtOnce = std::size_t{1} << 22;

void make_directories(const std::filesystem::path& directory) {
  if (directory.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(directory, error);
  if (error) throw cannot_write(directory, error.value());
}

/// The rename would put a file in the place of a pipe or a device: /dev/null would be one from then on.
void refuse_irregular(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return;
  const char* found = std::filesystem::is_directory(status) ? "a directory" : "a pipe, a socket or a device";
  throw DataError(DataCode::file_unwritable, path.string(), "", found, "the name of a file");
}

void write_fully(const std::filesystem::path& path, int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw cannot_write(path, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// The first line of a sealed text.
std::string seal(std::string_view key, std::string_view text) {
  return "exactvo-part " + sha256_of(key) + " " + sha256_of(text) + "\n";
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path path, MissingFolder missing, Unfinished unfinished, Pipe pipe)
    : path_(std::move(path)), unfinished_(unfinished) {
  if (pipe == Pipe::is_written && (path_ == "-" || is_pipe(path_))) {
    path_ == "-" ? open_standard_output() : open_pipe();
    return;
  }
  refuse_irregular(path_);
  if (missing == MissingFolder::is_made) make_directories(path_.parent_path());
  if (unfinished_ == Unfinished::stays) {
    open_unfinished();
    return;
  }
  // A name of its own keeps programs that write the same file apart, on whatever machines; the later rename wins,
  // whole.
  do {
    temporary_ = path_;
    temporary_ += ".part." + unique_word();
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && (errno == EEXIST || errno == EINTR));
  if (descriptor_ < 0) throw cannot_write(path_, errno);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  if (unfinished_ == Unfinished::goes && !temporary_.empty()) ::unlink(temporary_.c_str());
}

/// Waits for a reader, or a signal.
void AtomicFile::open_pipe() {
  while ((descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC)) < 0 && errno == EINTR) call_wait_hook();
  if (descriptor_ < 0) throw cannot_write(path_, errno);
}

void AtomicFile::open_standard_output() {
  path_ = "standard output";
  descriptor_ = ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 0);
  if (descriptor_ < 0) throw cannot_write(path_, errno);
}

/// Locked: two processes that append to one file would spoil it.
void AtomicFile::open_unfinished() {
  temporary_ = unfinished_name(path_);
  do {
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0) throw cannot_write(path_, errno);
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(std::exchange(descriptor_, -1));
  throw DataError(DataCode::file_unwritable, path_.string(), "", "another process that writes it",
                  "one at a time, or another name");
}

void AtomicFile::continue_behind(std::uint64_t size) {
  const ::off_t there = ::lseek(descriptor_, 0, SEEK_END);
  if (there < 0) throw cannot_write(path_, errno);
  if (static_cast<std::uint64_t>(there) < size)
    throw DataError(DataCode::format_syntax, temporary_.string(), "byte " + std::to_string(there), "its end too early",
                    std::to_string(size) + " bytes, as its snapshot has it");
  if (::ftruncate(descriptor_, static_cast<::off_t>(size)) != 0 || ::lseek(descriptor_, 0, SEEK_END) < 0)
    throw cannot_write(path_, errno);
}

void AtomicFile::sync() {
  flush();
  if (::fsync(descriptor_) != 0) throw cannot_write(path_, errno);
}

void AtomicFile::flush() {
  put(buffer_);
  buffer_.clear();
}

void AtomicFile::put(std::string_view bytes) {
  write_fully(path_, descriptor_, bytes);
  unsent_ += bytes.size();
  if (unsent_ < kSentAtOnce) return;
  ::sync_file_range(descriptor_, 0, 0, SYNC_FILE_RANGE_WRITE);  // a hint: its failure is fsync's to find
  unsent_ = 0;
}

void AtomicFile::write(std::string_view bytes) {
  EXACTVO_REQUIRE(descriptor_ >= 0, "a write after commit to " + path_.string());
  if (buffer_.capacity() < kBufferSize) buffer_.reserve(kBufferSize);  // once: growing would copy it again and again
  if (buffer_.size() + bytes.size() >= kBufferSize) flush();
  if (bytes.size() >= kBufferSize) return put(bytes);  // uncopied
  buffer_ += bytes;
}

void AtomicFile::commit(Durability durability) {
  EXACTVO_REQUIRE(descriptor_ >= 0, "a second commit of " + path_.string());
  flush();
  if (temporary_.empty()) {
    ::close(std::exchange(descriptor_, -1));
    return;
  }
  if (::fsync(descriptor_) != 0) throw cannot_write(path_, errno);
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) throw cannot_write(path_, errno);
  ::close(std::exchange(descriptor_, -1));
  if (durability == Durability::name) sync_directory(path_.parent_path());
}

std::filesystem::path unfinished_name(std::filesystem::path path) {
  return path += ".unfinished";
}

// A rename is durable only once its directory is.
void sync_directory(const std::filesystem::path& directory) {
  const int descriptor = ::open(directory.empty() ? "." : directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

void write_file_atomically(const std::filesystem::path& path, std::string_view bytes, Durability durability) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit(durability);
}

void PartFolder::create() const {
  make_directories(folder_);
}

bool PartFolder::has(const std::filesystem::path& file) const {
  return is_regular(file);
}

void PartFolder::write(const std::filesystem::path& file, std::string_view bytes) const {
  std::error_code error;
  if (!std::filesystem::is_directory(folder_, error)) {
    throw DataError(DataCode::file_unwritable, file.string(), "", "the folder removed during the run",
                    "a folder that stays where it is");
  }
  make_directories(file.parent_path());
  std::filesystem::path temporary = file;
  temporary += ".part." + unique_word();
  std::ofstream out(temporary, std::ios::binary);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  const bool is_there = static_cast<bool>(out) && ::rename(temporary.c_str(), file.c_str()) == 0;
  const int failed = errno;
  if (is_there) return;
  ::unlink(temporary.c_str());
  throw cannot_write(file, failed);
}

void PartFolder::write_sealed(const std::filesystem::path& file, std::string_view key, std::string_view text) const {
  write(file, seal(key, text) + std::string(text));
}

std::optional<std::string> PartFolder::read_sealed(const std::filesystem::path& file, std::string_view key) const {
  if (!has(file)) return std::nullopt;
  std::string all = read_text_file(file);
  const std::size_t end = all.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string text = all.substr(end + 1);
  all.resize(end + 1);
  if (all != seal(key, text)) return std::nullopt;
  return text;
}

}  // namespace exactvo::datasets
