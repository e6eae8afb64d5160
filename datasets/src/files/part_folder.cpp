// SPDX-License-Identifier: GPL-3.0-or-later
#include "exactvo/datasets/part_folder.h"

#include "exactvo/datasets/atomic_file.h"
#include "exactvo/datasets/provenance.h"
#include "files/system_error.h"
#include "files/text_file.h"

namespace exactvo::datasets {
namespace {

/// The first line of a sealed text.
std::string seal(std::string_view key, std::string_view text) {
  return "exactvo-part " + sha256_of(key) + " " + sha256_of(text) + "\n";
}

}  // namespace

void PartFolder::create() const {
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw cannot_write(folder_, error.value());
}

bool PartFolder::has(const std::filesystem::path& file) const {
  std::error_code error;
  return std::filesystem::is_regular_file(file, error);
}

void PartFolder::write(const std::filesystem::path& file, std::string_view bytes) const {
  std::error_code error;
  if (!std::filesystem::is_directory(folder_, error)) {
    throw DataError(DataCode::file_unwritable, file.string(), "", "the folder removed during the run",
                    "a folder that stays where it is");
  }
  // A rename that a power cut takes back is a part that is made again; no need to sync the folder each time.
  write_file_atomically(file, bytes, Durability::content);
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
