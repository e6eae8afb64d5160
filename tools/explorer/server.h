// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The page of `exactvo serve` over HTTP, for the person at this computer alone: on 127.0.0.1 only, below a random
/// token of 128 bits. A request is answered only if its Host is this server's own (a page of another origin that has
/// its name resolve to 127.0.0.1 does not get in), its Origin, where it has one, too, and its token the right one.
/// Requests are bounded in size and time, connections in number. Nothing is read from disk: the page is in memory, and
/// what is asked for is computed from the request (live.h).
///
/// Built where cpp-httplib is; elsewhere `has_http` is false and `serve` throws.

#include <functional>
#include <string>

#include "explorer/live.h"

namespace exactvo::tools {

/// Whether this build has a server.
bool has_http();

/// The page of cmake/EmbedExplorer.cmake with requests to its own server allowed, and to nothing else.
std::string page_for_server(std::string page);

struct ServerOptions {
  int port = 0;             ///< 0: one that is free
  std::string page;         ///< HTML
  OptionsOfRun options_of;  ///< of the runs in it
  /// Called once, when connections are taken. "http://127.0.0.1:PORT/TOKEN/".
  std::function<void(const std::string& address)> ready;
};

/// Until the user interrupts it. Throws UsageError where the port cannot be had.
void serve(const ServerOptions& options);

}  // namespace exactvo::tools
