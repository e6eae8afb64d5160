// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of `exactvo serve` asks, and its answers; http_server.cpp carries both.
#include "explorer/server.h"

#include <fmt/format.h>
#include <time.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "exactvo/datasets/data_error.h"
#include "explorer/page.h"
#include "modules/load.h"
#include "support/terminal.h"
#include "support/usage.h"

namespace exactvo::tools {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kToRun{60};  // of a run on from a moment

/// A run on from a moment gives way to the next one that is asked for.
struct GivesWay : std::runtime_error {
  GivesWay() : std::runtime_error("another run was asked for") {}
};

class RunQueue {
 public:
  std::string run(const LiveQuestion& question) {
    const unsigned mine = ++latest_;
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    const Clock::time_point until = Clock::now() + kToRun;
    return live_run(question, [&] {
      if (mine != latest_) throw GivesWay();
      if (Clock::now() > until)
        throw std::runtime_error(
            fmt::format("the run takes more than {} s: simulate it with exactvo simulate", kToRun.count()));
    });
  }

 private:
  std::atomic<unsigned> latest_{0};
  std::mutex mutex_;
};

/// s of this thread, which another process does not lengthen.
double processor_time() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

using AnswerOfPage = std::function<std::string(const LiveQuestion&)>;

/// JSON for the page.
HttpAnswer refusal(int status, const char* why, nlohmann::json more = nlohmann::json::object()) {
  more["error"] = why;
  return {status, more.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace), "application/json", ""};
}

HttpAnswer answer_untimed(const std::string& body, const OptionsOfRun& options_of, const char* type,
                          const AnswerOfPage& answer_of) {
  try {
    return {200, answer_of(parse_live_question(body, options_of)), type, ""};
  } catch (const datasets::DataError& error) {
    return refusal(400, error.what(),
                   {{"code", code_name(error.code())},
                    {"place", error.place()},
                    {"found", error.found()},
                    {"expected", error.expected()}});
  } catch (const GivesWay& error) {
    return refusal(409, error.what());
  } catch (const Interrupted&) {
    return refusal(503, "the server was stopped");
  } catch (const std::bad_alloc&) {
    return refusal(503, "more memory wanted than there is");
  } catch (const std::exception& error) {
    return refusal(500, error.what());
  }
}

HttpAnswer answer(const std::string& body, const OptionsOfRun& options_of, const char* type,
                  const AnswerOfPage& answer_of) {
  const Clock::time_point begin = Clock::now();
  const double processor_begin = processor_time();
  HttpAnswer answer = answer_untimed(body, options_of, type, answer_of);
  const std::chrono::duration<double, std::milli> took = Clock::now() - begin;
  answer.timing =
      fmt::format("compute;dur={:.2f}, processor;dur={:.2f}", took.count(), 1e3 * (processor_time() - processor_begin));
  return answer;
}

constexpr const char* kConnectNothing = "default-src 'none';";
constexpr const char* kConnectSelf = "default-src 'none'; connect-src 'self';";

/// The page's own policy as a header too, where it can also say that nobody frames it.
std::string policy() {
  return std::string(kConnectSelf) +
         " script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; media-src blob:; base-uri "
         "'none'; "
         "form-action 'none'; frame-ancestors 'none'";
}

}  // namespace

std::string page_for_server(std::string page) {
  const std::size_t at = page.find(kConnectNothing);
  if (at == std::string::npos) throw std::logic_error("the page has no policy to widen");
  page.replace(at, std::string(kConnectNothing).size(), kConnectSelf);
  const std::size_t body = page.find("<body>");
  if (body == std::string::npos) throw std::logic_error("the page has no body");
  return page.insert(body + std::string("<body>").size(), std::string("\n<script>\n") + kServedScript + "</script>");
}

void serve(HttpSite site, const OptionsOfRun& options_of) {
  RunQueue runs;
  const auto question = [&](const char* path, const char* type, AnswerOfPage answer_of) {
    return HttpQuestion{path, [&options_of, type, answer_of = std::move(answer_of)](const std::string& body) {
                          return answer(body, options_of, type, answer_of);
                        }};
  };
  const char* const packed = "application/octet-stream";
  site.policy = policy();
  site.questions = {question("decide", packed, live_decision),
                    question("free", "application/json", live_free_velocities),
                    question("run", packed, [&](const LiveQuestion& asked) { return runs.run(asked); })};
  site.is_interrupted = interrupted;
  const auto serve_http =
      *static_cast<const ServeHttp*>(datasets::load_module("http", "the server of the page (cpp-httplib)"));
  if (!serve_http(site))
    throw UsageError("--port", std::to_string(site.port), "a port of 127.0.0.1 that is free [E_PORT]");
}

}  // namespace exactvo::tools
