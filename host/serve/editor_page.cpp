#include "host/serve/editor_page.h"

#include "host/serve/access_token.h"

namespace wale {

HttpReply editor_page() {
  const std::string nonce = make_access_token();
  HttpReply reply;
  reply.type = "text/html; charset=utf-8";
  reply.body = embedded_page().at("editor.html");
  const std::string mark = "{{NONCE}}";
  for (size_t at; (at = reply.body.find(mark)) != std::string::npos;) reply.body.replace(at, mark.size(), nonce);
  reply.headers.emplace_back(
      "Content-Security-Policy",
      "default-src 'none'; script-src 'nonce-" + nonce + "'; style-src 'nonce-" + nonce +
          "'; img-src 'self' blob: data:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
          "frame-ancestors 'none'");
  return reply;
}

}  // namespace wale
