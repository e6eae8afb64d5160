// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_program.h"

#include <stdlib.h>  // mkdtemp
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace exactvo::test {

namespace fs = std::filesystem;

Workplace::Workplace() {
  std::string name = (fs::temp_directory_path() / "exactvo_test_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder " + name);
  path_ = name;
}

Workplace::~Workplace() {
  fs::remove_all(path_);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  std::filesystem::create_directories((path_ / name).parent_path());
  std::ofstream(path_ / name, std::ios::binary) << text;
}

std::string Workplace::read(const std::string& name) const {
  std::ifstream file(path_ / name, std::ios::binary);
  if (!file) throw std::runtime_error("no file " + (path_ / name).string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::map<std::string, std::string> Workplace::files(const std::string& folder) const {
  std::map<std::string, std::string> result;
  for (const auto& entry : fs::recursive_directory_iterator(path_ / folder)) {
    const std::string name = entry.path().lexically_relative(path_ / folder).string();
    if (!entry.is_directory()) result[name] = read(folder + "/" + name);
  }
  return result;
}

Outcome Workplace::run(const std::string& arguments, const std::string& environment) const {
  const std::string command =
      "cd '" + path_.string() + "' && " + environment + " '" EXACTVO_PROGRAM "' " + arguments + " >.stdout 2>.stderr";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(".stdout"), read(".stderr")};
}

std::string without_times(std::string text) {
  text = std::regex_replace(text, std::regex("(\"wall_time\": *)[-+.0-9e]+"), "$1T");
  return std::regex_replace(text, std::regex("(\"written_at\": *)\"[^\"]*\""), "$1T");
}

std::string data_file(const std::string& name) {
  return std::string(EXACTVO_SOURCE_DIR "/datasets/data/") + name;
}

}  // namespace exactvo::test
