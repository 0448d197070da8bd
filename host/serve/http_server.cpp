#include "host/serve/http_server.h"

#include "geom/error.h"
#include "host/loaded_library.h"

namespace wale {

std::unique_ptr<HttpServer> serve_http(const std::string& host, int port, const HttpLimits& limits,
                                       HttpHandlers handlers) {
  if (!has_http_library())
    user_error(
        "serve: {} is not beside the program: it is built where cpp-httplib is installed (apt-get install "
        "libcpp-httplib-dev, then build again)",
        kHttpLibrary);
  static const auto* library = static_cast<const HttpLibrary*>(load_table(kHttpLibrary, kHttpFunction));
  std::string failure;
  auto server = library->listen(host, port, limits, std::move(handlers), failure);
  if (!server) user_error("--host {} --port {}: {}", one_line(host), port, failure);
  return server;
}

bool has_http_library() {
  try {
    require_library(kHttpLibrary);
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace wale
