#pragma once
#include <string>
#include <string_view>

#include "host/serve/http_server.h"

namespace wale {

/// Bytes of a request's first line and headers, at most.
constexpr size_t kLongestHead = 8192;
constexpr size_t kMostHeaders = 64, kLongestTarget = 1024;

/// What the head of a request says, or why it is refused.
struct RequestHead {
  int status = 0;  ///< 0: taken; else the status to answer with
  std::string fault;
  HttpRequest request;
};

/// Reads the head of an HTTP/1.1 request, up to and including its empty line, strictly (RFC 9112): a method of letters,
/// a target that begins with "/", headers without blanks before the colon, no continued lines, no control characters.
/// Also refused is what the editor's page never sends and a library might be led astray by: two lengths, encoded or
/// chunked bodies, ranges, expectations, other protocols.
RequestHead read_request_head(std::string_view head);

}  // namespace wale
