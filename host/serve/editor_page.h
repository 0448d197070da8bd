#pragma once
#include <map>
#include <string>

#include "host/serve/http_server.h"

namespace wale {

/// Files of host/serve/page by name.
const std::map<std::string, std::string>& embedded_page();

/// The page, with a policy that lets it load nothing but what it holds and talk to nobody but this server.
HttpReply editor_page();

}  // namespace wale
