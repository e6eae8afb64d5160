// SPDX-License-Identifier: GPL-3.0-or-later
#include "figures/figure_file.h"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>
#include <vector>

#include "support/escape.h"
#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

namespace {

/// One file of a figure: what it is called where it is drawn, and what in the end.
using FigureFile = std::pair<std::string, std::string>;

constexpr const char* kFreeName =
    "a name whose .svg, .png, .pdf, .dat and .gp the command neither reads nor writes besides";

constexpr const char* kPictures[] = {".pdf", ".png", ".svg"};

bool is_picture(const fs::path& name) {
  return std::find(std::begin(kPictures), std::end(kPictures), name.extension()) != std::end(kPictures);
}

std::vector<FigureFile> files_of(const fs::path& out) {
  const std::string stem = out.stem().string(), plain = plain_name(stem);
  std::vector<FigureFile> files;
  for (const char* source : {".dat", ".gp"}) files.push_back({plain + source, plain + source});
  for (const char* picture : kPictures) files.push_back({plain + picture, stem + picture});
  return files;
}

/// By whatever name or link; also of files that are not there yet.
bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const fs::path canonical_a = fs::weakly_canonical(a, error), canonical_b = fs::weakly_canonical(b, error);
  return !canonical_a.empty() && canonical_a == canonical_b;
}

}  // namespace

void check_figure_name(const std::string& option, const std::string& name, const std::vector<fs::path>& others) {
  if (name.empty()) return;
  if (has_control_characters(name)) throw UsageError(option, name, "a name without control characters");
  if (!is_picture(name)) throw UsageError(option, name, "a name that ends in .svg, .png or .pdf");
  for (const auto& [drawn, asked] : files_of(name)) {
    const fs::path path = fs::path(name).parent_path() / asked;
    if (fs::is_directory(path)) throw UsageError(option, path.string() + ", a folder", "names that are free or files");
    for (const fs::path& other : others)
      if (is_same_file(path, other))
        throw UsageError(option, name + ", which would replace " + path.string(), kFreeName);
  }
}

void write_figure(Figure figure, const fs::path& out) {
  figure.name = plain_name(out.stem().string());
  const fs::path parent = fs::absolute(out).parent_path();
  make_folder(parent);
  StagedFolder folder(parent / "exactvo-figure", out);
  draw({write_sources(figure, folder.path())});
  const bool is_redrawn = fs::exists(parent / (figure.name + ".gp"));
  for (const auto& [drawn, asked] : files_of(out)) {
    if (fs::exists(folder.path() / drawn)) {
      fs::rename(folder.path() / drawn, parent / asked);
    } else if (is_redrawn) {
      fs::remove(parent / asked);  // an earlier one would show something else than its neighbours
    }
  }
  const fs::path script = out.parent_path() / (figure.name + ".gp");
  message("wrote " + (fs::exists(out) ? out : script).string());
}

}  // namespace exactvo::tools
