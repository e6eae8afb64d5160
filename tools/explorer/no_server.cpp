// SPDX-License-Identifier: GPL-3.0-or-later
// Built in place of server.cpp where there is no cpp-httplib.
#include <stdexcept>

#include "explorer/server.h"

namespace exactvo::tools {

bool has_http() {
  return false;
}

std::string page_for_server(std::string page) {
  return page;
}

void serve(const ServerOptions&) {
  throw std::logic_error("this build has no server");
}

}  // namespace exactvo::tools
