#include "host/serve/request_head.h"

#include <algorithm>

namespace wale {
namespace {

RequestHead refused(int status, std::string fault) { return {status, std::move(fault), {}}; }

bool is_token(std::string_view text) {
  constexpr std::string_view kMarks = "!#$%&'*+-.^_`|~";
  const auto good = [&](unsigned char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kMarks.find(char(c)) != kMarks.npos;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), good);
}

bool printable(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= 0x20 && c < 0x7F; });
}

bool digits(std::string_view text) {
  return !text.empty() && text.size() <= 9 &&
         std::all_of(text.begin(), text.end(), [](unsigned char c) { return c >= '0' && c <= '9'; });
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

// Empties `line` of the next line; false when there is no more.
bool next_line(std::string_view& rest, std::string_view& line) {
  const size_t end = rest.find("\r\n");
  if (end == rest.npos) return false;
  line = rest.substr(0, end);
  rest.remove_prefix(end + 2);
  return true;
}

RequestHead read_first_line(std::string_view line) {
  RequestHead head;
  const size_t a = line.find(' '), b = line.rfind(' ');
  if (a == line.npos || a == b || line.substr(b + 1) != "HTTP/1.1")
    return refused(400, "the first line is not \"METHOD /path HTTP/1.1\"");
  head.request.method = line.substr(0, a);
  head.request.target = line.substr(a + 1, b - a - 1);
  const std::string& method = head.request.method;
  if (method.empty() || method.size() > 16 ||
      !std::all_of(method.begin(), method.end(), [](char c) { return c >= 'A' && c <= 'Z'; }))
    return refused(400, "the method is not a word of capital letters");
  if (head.request.target.size() > kLongestTarget) return refused(414, "the target is too long");
  if (!head.request.target.starts_with("/") || head.request.target.find(' ') != std::string::npos ||
      !printable(head.request.target))
    return refused(400, "the target does not begin with \"/\"");
  return head;
}

}  // namespace

std::optional<std::string_view> HttpRequest::header(std::string_view name) const {
  std::optional<std::string_view> found;
  for (const auto& [key, value] : headers) {
    if (key != name) continue;
    if (found) return std::nullopt;
    found = value;
  }
  return found;
}

RequestHead read_request_head(std::string_view text) {
  if (text.size() > kLongestHead) return refused(431, "the head is too long");
  std::string_view line;
  if (!next_line(text, line)) return refused(400, "the head has no first line");
  RequestHead head = read_first_line(line);
  if (head.status) return head;
  while (next_line(text, line)) {
    if (line.empty()) {
      if (!text.empty()) return refused(400, "bytes behind the head");
      if (!head.request.header("host")) return refused(400, "exactly one Host header is needed");
      return head;
    }
    const size_t colon = line.find(':');
    if (colon == line.npos || !is_token(line.substr(0, colon))) return refused(400, "a header has no proper name");
    const std::string name = lower(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!printable(value)) return refused(400, "a header holds control characters");
    if (head.request.headers.size() == kMostHeaders) return refused(431, "too many headers");
    for (const char* never : {"transfer-encoding", "content-encoding", "expect", "upgrade", "range", "trailer"})
      if (name == never) return refused(400, "the header " + name + " is not served");
    if (name == "content-length" && (!digits(value) || head.request.header(name)))
      return refused(400, "Content-Length is no length");
    head.request.headers.emplace_back(name, value);
  }
  return refused(400, "the head has no end");
}

}  // namespace wale
