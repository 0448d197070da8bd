#include "geom/json_value.h"

#include <algorithm>

namespace wale {

using Json = nlohmann::json;

Json parse_json(std::string_view text, const std::string& file) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const size_t at = std::min<size_t>(error.byte, text.size());
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at > 0 ? at - 1 : 0), '\n');
    user_error("{}:{}: {}", file, line, error.what());
  } catch (const Json::exception& error) {  // a number beyond double
    user_error("{}: {}", file, error.what());
  }
}

}  // namespace wale
