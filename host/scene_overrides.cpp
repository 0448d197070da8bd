#include "host/scene_overrides.h"

#include <algorithm>
#include <span>

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

// Made when absent, as an empty list or object.
JsonNode& member(JsonNode& object, const std::string& key, bool list, const std::string& option) {
  if (JsonNode* found = object.find(key)) return *found;
  object.members.push_back({key, {option, 0, 0}, {}});
  JsonNode& made = object.members.back().value;
  made.kind = list ? JsonNode::Kind::array : JsonNode::Kind::object;
  made.place = {option, 0, 0};
  return made;
}

// Sets what `keys` from `first` on lead to below the node; "*" leads to every element of a list. Null takes a key away.
void set(JsonNode& node, std::span<const std::string> keys, const JsonNode& value, const std::string& option,
         const std::string& path) {
  if (keys.empty()) {
    node = value;
    return;
  }
  const std::string& key = keys.front();
  const auto rest = keys.subspan(1);
  const std::string below = path + (path.empty() ? "" : ".") + key;
  if (key.empty()) user_error("{}: an empty key in the path", option);
  if (node.kind == JsonNode::Kind::array && key == "*")
    for (JsonNode& item : node.items) set(item, rest, value, option, below);
  else if (node.kind == JsonNode::Kind::array)
    set(element(node, key, option, path), rest, value, option, below);
  else if (key == "*")
    user_error("{}: {} is {}; \"*\" stands for the elements of a list", option, path.empty() ? "the scene" : path,
               node.describe());
  else if (node.kind == JsonNode::Kind::object && value.kind == JsonNode::Kind::null && (rest.empty() || !node.has(key)))
    std::erase_if(node.members, [&](const auto& one) { return one.key == key; });
  else if (node.kind == JsonNode::Kind::object)
    set(member(node, key, !rest.empty() && rest.front() == "*", option), rest, value, option, below);
  else
    user_error("{}: {} is {}, which has no \"{}\"", option, path.empty() ? "the scene" : path, node.describe(), key);
}

void apply(JsonNode& document, const std::string& override_text) {
  const std::string option = one_line("--set " + override_text);
  const size_t equals = override_text.find('=');
  if (equals == std::string::npos || equals == 0)
    user_error("{}: not of the form key.path=value, for example film.size=[256,256]", option);
  apply_override(document, override_text.substr(0, equals),
                 parse_option_value(override_text.substr(equals + 1), option), option);
}

}  // namespace

void apply_override(JsonNode& document, const std::string& path, const JsonNode& value, const std::string& option) {
  const auto keys = split(path);
  if (keys.size() > kMaxJsonDepth)
    user_error("{}: a path of {} keys; at most {}", option.substr(0, 60), keys.size(), kMaxJsonDepth);
  set(document, keys, value, option, "");
}

void apply_overrides(JsonNode& document, const std::vector<std::string>& overrides) {
  for (const auto& text : overrides) apply(document, text);
}

}  // namespace wale
