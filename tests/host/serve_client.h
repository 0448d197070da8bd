#pragma once
#include <string>
#include <vector>

#include "tests/host/cli_fixture.h"

namespace wale::test {

/// A running `wale serve` and what a browser, or somebody hostile, may send it.
class Served {
 public:
  Served(const std::filesystem::path& folder, const std::vector<std::string>& args);

  struct Reply {
    int status = 0;  ///< 0: the server closed without a word
    std::string head, body;
  };
  /// Sends bytes as they are and reads one reply; `wait` in seconds.
  Reply raw(const std::string& bytes, double wait = 20) const;
  /// A request as the page sends it, with more header lines and another token where given.
  Reply ask(const std::string& method, const std::string& path, const std::string& body = "",
            const std::string& more = "", const std::string* token = nullptr, const std::string& host = "") const;
  Reply post(const std::string& path, const std::string& body) const { return ask("POST", path, body); }
  /// Bytes of the stream until `text` has come; empty when it does not come in `seconds`.
  std::string watch(const std::string& text, double seconds) const;
  /// A connected socket.
  int connect() const;

  Process& process() { return process_; }
  const std::string& token() const { return token_; }
  int port() const { return port_; }
  bool up() const { return port_ > 0; }
  long resident_kib() const;

 private:
  Process process_;
  std::string token_;
  int port_ = -1;
};

}  // namespace wale::test
