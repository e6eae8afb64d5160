// SPDX-License-Identifier: GPL-3.0-or-later
// The module of `exactvo serve`: connections and requests, with cpp-httplib. What is answered is the program's
// (server.cpp).
#include <fmt/format.h>
#include <httplib.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "explorer/http.h"
#include "modules/module.h"

namespace exactvo::tools {

namespace {

using Clock = std::chrono::steady_clock;
using httplib::Request;
using httplib::Response;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::size_t kMostBody = std::size_t{8} << 20;   // bytes of a question
constexpr std::size_t kMostHead = std::size_t{64} << 10;  // bytes of a request before its body
constexpr std::size_t kMostWaiting = 128;                 // connections that no thread has taken yet
constexpr unsigned kThreads = 16;
constexpr seconds kToAsk{5};         // from the connection to the end of the request
constexpr seconds kToTake{30};       // for the answer to be taken
constexpr milliseconds kSlice{100};  // how soon an interrupt is noticed

// --- Connections ---

/// The program's.
bool (*is_interrupted)() = nullptr;

/// When the connection came that this thread works on, and whether it is one too many.
thread_local Clock::time_point came_at;
thread_local bool is_refused = false;

/// Threads that take connections in turn. What waits was taken from the system already, so that its time runs.
class Workers : public httplib::ThreadPool {
 public:
  explicit Workers(httplib::Server& server) : ThreadPool(kThreads), server_(server) {}

  void enqueue(std::function<void()> task) override {
    stop_if_interrupted();
    is_refused = waiting_ >= kMostWaiting;
    if (is_refused) return task();
    ++waiting_;
    ThreadPool::enqueue([this, came = Clock::now(), task = std::move(task)] {
      --waiting_;
      came_at = came;
      task();
    });
  }
  /// The library calls it where no connection came for a while.
  void on_idle() override { stop_if_interrupted(); }

 private:
  void stop_if_interrupted() {
    if (is_interrupted()) server_.stop();
  }

  httplib::Server& server_;
  std::atomic<std::size_t> waiting_{0};
};

/// A connection with so much time and so many bytes for the whole request, however slowly they come.
class BoundedStream : public httplib::Stream {
 public:
  BoundedStream(int socket, Clock::time_point read_until) : socket_(socket), until_(read_until) {}

  bool is_readable() const override { return begin_ < end_ || is_ready(POLLIN); }
  bool is_writable() const override { return is_ready(POLLOUT); }

  ssize_t read(char* to, std::size_t size) override {
    if (begin_ == end_ && !fill()) return -1;
    const std::size_t count = std::min(size, end_ - begin_);
    std::copy_n(buffer_.data() + begin_, count, to);
    begin_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!is_writing_) {
      is_writing_ = true;
      until_ = Clock::now() + kToTake;
    }
    if (!is_ready(POLLOUT)) return -1;
    return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override { ip = "127.0.0.1", port = 0; }
  void get_local_ip_and_port(std::string& ip, int& port) const override { ip = "127.0.0.1", port = 0; }
  socket_t socket() const override { return socket_; }

  /// Lets the other side read the answer: a connection that is closed on unread bytes is reset.
  void end() {
    ::shutdown(socket_, SHUT_WR);
    until_ = Clock::now() + seconds(1);
    left_ = 2 * kMostBody;
    while (fill()) {
    }
  }

 private:
  bool is_ready(short what) const {
    while (!is_interrupted()) {
      const auto left = std::chrono::duration_cast<milliseconds>(until_ - Clock::now());
      if (left.count() <= 0) return false;
      pollfd one{socket_, what, 0};
      const int ready = ::poll(&one, 1, static_cast<int>(std::min(left, kSlice).count()) + 1);
      if (ready > 0) return true;
      if (ready < 0 && errno != EINTR) return false;
    }
    return false;
  }

  bool fill() {
    if (left_ == 0 || !is_ready(POLLIN)) return false;
    const ssize_t got = ::recv(socket_, buffer_.data(), std::min(left_, buffer_.size()), 0);
    if (got <= 0) return false;
    left_ -= static_cast<std::size_t>(got);
    begin_ = 0;
    end_ = static_cast<std::size_t>(got);
    return true;
  }

  int socket_;
  Clock::time_point until_;
  bool is_writing_ = false;
  std::array<char, 4096> buffer_{};
  std::size_t begin_ = 0, end_ = 0;
  std::size_t left_ = kMostHead + kMostBody;
};

/// One request per connection, in bounded time.
class Server : public httplib::Server {
 private:
  bool process_and_close_socket(socket_t socket) override {
    bool is_answered = false;
    if (!is_refused) {
      const int yes = 1;  // the head and the body of an answer are written one after the other
      ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      BoundedStream stream(socket, came_at + kToAsk);
      bool is_closed = false;
      is_answered = process_request(stream, true, is_closed, nullptr);
      stream.end();
    }
    ::close(socket);
    return is_answered;
  }
};

// --- Requests ---

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::runtime_error("no random numbers for a token");
  std::string token;
  for (const unsigned char b : bytes) token += fmt::format("{:02x}", b);
  return token;
}

/// In a time that does not depend on where they differ.
bool are_equal(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (std::size_t k = 0; k < a.size(); ++k) difference |= static_cast<unsigned char>(a[k] ^ b[k]);
  return difference == 0;
}

void refuse(Response& response, int status, const std::string& why) {
  response.status = status;
  response.set_content(nlohmann::json{{"error", why}}.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace),
                       "application/json");
}

