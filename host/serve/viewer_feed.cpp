#include "host/serve/viewer_feed.h"

#include <fmt/format.h>

#include <chrono>

#include "host/serve/editor_request.h"

namespace wale {
namespace {

constexpr const char* kBoundary = "wale-part";
constexpr std::chrono::seconds kSignOfLife{1};

std::string part_of(const std::string& topic, const std::string& type, const std::string& body,
                    const std::vector<std::pair<std::string, std::string>>& headers) {
  std::string out = fmt::format("--{}\r\nContent-Type: {}\r\nContent-Length: {}\r\nX-Wale-Topic: {}\r\n", kBoundary,
                                type, body.size(), topic);
  for (const auto& [name, value] : headers) out += name + ": " + value + "\r\n";
  return out + "\r\n" + body + "\r\n";
}

}  // namespace

struct ViewerFeed::Viewer {
  explicit Viewer(ViewerFeed& its_feed) : feed(its_feed) {}
  ~Viewer() {
    const std::lock_guard lock(feed.mutex_);
    --feed.viewers_;
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ViewerFeed& feed;
  uint64_t seen = 0;
};

void ViewerFeed::publish(const std::string& topic, const std::string& type, const std::string& body,
                         const std::vector<std::pair<std::string, std::string>>& headers) {
  auto part = std::make_shared<const std::string>(part_of(topic, type, body, headers));
  const std::lock_guard lock(mutex_);
  topics_[topic] = {++number_, std::move(part)};
  changed_.notify_all();
}

void ViewerFeed::forget(const std::string& topic) {
  const std::lock_guard lock(mutex_);
  topics_.erase(topic);
}

HttpReply ViewerFeed::join() {
  {
    const std::lock_guard lock(mutex_);
    if (closed_ || viewers_ >= most_)
      return refusal(503, fmt::format("there are {} viewers already; close one of them", viewers_));
    ++viewers_;
  }
  HttpReply reply;
  reply.type = fmt::format("multipart/mixed; boundary={}", kBoundary);
  reply.stream = [this, viewer = std::make_shared<Viewer>(*this)](const HttpWrite& write) {
    return serve(*viewer, write);
  };
  return reply;
}

bool ViewerFeed::serve(Viewer& viewer, const HttpWrite& write) {
  std::vector<std::shared_ptr<const std::string>> parts;
  {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kSignOfLife, [&] { return closed_ || number_ > viewer.seen; });
    if (closed_) return false;
    for (const auto& [topic, message] : topics_)
      if (message.number > viewer.seen) parts.push_back(message.part);
    viewer.seen = number_;
  }
  if (parts.empty()) return write(part_of("alive", "application/json", "{}", {}));
  for (const auto& part : parts)
    if (!write(*part)) return false;
  return true;
}

void ViewerFeed::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

size_t ViewerFeed::viewers() const {
  const std::lock_guard lock(mutex_);
  return viewers_;
}

}  // namespace wale
