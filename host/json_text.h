#pragma once
#include <string>

#include "host/json_document.h"

namespace wale {

/// The document as JSON text. Short lists and objects stay on one line; numbers read back to the same double.
std::string json_text(const JsonNode& node);

/// A text as a JSON string, quotes and all.
std::string json_string(const std::string& text);

}  // namespace wale
