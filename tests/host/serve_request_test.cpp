// What the editor's server takes and what it refuses, without a server.
#include <gtest/gtest.h>

#include <set>

#include "host/serve/access_token.h"
#include "host/serve/editor_request.h"
#include "host/serve/rate_limit.h"
#include "host/serve/request_head.h"

namespace wale {
namespace {

const std::string kToken = "0123456789abcdef0123456789abcdef";
const EditorGate kGate{kToken, "127.0.0.1"};

int head_status(const std::string& text) { return read_request_head(text).status; }

// Status of a whole request as the server answers it; 200 where the editor is asked.
int status(const std::string& head, const std::string& body = "", const EditorGate& gate = kGate) {
  const RequestHead read = read_request_head(head);
  if (read.status) return read.status;
  HttpRequest request = read.request;
  if (const auto refused = refuse_request(gate, request, 1000)) return refused->status;
  request.body = body;
  const ReadRequest asked = read_editor_request(request);
  return asked.request ? 200 : asked.refusal.status;
}

std::string post(const std::string& path, const std::string& body, const std::string& more = "",
                 const std::string& host = "localhost:1", const std::string& token = kToken) {
  return "POST " + path + " HTTP/1.1\r\nHost: " + host + "\r\nX-Wale-Token: " + token + "\r\n" + more +
         "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n\r\n";
}
int posted(const std::string& path, const std::string& body, const std::string& more = "") {
  return status(post(path, body, more), body);
}

TEST(ServeRequest, TokensAreRandomAndComparedWhole) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(make_access_token());
  EXPECT_EQ(tokens.size(), 100u);
  EXPECT_EQ(tokens.begin()->size(), 32u);
  EXPECT_TRUE(same_secret(kToken, kToken));
  for (size_t i = 0; i < kToken.size(); ++i) {
    std::string other = kToken;
    other[i] ^= 1;
    EXPECT_FALSE(same_secret(other, kToken)) << i;
  }
  EXPECT_FALSE(same_secret("", kToken));
  EXPECT_FALSE(same_secret(kToken + kToken, kToken));
  EXPECT_FALSE(same_secret(kToken.substr(0, 31), kToken));
}

TEST(ServeRequest, HeadsAreReadStrictly) {
  EXPECT_EQ(head_status("GET / HTTP/1.1\r\nHost: a\r\n\r\n"), 0);
  for (const char* bad : {"",
                          "\r\n\r\n",
                          "GET / HTTP/1.0\r\nHost: a\r\n\r\n",
                          "get / HTTP/1.1\r\nHost: a\r\n\r\n",
                          "GET http://a/ HTTP/1.1\r\nHost: a\r\n\r\n",
                          "GET /\r\nHost: a\r\n\r\n",
                          "GET / HTTP/1.1\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost : a\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost: a\r\n folded\r\n\r\n",
                          "GET /\x01 HTTP/1.1\r\nHost: a\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost: a\r\nX: \x01\r\n\r\n",
                          "GET / HTTP/1.1\nHost: a\n\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1e3\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 99999999999999999999\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nContent-Encoding: gzip\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost: a\r\nRange: bytes=0-1\r\n\r\n",
                          "POST / HTTP/1.1\r\nHost: a\r\nExpect: 100-continue\r\n\r\n",
                          "GET / HTTP/1.1\r\nHost: a\r\n\r\nmore"})
    EXPECT_EQ(head_status(bad), 400) << bad;
  EXPECT_EQ(head_status("GET /" + std::string(2000, 'a') + " HTTP/1.1\r\nHost: a\r\n\r\n"), 414);
  EXPECT_EQ(head_status("GET / HTTP/1.1\r\nHost: a\r\nX: " + std::string(9000, 'a') + "\r\n\r\n"), 431);
  std::string many = "GET / HTTP/1.1\r\nHost: a\r\n";
  for (int i = 0; i < 100; ++i) many += "X: 1\r\n";
  EXPECT_EQ(head_status(many + "\r\n"), 431);
}

TEST(ServeRequest, OnlyWhoHasTheAddressIsServed) {
  const std::string body = R"({"set": ["film.exposure=1"]})";
  EXPECT_EQ(posted("/edit", body), 200);
  EXPECT_EQ(status(post("/edit", body, "", "localhost:1", std::string(32, '0')), body), 401);
  EXPECT_EQ(status(post("/edit", body, "", "localhost:1", ""), body), 401);
  EXPECT_EQ(status("GET /?token=" + kToken + " HTTP/1.1\r\nHost: localhost\r\n\r\n"), 200);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHost: localhost\r\n\r\n"), 401);
  EXPECT_EQ(status("GET /?token=" + kToken + "&token=" + kToken + " HTTP/1.1\r\nHost: localhost\r\n\r\n"), 401);
  EXPECT_EQ(status("GET /state?token=" + kToken + " HTTP/1.1\r\nHost: localhost\r\n\r\n"), 401) << "not by address";
  for (const char* host :
       {"evil.example", "127.0.0.1.evil.example", "localhost.", "localhost:x", "10.0.0.1", "[::2]", ""})
    EXPECT_EQ(status(post("/edit", body, "", host), body), 403) << host;
  for (const char* host : {"127.0.0.1", "127.0.0.1:8737", "localhost:9000", "[::1]:8737"})
    EXPECT_EQ(status(post("/edit", body, "", host), body), 200) << host;
  EXPECT_EQ(posted("/edit", body, "Origin: http://localhost:1\r\n"), 200);
  for (const char* more :
       {"Origin: http://evil.example\r\n", "Origin: null\r\n", "Origin: https://localhost:1\r\n",
        "Origin: http://localhost:2\r\n", "Sec-Fetch-Site: cross-site\r\n", "Sec-Fetch-Site: same-site\r\n",
        "Origin: http://localhost:1\r\nOrigin: http://localhost:1\r\n"})
    EXPECT_EQ(posted("/edit", body, more), 403) << more;
  const EditorGate open{kToken, "0.0.0.0"};
  EXPECT_TRUE(host_allowed(open, "192.168.1.7:8737"));
  EXPECT_FALSE(host_allowed(open, "evil.example:8737"));
  EXPECT_FALSE(host_allowed(kGate, "192.168.1.7:8737"));
}

TEST(ServeRequest, MethodsPathsAndBodiesAreChecked) {
  EXPECT_EQ(posted("/nothing", "{}"), 404);
  EXPECT_EQ(posted("/../etc/passwd", "{}"), 404);
  EXPECT_EQ(posted("/state", "{}"), 405);
  EXPECT_EQ(status("DELETE /edit HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: " + kToken + "\r\n\r\n"), 405);
  EXPECT_EQ(posted("/edit", std::string(1001, ' ')), 413);
  EXPECT_EQ(status("POST /edit HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: " + kToken + "\r\n\r\n"), 411);
  EXPECT_EQ(
      status(
          "POST /edit HTTP/1.1\r\nHost: localhost\r\nContent-Type: text/plain\r\nContent-Length: 2\r\nX-Wale-Token: " +
              kToken + "\r\n\r\n",
          "{}"),
      415);
  EXPECT_EQ(
      status("GET /state HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nX-Wale-Token: " + kToken + "\r\n\r\n"),
      400);
  for (const char* bad :
       {"", "{", "[]", "null", "{}", R"({"set": []})", R"({"set": "a=1"})", R"({"set": [1]})",
        R"({"set": ["a=1"], "more": 1})", R"({"set": ["a=1"], "set": ["a=1"]})", R"({"set": ["a=1"], "gesture": 3})"})
    EXPECT_EQ(posted("/edit", bad), 400) << bad;
  EXPECT_EQ(posted("/edit", "{\"set\": " + std::string(400, '[') + std::string(400, ']') + "}"), 400) << "nesting";
  for (const char* bad :
       {R"({"orbit": [1]})", R"({"orbit": [1e9, 0]})", R"({"zoom": 0})", R"({"zoom": "2"})", R"({"pan": [0, 1e400]})"})
    EXPECT_EQ(posted("/camera", bad), 400) << bad;
  EXPECT_EQ(posted("/camera", R"({"orbit": [0.1, 0], "zoom": 1.5})"), 200);
  EXPECT_EQ(posted("/control", R"({"control": "a"})"), 400);
  EXPECT_EQ(posted("/save", R"({"file": "a.json", "replace": 1})"), 400);
}

TEST(ServeRequest, RatesAreLimited) {
  const auto start = RateLimit::Clock::now();
  RateLimit limit(10, 5);
  int passed = 0;
  for (int i = 0; i < 100; ++i) passed += limit.allow(start);
  EXPECT_EQ(passed, 5);
  for (int i = 0; i < 100; ++i) passed += limit.allow(start + std::chrono::milliseconds(350));
  EXPECT_EQ(passed, 8);
}

}  // namespace
}  // namespace wale
