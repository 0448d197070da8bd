#include <cmath>

#include "host/serve/editor_request.h"
#include "host/serve/request_head.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/targets.h"

// A request to the editor, head and body, in the steps of the server.
bool wale::fuzz::request(std::string_view bytes) {
  constexpr size_t kLongestBody = 4096;
  const EditorGate gate{"0123456789abcdef0123456789abcdef", "127.0.0.1"};
  const auto refused = [](const HttpReply& reply) {
    expect(reply.status >= 400 && reply.status < 500, "a refusal that is none");
    expect(reply.body.find('\n') + 1 == reply.body.size(), "a refusal of several lines");
    return false;
  };
  return accepted([&] {
    const size_t end = std::min(bytes.find("\r\n\r\n"), bytes.size());
    const RequestHead head = read_request_head(bytes.substr(0, std::min(bytes.size(), end + 4)));
    if (head.status) user_error("{} {}", refused(refusal(head.status, head.fault)), head.status);
    HttpRequest asked = head.request;
    expect(asked.target.starts_with("/") && asked.headers.size() <= kMostHeaders, "a head that should be refused");
    if (const auto reply = refuse_request(gate, asked, kLongestBody)) user_error("{} {}", refused(*reply), reply->status);
    asked.body = bytes.substr(std::min(bytes.size(), end + 4));
    const ReadRequest read = read_editor_request(asked);
    if (!read.request) user_error("{} {}", refused(read.refusal), read.refusal.status);
    const EditorRequest& r = *read.request;
    for (const double v : {r.orbit[0], r.orbit[1], r.pan[0], r.pan[1], r.zoom})
      expect(std::isfinite(v) && std::abs(v) <= 20, "a camera that leaps");
    expect(r.kind != EditorRequest::Kind::edit || !r.set.empty(), "an edit of nothing");
  });
}
