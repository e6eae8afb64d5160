// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Runs the program `exactvo` in a folder of its own, as a user would.

#include <filesystem>
#include <map>
#include <string>

namespace exactvo::test {

struct Outcome {
  int status = -1;  ///< exit status; -1 where a signal ended it
  std::string out;
  std::string err;
};

/// A fresh folder that goes with the object.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

  const std::filesystem::path& path() const { return path_; }
  void write(const std::string& name, const std::string& text) const;
  std::string read(const std::string& name) const;
  bool has(const std::string& name) const { return std::filesystem::exists(path_ / name); }
  /// Every file below `folder` by its relative name, with its text.
  std::map<std::string, std::string> files(const std::string& folder) const;

  /// `arguments` as for a shell, which starts in the folder; `environment` goes before the command ("PATH=/nowhere").
  Outcome run(const std::string& arguments, const std::string& environment = "") const;

 private:
  std::filesystem::path path_;
};

/// `text` without what may differ between two equal runs: values of "wall_time" and "written_at".
std::string without_times(std::string text);

/// A file of datasets/data.
std::string data_file(const std::string& name);

}  // namespace exactvo::test
