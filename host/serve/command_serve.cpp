#include "host/serve/command_serve.h"

#include <fmt/format.h>

#include <atomic>

#include "geom/error.h"
#include "host/image_coder.h"
#include "host/serve/access_token.h"
#include "host/serve/editor_page.h"
#include "host/serve/editor_session.h"
#include "host/serve/rate_limit.h"
#include "host/stop.h"

namespace wale {
namespace {

// A hand on a slider sends some 60 edits a second; whoever guesses tokens gets few tries.
constexpr double kRequestsPerSecond = 500, kFailuresPerSecond = 10;

bool loopback(const std::string& host) { return host == "127.0.0.1" || host == "localhost" || host == "::1"; }

HttpHandlers handlers(EditorSession& session, const EditorGate& gate, size_t longest_body) {
  struct Limits {
    RateLimit requests{kRequestsPerSecond, kRequestsPerSecond}, failures{kFailuresPerSecond, 50};
  };
  auto limits = std::make_shared<Limits>();
  HttpHandlers out;
  out.refuse = [limits, gate, longest_body](const HttpRequest& request) -> std::optional<HttpReply> {
    auto refused = refuse_request(gate, request, longest_body);
    if (refused && !limits->failures.allow()) return refusal(429, "too many requests that were refused");
    if (refused) return refused;
    if (!limits->requests.allow()) return refusal(429, "too many requests; send the newest value only");
    return std::nullopt;
  };
  out.reply = [&session](const HttpRequest& request) {
    try {
      const ReadRequest read = read_editor_request(request);
      if (!read.request) return read.refusal;
      return read.request->kind == EditorRequest::Kind::page ? editor_page() : session.handle(*read.request);
    } catch (const std::bad_alloc&) {
      return refusal(503, "out of memory");
    } catch (const std::exception& error) {
      return refusal(500, error.what());
    }
  };
  return out;
}

}  // namespace

void print_editor_note() {
  fmt::print("editor (wale serve): {}\n",
             has_http_library() ? "yes" : "no; apt-get install libcpp-httplib-dev, then build again");
}

int run_serve(const ServeArgs& args, const Loaders& loaders) {
  require_image_coder();
  FilmScene size;
  apply_size(args.size, size);
  EditorOptions options;
  options.width = size.width;
  options.height = size.height;
  options.kernel_dir = args.kernel_dir;
  const unsigned number = one_device_number(args.device);
  EditorSession session(EditedScene(args.scene, overrides_of(args)), options);
  const Device device = Device::open(number);

  HttpLimits limits;
  const EditorGate gate{make_access_token(), args.host};
  const auto server = serve_http(args.host, args.port, limits, handlers(session, gate, limits.body));
  catch_stop_signals();
  const bool six = args.host.find(':') != std::string::npos;
  fmt::print("http://{}:{}/?token={}\n", six ? "[" + args.host + "]" : args.host, server->port(), gate.token);
  std::fflush(stdout);
  if (!args.quiet) fmt::print(stderr, "note: open this address in a browser; whoever has it may edit. Ctrl-C ends\n");
  if (!loopback(args.host))
    fmt::print(stderr,
               "warning: --host {}: others on the network can reach the editor, and what is sent is not encrypted; "
               "a forwarded port (ssh -L) is safer\n",
               args.host);
  try {
    session.run(std::span(&device, 1), loaders, stop_requested);
  } catch (...) {
    session.stop();
    server->stop();
    throw;
  }
  server->stop();
  return 0;
}

}  // namespace wale
