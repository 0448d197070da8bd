#pragma once
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "host/serve/http_server.h"

namespace wale {

/// What all viewers see: the newest message of each topic. A viewer that is slow misses those between and holds up
/// nobody; one that is gone is noticed at the next message, or at a sign of life every second.
class ViewerFeed {
 public:
  explicit ViewerFeed(size_t most_viewers) : most_(most_viewers) {}

  /// The message becomes a part of a multipart stream, with these header lines beside its type and length.
  void publish(const std::string& topic, const std::string& type, const std::string& body,
               const std::vector<std::pair<std::string, std::string>>& headers = {});
  void forget(const std::string& topic);
  /// A reply that streams to one viewer: all topics now, then what is new. 503 when there are too many.
  HttpReply join();
  /// Ends all streams.
  void close();
  size_t viewers() const;

 private:
  struct Message {
    uint64_t number = 0;
    std::shared_ptr<const std::string> part;
  };
  struct Viewer;
  bool serve(Viewer& viewer, const HttpWrite& write);

  size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, Message> topics_;
  uint64_t number_ = 0;
  size_t viewers_ = 0;
  bool closed_ = false;
};

}  // namespace wale