/// Which requests are answered at all.
class Gate {
 public:
  Gate(int port, std::string token)
      : hosts_{fmt::format("127.0.0.1:{}", port), fmt::format("localhost:{}", port)}, token_(std::move(token)) {}

  /// Answers those that are not let in.
  httplib::Server::HandlerResponse operator()(const Request& request, Response& response) const {
    const Refusal* const refusal = refusal_of(request);
    if (refusal == nullptr) return httplib::Server::HandlerResponse::Unhandled;
    refuse(response, refusal->first, refusal->second);
    return httplib::Server::HandlerResponse::Handled;
  }

 private:
  /// A status, and why.
  using Refusal = std::pair<int, const char*>;
  static constexpr Refusal kForbidden{403, "this server answers only the page that it gave out"};
  static constexpr Refusal kUnknown{404, "nothing is here: open the address that exactvo serve printed"};
  static constexpr Refusal kNoMethod{405, "GET the page, POST questions"};
  static constexpr Refusal kTooLarge{413, "the question is larger than 8 MiB, or does not say how large it is"};
  static constexpr Refusal kNotJson{415, "a question is JSON, as it is: neither compressed nor in pieces"};

  bool is_own(const std::string& host) const { return std::find(hosts_.begin(), hosts_.end(), host) != hosts_.end(); }

  /// Null where it is let in.
  const Refusal* refusal_of(const Request& request) const {
    if (request.get_header_value_count("Host") != 1 || !is_own(request.get_header_value("Host"))) return &kForbidden;
    if (request.has_header("Origin")) {
      const std::string origin = request.get_header_value("Origin"), scheme = "http://";
      if (origin.rfind(scheme, 0) != 0 || !is_own(origin.substr(scheme.size()))) return &kForbidden;
    }
    const std::string& path = request.path;
    const std::size_t end = path.find('/', 1);
    if (end == std::string::npos || !are_equal(path.substr(1, end - 1), token_)) return &kUnknown;
    if (request.has_header("Range")) return &kForbidden;  // many of them would multiply the page
    if (request.method == "GET") return nullptr;
    if (request.method != "POST") return &kNoMethod;
    if (request.get_header_value("Content-Type") != "application/json" || request.has_header("Content-Encoding") ||
        request.has_header("Transfer-Encoding"))
      return &kNotJson;
    if (request.get_header_value_count("Content-Length") != 1) return &kTooLarge;
    const std::string length = request.get_header_value("Content-Length");
    const bool is_number = !length.empty() && length.size() < 10 &&
                           std::all_of(length.begin(), length.end(), [](char c) { return c >= '0' && c <= '9'; });
    return is_number && std::stoul(length) <= kMostBody ? nullptr : &kTooLarge;
  }

  std::array<std::string, 2> hosts_;
  std::string token_;
};

/// As server.h promises it.
bool serve_http(const HttpSite& site) {
  is_interrupted = site.is_interrupted;
  Server server;
  server.new_task_queue = [&server] { return new Workers(server); };
  server.set_idle_interval(kSlice);
  server.set_payload_max_length(kMostBody);
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  server.set_default_headers({{"Content-Security-Policy", site.policy},
                              {"Cache-Control", "no-store"},
                              {"Referrer-Policy", "no-referrer"},
                              {"X-Content-Type-Options", "nosniff"},
                              {"Cross-Origin-Resource-Policy", "same-origin"},
                              {"Cross-Origin-Opener-Policy", "same-origin"}});
  int port = site.port;
  if (port == 0)
    port = server.bind_to_any_port("127.0.0.1");
  else if (!server.bind_to_port("127.0.0.1", port))
    port = -1;
  if (port <= 0) return false;
  const std::string token = random_token(), root = "/" + token + "/";
  server.set_pre_routing_handler(Gate(port, token));
  server.Get(root,
             [&](const Request&, Response& response) { response.set_content(site.page, "text/html; charset=utf-8"); });
  for (const HttpQuestion& question : site.questions)
    server.Post(root + question.path, [&question](const Request& request, Response& response) {
      const HttpAnswer answer = question.answer(request.body);
      response.status = answer.status;
      response.set_content(answer.body, answer.type);
      response.set_header("Server-Timing", answer.timing);
    });
  server.set_error_handler([](const Request&, Response& response) {
    if (response.body.empty()) refuse(response, response.status, "nothing is here");
  });
  site.ready(fmt::format("http://127.0.0.1:{}{}", port, root));
  server.listen_after_bind();
  return true;
}

constexpr ServeHttp kLibrary = serve_http;

}  // namespace

}  // namespace exactvo::tools

extern "C" __attribute__((visibility("default"))) exactvo::datasets::ModuleEntry exactvo_module() {
  return {exactvo::datasets::kBuild, "http", &exactvo::tools::kLibrary};
}
