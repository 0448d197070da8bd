// The only file that knows cpp-httplib; a library of its own, see host/serve/http_server.h.
#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstring>

#include "host/serve/http_server.h"
#include "host/serve/request_head.h"

namespace wale {
namespace {

using Clock = std::chrono::steady_clock;

/// A connection whose requests are bounded: the head is read and judged before the library sees a byte of it.
class GuardedStream : public httplib::Stream {
 public:
  GuardedStream(socket_t socket, const HttpLimits& limits) : socket_(socket), limits_(limits) {}

  /// Waits for the next request; false when none comes, or the server ends first.
  bool wait_for_request(double idle_seconds, const std::atomic<bool>& ended) {
    constexpr double kLook = 0.1;
    for (double left = idle_seconds; pending_.empty() && !ready(POLLIN, std::min(left, kLook)); left -= kLook)
      if (ended || left <= kLook) return false;
    return !ended;
  }

  /// Reads the next head; false when the client closed, sent nothing yet or is too slow.
  bool read_head() {
    head_.clear();
    at_ = 0;
    body_left_ = 0;
    deadline_ =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits_.read_seconds));
    while (true) {
      if (const size_t end = pending_.find("\r\n\r\n"); end != std::string::npos) {
        head_ = pending_.substr(0, end + 4);
        pending_.erase(0, end + 4);
        return true;
      }
      if (pending_.size() > kLongestHead) {
        head_ = pending_;
        return true;  // refused as too long
      }
      char bytes[4096];
      const ssize_t got = receive(bytes, sizeof(bytes));
      if (got <= 0) return false;
      pending_.append(bytes, size_t(got));
    }
  }
  const std::string& head() const { return head_; }
  void expect_body(size_t bytes) { body_left_ = bytes; }
  bool body_unread() const { return body_left_ > 0; }

  bool is_readable() const override { return at_ < head_.size() || body_left_ > 0; }
  bool is_writable() const override { return ready(POLLOUT, limits_.write_seconds) && !hung_up(); }

  ssize_t read(char* to, size_t size) override {
    if (at_ < head_.size()) {
      const size_t n = std::min(size, head_.size() - at_);
      std::memcpy(to, head_.data() + at_, n);
      at_ += n;
      return ssize_t(n);
    }
    size = std::min(size, body_left_);
    if (size == 0) return 0;
    if (!pending_.empty()) {
      const size_t n = std::min(size, pending_.size());
      std::memcpy(to, pending_.data(), n);
      pending_.erase(0, n);
      body_left_ -= n;
      return ssize_t(n);
    }
    const ssize_t got = receive(to, size);
    if (got > 0) body_left_ -= size_t(got);
    return got;
  }

  ssize_t write(const char* from, size_t size) override {
    const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                          std::chrono::duration<double>(limits_.write_seconds));
    for (size_t sent = 0; sent < size;) {
      const double left = std::chrono::duration<double>(until - Clock::now()).count();
      if (left <= 0 || !ready(POLLOUT, left)) return -1;
      const ssize_t n = ::send(socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (n < 0 && errno != EAGAIN && errno != EINTR) return -1;
      if (n > 0) sent += size_t(n);
    }
    return ssize_t(size);
  }

  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return socket_; }

 private:
  bool ready(short what, double seconds) const {
    pollfd one{socket_, what, 0};
    int n;
    do n = ::poll(&one, 1, int(std::max(0.0, seconds) * 1e3));
    while (n < 0 && errno == EINTR);
    return n > 0;
  }
  bool hung_up() const {
    char byte;
    const ssize_t n = ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return n == 0 || (n < 0 && errno != EAGAIN && errno != EINTR);
  }
  ssize_t receive(char* to, size_t size) {
    const double left = std::chrono::duration<double>(deadline_ - Clock::now()).count();
    if (left <= 0 || !ready(POLLIN, left)) return -1;
    return ::recv(socket_, to, size, 0);
  }

  socket_t socket_;
  const HttpLimits& limits_;
  std::string pending_, head_;
  size_t at_ = 0, body_left_ = 0;
  Clock::time_point deadline_;
};

void fill(const HttpReply& reply, httplib::Response& out) {
  out.status = reply.status;
  for (const auto& [name, value] : reply.headers) out.set_header(name.c_str(), value);
  for (const auto& [name, value] :
       {std::pair{"X-Content-Type-Options", "nosniff"}, std::pair{"Cache-Control", "no-store"},
        std::pair{"Referrer-Policy", "no-referrer"}, std::pair{"X-Frame-Options", "DENY"},
        std::pair{"Cross-Origin-Resource-Policy", "same-origin"}})
    out.set_header(name, value);
  if (!reply.stream) return out.set_content(reply.body, reply.type.c_str());
  out.set_chunked_content_provider(reply.type.c_str(), [stream = reply.stream](size_t, httplib::DataSink& sink) {
    bool sent = true;
    const HttpWrite write = [&](std::string_view bytes) {
      sent = sink.is_writable() && sink.write(bytes.data(), bytes.size());
      return sent;
    };
    if (stream(write)) return true;
    if (sent) sink.done();
    return sent;
  });
}

