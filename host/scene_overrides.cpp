#include "host/scene_overrides.h"

#include <algorithm>

#include "geom/error.h"
#include "host/suggest.h"

namespace wale {
namespace {

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> keys;
  size_t from = 0;
  while (true) {
    const size_t dot = path.find('.', from);
    keys.push_back(path.substr(from, dot == std::string::npos ? dot : dot - from));
    if (dot == std::string::npos) return keys;
    from = dot + 1;
  }
}

JsonNode& element(JsonNode& list, const std::string& key, const std::string& option, const std::string& path) {
  const bool index = !key.empty() && key.size() < 9 &&
                     std::all_of(key.begin(), key.end(), [](unsigned char c) { return std::isdigit(c); });
  if (index) {
    const size_t at = std::stoul(key);
    if (at < list.items.size()) return list.items[at];
    if (list.items.empty()) user_error("{}: {}: this list is empty", option, path);
    user_error("{}: {}: there is no element {}; valid: 0 to {}", option, path, key, list.items.size() - 1);
  }
  std::vector<std::string> names;
  for (auto& item : list.items) {
    const JsonNode* name = item.find("name");
    if (!name || name->kind != JsonNode::Kind::string) continue;
    if (name->text == key) return item;
    names.push_back(name->text);
  }
  user_error("{}: {}: no element is named \"{}\"; {}", option, path, key,
             names.empty() ? "elements are numbered from 0" : nearest_choice(key, names));
}

JsonNode& member(JsonNode& object, const std::string& key, const std::string& option) {
  if (JsonNode* found = object.find(key)) return *found;
  object.members.push_back({key, {option, 0, 0}, {}});
  JsonNode& made = object.members.back().value;
  made.kind = JsonNode::Kind::object;
  made.place = {option, 0, 0};
  return made;
}

void apply(JsonNode& document, const std::string& override_text) {
  const std::string option = one_line("--set " + override_text);
  const size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0)
    user_error("{}: not of the form key.path=value, for example film.size=[256,256]", option);
  JsonNode* node = &document;
  std::string path;
  const auto keys = split(override_text.substr(0, equals));
  if (keys.size() > kMaxJsonDepth)
    user_error("{}: a path of {} keys; at most {}", option.substr(0, 60), keys.size(), kMaxJsonDepth);
  for (const auto& key : keys) {
    if (key.empty()) user_error("{}: an empty key in the path", option);
    if (node->kind == JsonNode::Kind::array)
      node = &element(*node, key, option, path);
    else if (node->kind == JsonNode::Kind::object)
      node = &member(*node, key, option);
    else
      user_error("{}: {} is {}, which has no \"{}\"", option, path.empty() ? "the scene" : path, node->describe(), key);
    path += (path.empty() ? "" : ".") + key;
  }
  *node = parse_option_value(override_text.substr(equals + 1), option);
}

}  // namespace

void apply_overrides(JsonNode& document, const std::vector<std::string>& overrides) {
  for (const auto& text : overrides) apply(document, text);
}

}  // namespace wale
