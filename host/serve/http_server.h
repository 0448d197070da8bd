#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wale {

struct HttpRequest {
  std::string method, target;                                ///< target: path and query as sent
  std::vector<std::pair<std::string, std::string>> headers;  ///< names in lower case
  std::string body;

  /// Value of a header that is there once; nothing when it is absent or there twice.
  std::optional<std::string_view> header(std::string_view name) const;
};

/// Writes to a client; false when it is gone or too slow.
using HttpWrite = std::function<bool(std::string_view)>;

struct HttpReply {
  int status = 200;
  std::string type = "application/json", body;
  std::vector<std::pair<std::string, std::string>> headers{};
  /// Instead of a body: called again and again, until it returns false, to write what there is to say next.
  std::function<bool(const HttpWrite&)> stream{};
};

/// What a client may cost.
struct HttpLimits {
  size_t connections = 32;    ///< at once; more are told 503
  size_t body = 64 << 10;     ///< bytes of a request behind its head
  double read_seconds = 5;    ///< for a whole request
  double write_seconds = 10;  ///< for a piece of a reply
  double idle_seconds = 15;   ///< between two requests of one connection
};

struct HttpHandlers {
  /// Looks at a request before its body is read; what it returns is the reply.
  std::function<std::optional<HttpReply>(const HttpRequest&)> refuse;
  std::function<HttpReply(const HttpRequest&)> reply;  ///< from several threads at once; must not throw
};

/// Listens from its making to stop(), on threads of its own.
class HttpServer {
 public:
  virtual ~HttpServer() = default;
  virtual int port() const = 0;
  /// Takes no more requests and waits for those that are being answered; streams must end by themselves.
  virtual void stop() = 0;
};

/// cpp-httplib behind a library of its own, as it brings OpenSSL along, which no other command needs.
struct HttpLibrary {
  /// Null, and `failure` says why, when the address cannot be listened on. Port 0: any free one.
  std::unique_ptr<HttpServer> (*listen)(const std::string& host, int port, const HttpLimits& limits,
                                        HttpHandlers handlers, std::string& failure);
};

constexpr const char* kHttpLibrary = "libwale_http_server.so";
constexpr const char* kHttpFunction = "wale_http_server";

/// Listens. Throws a user error when the library is missing, or the address is taken or not of this machine.
std::unique_ptr<HttpServer> serve_http(const std::string& host, int port, const HttpLimits& limits,
                                       HttpHandlers handlers);

/// Whether this build has the library.
bool has_http_library();

}  // namespace wale