class Listener : public httplib::Server {
 public:
  Listener(const HttpLimits& limits, HttpHandlers handlers) : limits_(limits), handlers_(std::move(handlers)) {
    new_task_queue = [this] { return new httplib::ThreadPool(limits_.connections + 1); };
    set_payload_max_length(limits_.body);
    set_tcp_nodelay(true);
    // One process at an address: the other one is told that it is taken.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    });
    const auto handle = [this](const httplib::Request& request, httplib::Response& response) {
      HttpRequest& mine = current();
      mine.body = request.body;
      fill(handlers_.reply(mine), response);
    };
    Get(".*", handle);
    Post(".*", handle);
  }

  void begin() {
    thread_ = std::thread([this] { listen_after_bind(); });
  }
  void end() {
    while (!is_running() && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ended_ = true;
    httplib::Server::stop();
    if (thread_.joinable()) thread_.join();
  }

 private:
  // The request that this thread reads: its head was parsed once, strictly.
  static HttpRequest& current() {
    static thread_local HttpRequest request;
    return request;
  }

  bool process_and_close_socket(socket_t socket) override {
    const bool room = open_.fetch_add(1) < limits_.connections;
    GuardedStream stream(socket, limits_);
    if (room)
      while (stream.wait_for_request(limits_.idle_seconds, ended_) && stream.read_head() && serve(stream)) {
      }
    else if (stream.wait_for_request(0.1, ended_) && stream.read_head())
      answer(stream, {503, "application/json", "{\"error\": \"too many connections\"}\n"});
    --open_;
    ::shutdown(socket, SHUT_WR);
    // What is left unread would make the system reset the connection before the reply is read.
    char rest[4096];
    for (int i = 0; i < 64 && ::recv(socket, rest, sizeof(rest), MSG_DONTWAIT) > 0; ++i) {
    }
    ::close(socket);
    return true;
  }

  // True when the connection may be used again.
  bool serve(GuardedStream& stream) {
    RequestHead head = read_request_head(stream.head());
    if (head.status) {
      answer(stream, {head.status, "application/json", "{\"error\": \"" + head.fault + "\"}\n"});
      return false;
    }
    current() = std::move(head.request);
    if (const auto refused = handlers_.refuse(current())) {
      answer(stream, *refused);
      return false;
    }
    if (const auto length = current().header("content-length")) stream.expect_body(std::stoul(std::string(*length)));
    bool closed = false;
    return process_request(stream, false, closed, nullptr) && !closed && !stream.body_unread();
  }

  // Without the library: nothing of such a request reaches it.
  static void answer(GuardedStream& stream, const HttpReply& reply) {
    std::string text =
        "HTTP/1.1 " + std::to_string(reply.status) + " Refused\r\nConnection: close\r\nContent-Type: " + reply.type +
        "\r\nContent-Length: " + std::to_string(reply.body.size()) + "\r\nX-Content-Type-Options: nosniff\r\n";
    for (const auto& [name, value] : reply.headers) text += name + ": " + value + "\r\n";
    text += "\r\n" + reply.body;
    stream.write(text.data(), text.size());
  }

  HttpLimits limits_;
  HttpHandlers handlers_;
  std::atomic<size_t> open_ = 0;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

class Server : public HttpServer {
 public:
  Server(const HttpLimits& limits, HttpHandlers handlers) : listener_(limits, std::move(handlers)) {}
  ~Server() override { stop(); }
  bool bind(const std::string& host, int port) {
    port_ = port ? (listener_.bind_to_port(host.c_str(), port) ? port : -1) : listener_.bind_to_any_port(host.c_str());
    if (port_ > 0) listener_.begin();
    begun_ = port_ > 0;
    return begun_;
  }
  int port() const override { return port_; }
  void stop() override {
    if (std::exchange(begun_, false)) listener_.end();
  }

 private:
  Listener listener_;
  int port_ = -1;
  bool begun_ = false;
};

std::unique_ptr<HttpServer> listen(const std::string& host, int port, const HttpLimits& limits, HttpHandlers handlers,
                                   std::string& failure) {
  auto server = std::make_unique<Server>(limits, std::move(handlers));
  errno = 0;
  if (server->bind(host, port)) return server;
  failure = errno == EADDRINUSE
                ? "the port is taken by another program; give another --port, or 0 for any free one"
                : std::string("cannot be listened on") + (errno ? std::string(": ") + std::strerror(errno) : "");
  return nullptr;
}

constexpr HttpLibrary kLibrary{listen};

}  // namespace
}  // namespace wale

extern "C" const void* wale_http_server() { return &wale::kLibrary; }
