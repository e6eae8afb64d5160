// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/parts.h"

#include <fmt/format.h>

#include "exactvo/datasets/ordered_work.h"
#include "exactvo/datasets/part_folder.h"
#include "exactvo/datasets/provenance.h"
#include "support/terminal.h"

namespace exactvo::tools {
namespace {

namespace fs = std::filesystem;

/// On a terminal's line, or in a message now and then.
void show(std::size_t done, std::size_t parts, const std::string& doing, ProgressLine& line) {
  if (!line.is_due()) return;
  line.show(static_cast<double>(done), doing);
  if (line.enabled()) return;
  message(fmt::format("{} of {} parts, about {:.0f} s left", done, parts,
                      line.elapsed() * static_cast<double>(parts - done) / static_cast<double>(done)));
}

}  // namespace

std::vector<std::string> run_parts(const std::vector<PartTask>& tasks, const fs::path& path, const std::string& key,
                                   unsigned jobs) {
  const datasets::PartFolder folder(path);
  folder.create();
  const auto file_of = [&](std::size_t task) { return folder.path(tasks[task].name + ".part"); };
  std::vector<std::string> texts(tasks.size());
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    std::optional<std::string> text = folder.read_sealed(file_of(i), key);
    if (!text) open.push_back(i);
    texts[i] = std::move(text).value_or("");
  }
  if (!open.empty() && open.size() < tasks.size())
    message(fmt::format("{} of {} parts are there already", tasks.size() - open.size(), tasks.size()));
  ProgressLine line(static_cast<double>(open.size()), "parts");
  std::size_t next = 0;
  std::size_t done = 0;
  datasets::run_in_order(static_cast<int>(jobs), [&]() -> std::optional<datasets::OrderedTask> {
    if (interrupted() || next == open.size()) return std::nullopt;
    const std::size_t i = open[next++];
    const auto work = [&, i] {
      texts[i] = tasks[i].work();
      if (!interrupted()) folder.write_sealed(file_of(i), key, texts[i]);  // what was cut short is no part
    };
    return datasets::OrderedTask{work, [&, i] { show(++done, open.size(), tasks[i].name, line); }};
  });
  if (interrupted()) throw Interrupted();
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
