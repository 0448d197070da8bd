#pragma once
#include <string>
#include <vector>

#include "host/json_document.h"

namespace wale {

/// Applies "key.path=value" options (--set) to a document, before it is checked. Elements of lists are named by index
/// by their "name", or all by "*"; objects on the way are made when absent (the check refuses unknown ones). The value
/// null takes a key away. What is set carries the option as its place. Throws user errors that name the option and the nearest key.
void apply_overrides(JsonNode& document, const std::vector<std::string>& overrides);

/// The same of one path and value, which keeps its place; `option` begins messages.
void apply_override(JsonNode& document, const std::string& path, const JsonNode& value, const std::string& option);

}  // namespace wale
