// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// What server.h and the module that speaks HTTP (http_server.cpp) say to each other. The module alone is linked with
/// cpp-httplib, which brings OpenSSL along: 2 ms at every start of the program, whatever its verb.

#include <functional>
#include <string>
#include <vector>

namespace exactvo::tools {

/// What a question is answered with.
struct HttpAnswer {
  int status = 200;
  std::string body;
  std::string type;    ///< "application/json"
  std::string timing;  ///< of the header Server-Timing
};

struct HttpQuestion {
  std::string path;  ///< "decide", below the token
  /// From the body of a POST. Throws nothing; called by several threads at a time.
  std::function<HttpAnswer(const std::string& body)> answer;
};

struct HttpSite {
  int port = 0;        ///< of 127.0.0.1; 0: one that is free
  std::string page;    ///< HTML
  std::string policy;  ///< Content-Security-Policy
  std::vector<HttpQuestion> questions;
  bool (*is_interrupted)() = nullptr;  ///< asked by all threads
  /// Called once, when connections are taken. "http://127.0.0.1:PORT/TOKEN/".
  std::function<void(const std::string& address)> ready;
};

/// What the module gives: serves the site until it is interrupted; false where the port cannot be had.
using ServeHttp = bool (*)(const HttpSite& site);

}  // namespace exactvo::tools
