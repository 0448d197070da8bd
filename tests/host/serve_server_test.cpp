// `wale serve` as a process, under requests that no page sends. These are the tests that tests/sanitize.sh runs too.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <set>
#include <thread>

#include "host/serve/http_server.h"
#include "tests/host/serve_client.h"

namespace wale::test {
namespace {

// One server for all tests, as starting it is what takes long.
class ServeServer : public Cli {
 protected:
  static void TearDownTestSuite() {
    if (served_ && served_->up()) {
      EXPECT_EQ(served_->post("/stop", "{}").status, 200);
      EXPECT_EQ(served_->process().wait(30), 0) << served_->process().err();
      EXPECT_EQ(served_->process().err(), "");
    }
    served_.reset();
    home_.reset();
  }
  void SetUp() override {
    Cli::SetUp();
    if (!has_http_library()) GTEST_SKIP() << "built without cpp-httplib";
    if (!served_) {
      home_ = std::make_unique<TemporaryFolder>();
      const std::string scene = home_->write("scene.json", file_text(scene_)).string();
      served_ = std::make_unique<Served>(home_->path(), std::vector<std::string>{scene, "--quiet", "--size", "32x32"});
    }
    ASSERT_TRUE(served_->up()) << served_->process().err();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the test before may have asked as often as it could
  }
  void expect_alive() { EXPECT_EQ(served_->ask("GET", "/state").status, 200); }
  std::string stream_request() const {
    return fmt::format("GET /stream HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: {}\r\n\r\n", served_->token());
  }
  /// Header line of the first picture of an accepted edit.
  static std::string picture_of(const Served::Reply& accepted) {
    EXPECT_EQ(accepted.status, 200) << accepted.body;
    return fmt::format("X-Wale-Revision: {}\r\n", std::atoi(accepted.body.c_str() + std::strlen("{\"revision\": ")));
  }
  static inline std::unique_ptr<TemporaryFolder> home_;
  static inline std::unique_ptr<Served> served_;
};

TEST_F(ServeServer, HostileRequestsAreRefused) {
  const Served& s = *served_;
  const std::string good = R"({"set": ["film.exposure=1"]})", wrong(32, '0');
  EXPECT_EQ(s.ask("GET", "/?token=" + s.token()).status, 200);
  EXPECT_EQ(s.ask("GET", "/", "", "", &wrong).status, 401);
  EXPECT_EQ(s.ask("POST", "/edit", good, "", &wrong).status, 401);
  EXPECT_EQ(s.ask("POST", "/edit", good, "", nullptr, "evil.example").status, 403);
  EXPECT_EQ(s.ask("POST", "/edit", good, "Origin: http://evil.example\r\n").status, 403);
  for (const char* method : {"PUT", "DELETE", "OPTIONS", "TRACE", "HEAD", "PATCH"})
    EXPECT_EQ(s.ask(method, "/edit").status, 405) << method;
  for (const char* path : {"/../../etc/passwd", "/%2e%2e/etc/passwd", "/scene.json", "/.git/config", "//"})
    EXPECT_EQ(s.ask("GET", path).status, 404) << path;
  EXPECT_EQ(s.ask("POST", "/edit", std::string(70000, ' ')).status, 413);
  EXPECT_EQ(s.post("/edit", "{\"set\": " + std::string(30000, '[')).status, 400) << "a bomb";
  EXPECT_EQ(s.post("/edit", "{\"set\": [\"film.exposure=" + std::string(20000, '[') + "\"]}").status, 400);
  EXPECT_EQ(s.post("/edit", "{\"set\": [\"" + std::string(30000, 'a') + ".=1\"]}").status, 400);
  EXPECT_EQ(s.post("/edit", R"({"set": ["fabrics.0.mesh=/etc/passwd"]})").status, 400);
  EXPECT_EQ(s.post("/edit", "{\"set\": [\"\xff\xfe=1\"]}").status, 400);
  for (const char* name : {"../x.json", "/tmp/x.json", "x", ".x.json"})
    EXPECT_EQ(s.post("/save", std::string("{\"file\": \"") + name + "\"}").status, 400) << name;
  EXPECT_EQ(s.post("/save", R"({"file": "scene.json"})").status, 409);
  EXPECT_EQ(s.raw("GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(100000, 'a')).status, 431);
  EXPECT_EQ(s.raw("\x16\x03\x01\r\n\r\n").status, 400);
  EXPECT_EQ(s.raw("GET / HTTP/1.1\r\nHost: localhost\r\nRange: bytes=0-" + std::string(4000, ',') + "\r\n\r\n").status,
            400);
  EXPECT_EQ(s.raw("POST /edit HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n5\r\n").status, 400);
  // Two requests in one go: the second must not be answered with the first one's rights.
  const auto two =
      s.raw("GET /state HTTP/1.1\r\nHost: localhost\r\n\r\nGET /state HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: " +
            s.token() + "\r\n\r\n");
  EXPECT_EQ(two.status, 401);
  EXPECT_EQ(two.body.find("controls"), std::string::npos);
  expect_alive();
  // Whoever guesses tokens gets few tries.
  int refused = 0;
  for (int i = 0; i < 200; ++i) refused += s.ask("GET", "/state", "", "", &wrong).status == 429;
  EXPECT_GT(refused, 50);
  expect_alive();
}

TEST_F(ServeServer, ErrorsAreTheLinesOfTheCommandLine) {
  const auto reply = served_->post("/edit", R"({"set": ["film.exposure=99"]})");
  EXPECT_EQ(reply.status, 400);
  EXPECT_EQ(reply.body,
            "{\"error\": \"--set film.exposure=99: film.exposure: 99 is out of range; valid: -30 to 30\"}\n");
}

// One whose knit fails is found out later: the stream says so, and the scene is as before.
TEST_F(ServeServer, AnEditThatCannotBeKnittedIsTakenBack) {
  ASSERT_NE(served_->watch("image/jpeg", 120), "");
  EXPECT_EQ(served_->post("/edit", R"({"set": ["fabrics.0.gauge.wales=0.1"]})").status, 200);
  const std::string told = served_->watch("\"fault\": {", 60);
  EXPECT_NE(told.find("cloth"), std::string::npos) << told.substr(0, 2000);
  EXPECT_EQ(served_->ask("GET", "/state").body.find("wales=0.1\""), std::string::npos);
}

// So many segments that knitting them would take minutes.
TEST_F(ServeServer, AnEditThatWouldKnitForMinutesIsRefused) {
  ASSERT_NE(served_->watch("image/jpeg", 120), "");
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(served_->post("/edit", R"({"set": ["fabrics.0.gauge.wales=3000"]})").status, 200);
  const std::string told = served_->watch("segments, at most 2e+07 here", 60);
  EXPECT_NE(told, "");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 10);
  EXPECT_EQ(served_->ask("GET", "/state").body.find("wales=3000\""), std::string::npos);
}

TEST_F(ServeServer, ManyEditsAreCoalescedAndTheLastOneIsShown) {
  ASSERT_NE(served_->watch("image/jpeg", 120), "");
  const auto start = std::chrono::steady_clock::now();
  int accepted = 0;
  Served::Reply last;
  for (int i = 0; i < 400; ++i) {
    const auto reply = served_->post("/edit", fmt::format("{{\"set\": [\"camera.fov={:g}\"]}}", 20 + i * 0.01));
    accepted += reply.status == 200;
    if (reply.status == 200) last = reply;
    EXPECT_TRUE(reply.status == 200 || reply.status == 429) << reply.status;
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_GT(accepted, 300);
  std::printf("%d edits in %.2f s\n", accepted, seconds);
  EXPECT_NE(served_->watch(picture_of(last), 60), "");
}

// A control that is dragged: whenever a version has been made, the next one is there already.
TEST_F(ServeServer, PicturesAreSeenInTheMiddleOfADrag) {
  ASSERT_NE(served_->watch("image/jpeg", 120), "");
  const int viewer = served_->connect();
  ::send(viewer, stream_request().data(), stream_request().size(), MSG_NOSIGNAL);
  int first = 0, last = 0;
  std::string stream;
  std::set<int> seen;
  std::vector<char> bytes(1 << 16);
  const std::string name = "X-Wale-Revision: ";
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(120);  // a machine may be slow
  for (int i = 0; seen.size() < 5 && std::chrono::steady_clock::now() < until; ++i) {
    const auto reply = served_->post(
        "/edit", fmt::format(R"({{"set": ["fabrics.0.gauge.wales={:g}"], "gesture": "drag"}})", 30 + i * 1e-3));
    if (reply.status != 200) continue;  // more than a hand can do
    last = std::atoi(reply.body.c_str() + std::strlen("{\"revision\": "));
    if (first == 0) first = last;
    for (ssize_t n; (n = ::recv(viewer, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;)
      stream.append(bytes.data(), size_t(n));
    const size_t whole = stream.rfind("\r\n");
    if (whole == std::string::npos) continue;
    size_t at = 0;
    for (size_t next; (next = stream.find(name, at)) < whole; at = next + name.size())
      if (const int revision = std::atoi(stream.c_str() + next + name.size()); revision >= first && revision < last)
        seen.insert(revision);
    stream.erase(0, std::max(at, whole));
  }
  ::close(viewer);
  std::printf("%d versions, %zu of them seen meanwhile\n", last - first, seen.size());
  EXPECT_GE(seen.size(), 5u);
}

// How a picture is shown, or how good it has to be, needs no new one.
TEST_F(ServeServer, ExposureAndGoalKeepTheSamples) {
  ASSERT_EQ(served_->post("/control", R"({"control": "view.goal", "value": "0.2"})").status, 200);
  ASSERT_NE(served_->watch("\"status\": \"done\"", 120), "");
  for (const char* edit :
       {R"({"control": "film.exposure", "value": 1.5})", R"({"control": "view.goal", "value": "0.1"})"}) {
    const std::string picture = picture_of(served_->post("/control", edit));
    const std::string stream = served_->watch(picture, 60);
    ASSERT_NE(stream, "") << edit;
    const size_t head = stream.rfind("X-Wale-Revision");
    std::string rest = stream.substr(head);
    const size_t at = rest.find("X-Wale-Samples: ");
    ASSERT_NE(at, std::string::npos) << rest.substr(0, 200);
    EXPECT_GE(std::atoi(rest.c_str() + at + 16), 16) << edit;
  }
}

TEST_F(ServeServer, ViewersThatLeaveOrSleepHarmNothing) {
  ASSERT_NE(served_->watch("image/jpeg", 120), "");
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  for (int left = 0; left < 12 && std::chrono::steady_clock::now() < until;) {  // gone in mid-stream
    const int socket = served_->connect();
    ::send(socket, stream_request().data(), stream_request().size(), MSG_NOSIGNAL);
    char bytes[100] = {};
    EXPECT_GT(::recv(socket, bytes, sizeof(bytes) - 1, 0), 0);
    ::close(socket);
    const bool taken = std::string(bytes).starts_with("HTTP/1.1 200");
    left += taken;  // else there are as many as may watch, until it is noticed that they have gone
    if (!taken) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (left == 12) break;
    EXPECT_LT(std::chrono::steady_clock::now(), until) << "viewers that left still count";
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));  // they have been noticed
  std::vector<int> asleep;                                       // never read a byte
  for (int i = 0; i < 6; ++i) {
    asleep.push_back(served_->connect());
    ::send(asleep.back(), stream_request().data(), stream_request().size(), MSG_NOSIGNAL);
  }
  const auto edit = served_->post("/edit", R"({"set": ["film.exposure=0.5"]})");
  EXPECT_NE(served_->watch(picture_of(edit), 60), "");
  for (const int socket : asleep) ::close(socket);
}

TEST_F(ServeServer, ConnectionsAreBoundedAndSlowOnesEnd) {
  std::vector<int> idle;
  for (int i = 0; i < 60; ++i) idle.push_back(served_->connect());
  for (const int socket : idle) ::send(socket, "GET", 3, MSG_NOSIGNAL);  // and never a word more
  const auto start = std::chrono::steady_clock::now();
  double seconds = 0;
  do {
    std::this_thread::sleep_for(std::chrono::milliseconds(250));
    seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  } while (served_->ask("GET", "/state").status != 200 && seconds < 10);  // HttpLimits::read_seconds is 5
  expect_alive();
  EXPECT_LT(seconds, 10);
  for (const int socket : idle) ::close(socket);
}

TEST_F(ServeServer, EndsWithSignals) {
  for (const int number : {SIGINT, SIGTERM}) {
    Served other(folder_.path(), {scene_, "--quiet", "--size", "32x32"});
    ASSERT_TRUE(other.up());
    const int viewer = other.connect();
    const std::string request =
        fmt::format("GET /stream HTTP/1.1\r\nHost: localhost\r\nX-Wale-Token: {}\r\n\r\n", other.token());
    ::send(viewer, request.data(), request.size(), MSG_NOSIGNAL);
    other.process().signal(number);
    EXPECT_EQ(other.process().wait(60), 0) << number;
    ::close(viewer);
  }
}

TEST_F(ServeServer, APortThatIsTakenIsNamed) {
  const Outcome run = run_wale({"serve", scene_, "--port", std::to_string(served_->port())});
  EXPECT_EQ(run.status, 1);
  EXPECT_NE(run.err.find("the port is taken"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace wale::test
