#include "host/serve/editor_request.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/error.h"
#include "host/json_text.h"
#include "host/serve/access_token.h"
#include "host/suggest.h"

namespace wale {
namespace {

using Kind = EditorRequest::Kind;
using Node = JsonNode::Kind;

constexpr size_t kMostOverrides = 256, kLongestOverride = 16384, kLongestName = 128;

struct Route {
  const char *method, *path;
  Kind kind;
};
constexpr Route kRoutes[] = {
    {"GET", "/", Kind::page},      {"GET", "/stream", Kind::stream},       {"GET", "/state", Kind::state},
    {"POST", "/edit", Kind::edit}, {"POST", "/control", Kind::control},    {"POST", "/camera", Kind::camera},
    {"POST", "/undo", Kind::undo}, {"POST", "/redo", Kind::redo},          {"POST", "/reset", Kind::reset},
    {"POST", "/save", Kind::save}, {"GET", "/picture.png", Kind::picture}, {"POST", "/stop", Kind::stop},
};

std::string_view path_of(const HttpRequest& request) {
  return std::string_view(request.target).substr(0, request.target.find('?'));
}

const Route* route_of(const HttpRequest& request, bool any_method) {
  for (const Route& route : kRoutes)
    if (path_of(request) == route.path && (any_method || request.method == route.method)) return &route;
  return nullptr;
}

// Value of a key of the query that is there once, as it stands: tokens and numbers need no decoding.
std::string_view query(const HttpRequest& request, std::string_view wanted) {
  const size_t mark = request.target.find('?');
  std::string_view rest = mark == std::string::npos ? "" : std::string_view(request.target).substr(mark + 1), found;
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const size_t equals = pair.find('=');
    if (equals == pair.npos || pair.substr(0, equals) != wanted) continue;
    if (found.data()) return {};
    found = pair.substr(equals + 1);
  }
  return found;
}

bool loopback_name(std::string_view name) { return name == "localhost" || name == "127.0.0.1" || name == "[::1]"; }

// "a.b.c.d" or "[...]": nobody's name.
bool in_digits(std::string_view name) {
  if (name.starts_with("[") && name.ends_with("]")) return true;
  return !name.empty() && std::count(name.begin(), name.end(), '.') == 3 &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

std::string quoted(const std::string& text) { return "\"" + one_line(text.substr(0, 60)) + "\""; }

// Members of an object, each asked for once; what is left over is an error.
class Members {
 public:
  explicit Members(const JsonNode& node) : node_(node) {
    if (node.kind != Node::object) user_error("the request: an object is needed here, not {}", node.describe());
  }
  const JsonNode* take(const char* key) {
    names_.push_back(key);
    return node_.find(key);
  }
  std::string text(const char* key) {
    const JsonNode* node = take(key);
    if (!node) return {};
    if (node->kind != Node::string) user_error("{}: a text is needed here, not {}", key, node->describe());
    if (node->text.size() > kLongestName) user_error("{}: longer than {} characters", key, kLongestName);
    return node->text;
  }
  bool flag(const char* key) {
    const JsonNode* node = take(key);
    if (node && node->kind != Node::boolean)
      user_error("{}: true or false is needed here, not {}", key, node->describe());
    return node && node->boolean;
  }
  double number(const JsonNode& node, const char* key, double low, double high) const {
    if (!node.is_number()) user_error("{}: a number is needed here, not {}", key, node.describe());
    if (!(node.number >= low && node.number <= high))
      user_error("{}: {:g} is out of range; valid: {:g} to {:g}", key, node.number, low, high);
    return node.number;
  }
  void pair(const char* key, double low, double high, double (&out)[2]) {
    const JsonNode* node = take(key);
    if (!node) return;
    if (node->kind != Node::array || node->items.size() != 2)
      user_error("{}: a list of 2 numbers is needed here, not {}", key, node->describe());
    for (size_t i = 0; i < 2; ++i) out[i] = number(node->items[i], key, low, high);
  }
  void no_more() const {
    for (const auto& member : node_.members)
      if (std::find(names_.begin(), names_.end(), member.key) == names_.end())
        user_error("{}: unknown key; {}", quoted(member.key), nearest_choice(member.key, names_));
  }

 private:
  const JsonNode& node_;
  std::vector<std::string> names_;
};

void read_edit(Members& members, EditorRequest& out) {
  const JsonNode* set = members.take("set");
  if (!set || set->kind != Node::array || set->items.empty())
    user_error("set: a list of \"key.path=value\" is needed{}", set ? ", not " + set->describe() : "");
  if (set->items.size() > kMostOverrides)
    user_error("set: {} overrides; at most {}", set->items.size(), kMostOverrides);
  for (const JsonNode& item : set->items) {
    if (item.kind != Node::string) user_error("set: a text \"key.path=value\" is needed here, not {}", item.describe());
    if (item.text.size() > kLongestOverride) user_error("set: an override is longer than {} bytes", kLongestOverride);
    out.set.push_back(item.text);
  }
  out.control = members.text("control");
}

EditorRequest read_body(Kind kind, const std::string& body) {
  EditorRequest out{kind};
  const JsonNode document = parse_json(body, "request");
  Members members(document);
  constexpr double kPi = 3.14159265358979323846;
  if (kind == Kind::edit) read_edit(members, out);
  if (kind == Kind::control) {
    out.control = members.text("control");
    const JsonNode* value = members.take("value");
    if (out.control.empty() || !value) user_error("the request: \"control\" and \"value\" are needed");
    out.value = *value;
  }
  if (kind == Kind::camera) {
    members.pair("orbit", -kPi, kPi, out.orbit);
    members.pair("pan", -4, 4, out.pan);
    if (const JsonNode* zoom = members.take("zoom")) out.zoom = members.number(*zoom, "zoom", 0.05, 20);
  }
  if (kind == Kind::edit || kind == Kind::control || kind == Kind::camera) out.gesture = members.text("gesture");
  if (kind == Kind::save) {
    out.file = members.text("file");
    out.replace = members.flag("replace");
  }
  members.no_more();
  return out;
}

}  // namespace

HttpReply refusal(int status, const std::string& line) {
  HttpReply reply;
  reply.status = status;
  reply.body = "{\"error\": " + json_string(one_line(line)) + "}\n";
  return reply;
}

bool host_allowed(const EditorGate& gate, std::string_view header) {
  std::string_view name = header;
  const size_t colon = header.rfind(':');
  if (colon != header.npos && header.find(']', colon) == header.npos) {
    name = header.substr(0, colon);
    const std::string_view port = header.substr(colon + 1);
    if (port.empty() || port.size() > 5 ||
        !std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; }))
      return false;
  }
  if (loopback_name(name)) return true;
  const bool elsewhere = gate.host != "127.0.0.1" && gate.host != "localhost" && gate.host != "::1";
  return elsewhere && (name == gate.host || name == "[" + gate.host + "]" || in_digits(name));
}

