#include "tests/host/serve_client.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <regex>
#include <thread>

namespace wale::test {
namespace {

std::vector<std::string> with_command(const std::vector<std::string>& args) {
  std::vector<std::string> all{"serve"};
  all.insert(all.end(), args.begin(), args.end());
  for (const char* more : {"--port", "0"}) all.push_back(more);
  return all;
}

// False at the end of the connection, or when nothing comes any more.
bool receive(int socket, std::string& to, double seconds) {
  pollfd one{socket, POLLIN, 0};
  if (::poll(&one, 1, int(1e3 * seconds)) <= 0) return false;
  char bytes[65536];
  const ssize_t n = ::recv(socket, bytes, sizeof(bytes), 0);
  if (n <= 0) return false;
  to.append(bytes, size_t(n));
  return true;
}

}  // namespace

Served::Served(const std::filesystem::path& folder, const std::vector<std::string>& args)
    : process_(folder, with_command(args)) {
  std::smatch found;
  static const std::regex address("http://[^:]+:([0-9]+)/\\?token=([0-9a-f]{32})\n");
  for (int i = 0; i < 3000 && port_ < 0; ++i) {
    const std::string out = process_.out();
    if (std::regex_search(out, found, address)) {
      port_ = std::stoi(found[1]);
      token_ = found[2];
    }
    if (i % 20 == 19 && process_.wait_for("wale: ", 0)) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

int Served::connect() const {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(uint16_t(port_));
  ::inet_pton(AF_INET, "127.0.0.1", &to.sin_addr);
  if (::connect(socket, reinterpret_cast<sockaddr*>(&to), sizeof(to)) == 0) return socket;
  ::close(socket);
  return -1;
}

Served::Reply Served::raw(const std::string& bytes, double wait) const {
  Reply reply;
  const int socket = connect();
  if (socket < 0) return reply;
  ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  std::string text;
  size_t end = std::string::npos, length = 0;
  while ((end = text.find("\r\n\r\n")) == std::string::npos && receive(socket, text, wait)) {
  }
  if (end != std::string::npos) {
    reply.head = text.substr(0, end + 2);
    reply.status = std::atoi(text.c_str() + 9);
    std::smatch found;
    static const std::regex content("Content-Length: ([0-9]+)");
    if (std::regex_search(reply.head, found, content)) length = std::stoul(found[1]);
    reply.body = text.substr(end + 4);
    while (reply.body.size() < length && receive(socket, reply.body, wait)) {
    }
  }
  ::close(socket);
  return reply;
}

Served::Reply Served::ask(const std::string& method, const std::string& path, const std::string& body,
                          const std::string& more, const std::string* token, const std::string& host) const {
  std::string text = method + " " + path +
                     " HTTP/1.1\r\nHost: " + (host.empty() ? fmt::format("127.0.0.1:{}", port_) : host) +
                     "\r\nX-Wale-Token: " + (token ? *token : token_) + "\r\n" + more;
  if (method == "POST") text += fmt::format("Content-Type: application/json\r\nContent-Length: {}\r\n", body.size());
  return raw(text + "\r\n" + body);
}

std::string Served::watch(const std::string& text, double seconds) const {
  const int socket = connect();
  const std::string request =
      fmt::format("GET /stream HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: {}\r\n\r\n", token_);
  ::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
  std::string got;
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (got.find(text) == std::string::npos && std::chrono::steady_clock::now() < until)
    if (!receive(socket, got, 2)) break;
  ::close(socket);
  return got.find(text) == std::string::npos ? "" : got;
}

long Served::resident_kib() const {
  std::smatch found;
  const std::string status = file_text(fmt::format("/proc/{}/status", process_.pid()));
  return std::regex_search(status, found, std::regex("VmRSS:\\s+([0-9]+)")) ? std::stol(found[1]) : 0;
}

}  // namespace wale::test
