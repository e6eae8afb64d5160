// SPDX-License-Identifier: GPL-3.0-or-later
// exactvo serve: the page of `view` on this computer, where dragging computes.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <map>
#include <utility>

#include "explorer/server.h"
#include "support/terminal.h"
#include "support/usage.h"
#include "verb.h"
#include "verbs/runs/view.h"

extern char** environ;

namespace exactvo::tools {

namespace {

struct ServeFlags {
  PageFlags page;
  int port = 0;
  bool opens = false;
};

/// By the desktop's own program. A message where there is none.
void open_in_browser(const std::string& address) {
  std::string program = "xdg-open", argument = address;
  char* words[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  int status = 0;
  const bool is_opened = ::posix_spawnp(&child, words[0], nullptr, nullptr, words, environ) == 0 &&
                         ::waitpid(child, &status, 0) == child && status == 0;
  if (!is_opened) message("no browser could be opened (xdg-open): open the address in one");
}

/// Those of the page by their keys.
OptionsOfRun options_by_key(const std::vector<MadeRun>& runs) {
  std::map<std::string, std::optional<formation::SimulationOptions>> all;
  for (const MadeRun& made : runs) all.emplace(made.shown.key, made.options);
  return [all](const std::string& key) {
    const auto found = all.find(key);
    return found == all.end() ? std::nullopt : found->second;
  };
}

ExitCode serve_page(const ServeFlags& given) {
  if (!EXACTVO_WITH_HTTP)
    throw UsageError("serve", "a program built without cpp-httplib (Debian: libcpp-httplib-dev)",
                     "one built with it; exactvo view makes a page that needs no server [E_NOT_BUILT]");
  ServeFlags flags = given;
  flags.page.limits.has_scenario = true;
  const std::vector<MadeRun> runs = page_runs(flags.page);
  HttpSite site;
  site.port = flags.port;
  std::vector<PageRun> shown;
  for (const MadeRun& made : runs) shown.push_back(made.shown);
  site.page = page_for_server(explorer_page(shown, flags.page.runs.empty()));
  site.ready = [&](const std::string& address) {
    print(address + "\n");
    message("open this address in a browser on this computer; Ctrl-C ends the server");
    if (flags.opens) open_in_browser(address);
  };
  serve(std::move(site), options_by_key(runs));
  message("stopped");
  return ExitCode::success;
}

void declare_serve(CLI::App& app, ServeFlags& flags) {
  declare_page_flags(
      app, flags.page, 1,
      "A scenario, which is run with every half-plane, the folder of a run, or a recording (.jsonl, of a "
      "crowd .evr); none: three scenes to start from");
  app.add_option("--port", flags.port, "Port of 127.0.0.1; 0: any free port")
      ->capture_default_str()
      ->check(CLI::Range(0, 65535));
  app.add_flag("--open", flags.opens, "Open the address in the desktop's browser (xdg-open)");
}

}  // namespace

Verb serve_verb() {
  return {"serve", "Show the page of view with the program behind it, so that you can drag things; Ctrl-C ends it",
          "  exactvo serve --open\n"
          "  exactvo serve datasets/data/paper/A7.json\n"
          "  exactvo serve out/A7 --port 8080\n"
          "    (status 0 when Ctrl-C or SIGTERM ends the server)\n",
          with_flags(declare_serve, serve_page)};
}

}  // namespace exactvo::tools