std::optional<HttpReply> refuse_request(const EditorGate& gate, const HttpRequest& request, size_t longest_body) {
  const auto host = request.header("host");
  if (!host || !host_allowed(gate, *host))
    return refusal(403, "the Host header does not name this editor; open the printed address, forwarded to localhost");
  for (const char* name : {"origin", "sec-fetch-site"}) {
    if (std::none_of(request.headers.begin(), request.headers.end(), [&](const auto& h) { return h.first == name; }))
      continue;
    const auto value = request.header(name);
    const bool own = value && (*name == 'o' ? *value == "http://" + std::string(*host)
                                            : *value == "same-origin" || *value == "none");
    if (!own) return refusal(403, "the request comes from another page");
  }
  const Route* route = route_of(request, true);
  if (!route) return refusal(404, "no such path");
  if (!(route = route_of(request, false))) {
    HttpReply reply = refusal(405, "another method is needed here");
    reply.headers.emplace_back("Allow", route_of(request, true)->method);
    return reply;
  }
  const auto header = request.header("x-wale-token");
  // A page and a picture to be saved are opened by address; all else comes from the page itself.
  const bool by_address = route->kind == Kind::page || route->kind == Kind::picture;
  const std::string_view token = header ? *header : by_address ? query(request, "token") : std::string_view();
  if (!same_secret(token, gate.token)) return refusal(401, "the token is missing or wrong; open the printed address");
  const auto length = request.header("content-length");
  if (request.method == "GET") {
    if (length && *length != "0") return refusal(400, "a GET request has no body");
    return std::nullopt;
  }
  if (!length) return refusal(411, "Content-Length is missing");
  if (std::stoul(std::string(*length)) > longest_body)
    return refusal(413, fmt::format("the body is longer than {} bytes", longest_body));
  const auto type = request.header("content-type");
  if (!type || (*type != "application/json" && !type->starts_with("application/json;")))
    return refusal(415, "the body must be application/json");
  return std::nullopt;
}

ReadRequest read_editor_request(const HttpRequest& request) {
  const Route* route = route_of(request, false);
  if (!route) return {std::nullopt, refusal(404, "no such path")};
  try {
    if (request.method == "POST") return {read_body(route->kind, request.body), {}};
    EditorRequest out{route->kind};
    if (route->kind == Kind::picture) out.view = query(request, "view") == "1" ? 1 : 0;
    return {std::move(out), {}};
  } catch (const Error& error) {
    return {std::nullopt, refusal(400, error.what())};
  }
}

}  // namespace wale
