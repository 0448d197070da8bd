#include "host/serve/access_token.h"

#include <sys/random.h>

#include <array>

#include "geom/error.h"

namespace wale {

std::string make_access_token() {
  std::array<unsigned char, 16> bytes{};
  for (size_t have = 0; have < bytes.size();) {
    const ssize_t got = ::getrandom(bytes.data() + have, bytes.size() - have, 0);
    if (got <= 0) bug("serve: the operating system gives no random numbers");
    have += size_t(got);
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool same_secret(std::string_view a, std::string_view b) {
  volatile unsigned char different = a.size() != b.size();
  for (size_t i = 0; i < a.size(); ++i)
    different = different | static_cast<unsigned char>(a[i] ^ (b.empty() ? 0 : b[i % b.size()]));
  return different == 0;
}

}  // namespace wale
