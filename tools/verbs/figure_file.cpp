// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs/figure_file.h"

#include "support/files.h"
#include "support/run.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace fs = std::filesystem;

void check_figure_name(const std::string& name) {
  if (!name.empty() && fs::path(name).extension() != ".svg")
    throw UsageError("--figure", name, "a name that ends in .svg");
}

void write_figure(const Figure& figure, const fs::path& out) {
  const fs::path parent = fs::absolute(out).parent_path();
  make_folder(parent);
  StagedFolder folder(parent / ("." + figure.name + ".figure"), out);
  draw({write_sources(figure, folder.path())});
  for (const char* extension : {".dat", ".gp", ".png", ".svg"}) {
    const std::string name = figure.name + extension;
    if (fs::exists(folder.path() / name)) fs::rename(folder.path() / name, parent / name);
  }
  message("wrote " + out.string());
}

}  // namespace exactvo::tools
