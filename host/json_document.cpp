#include "host/json_document.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "geom/error.h"

namespace wale {
namespace {

using nlohmann::json;

// Follows the tokens of a text that nlohmann's lexer reads. Its SAX events carry no positions, but they come once per
// token and in order, so the start of a token is found by skipping blanks, comments and separators after the last one.
class TokenCursor {
 public:
  TokenCursor(const std::string& text, const std::string& source) : text_(text), source_(source) {
    if (text_.compare(0, 3, "\xEF\xBB\xBF") == 0) at_ = 3;
  }

  Place next_token() {
    skip_gaps();
    const Place place{source_, line_, column_};
    const char c = at_ < text_.size() ? text_[at_] : '\0';
    if (c == '"') {
      step();
      while (at_ < text_.size() && text_[at_] != '"') {
        if (text_[at_] == '\\') step();
        step();
      }
      step();
    } else if (c == '{' || c == '}' || c == '[' || c == ']') {
      step();
    } else {
      while (at_ < text_.size() && !std::strchr(" \t\r\n,:{}[]/\"", text_[at_])) step();
    }
    return place;
  }

  // Place of a byte counted from the start of the text.
  Place place_of(size_t byte) {
    at_ = 0, line_ = 1, column_ = 1;
    while (at_ < std::min(byte, text_.size())) step();
    return {source_, line_, column_};
  }

 private:
  void step() {
    if (at_ >= text_.size()) return;
    const auto byte = static_cast<unsigned char>(text_[at_++]);
    if (byte == '\n') {
      ++line_, column_ = 1;
    } else if (at_ >= text_.size() || (static_cast<unsigned char>(text_[at_]) & 0xC0) != 0x80) {
      ++column_;  // counted at the last byte of a UTF-8 character
    }
  }

  void skip_gaps() {
    while (at_ < text_.size()) {
      if (std::strchr(" \t\r\n,:", text_[at_])) {
        step();
      } else if (text_.compare(at_, 2, "//") == 0) {
        while (at_ < text_.size() && text_[at_] != '\n') step();
      } else if (text_.compare(at_, 2, "/*") == 0) {
        const size_t end = text_.find("*/", at_ + 2);
        while (at_ < std::min(end == std::string::npos ? end : end + 2, text_.size())) step();
      } else {
        return;
      }
    }
  }

  const std::string& text_;
  const std::string& source_;
  size_t at_ = 0;
  int line_ = 1, column_ = 1;
};

class TreeBuilder : public nlohmann::json_sax<json> {
 public:
  TreeBuilder(const std::string& text, const std::string& source) : cursor_(text, source) {}

  JsonNode take() { return std::move(root_); }

  bool null() override { return leaf(JsonNode::Kind::null), true; }
  bool boolean(bool value) override { return leaf(JsonNode::Kind::boolean).boolean = value, true; }
  bool number_integer(number_integer_t value) override {
    return leaf(JsonNode::Kind::integer).number = static_cast<double>(value), true;
  }
  bool number_unsigned(number_unsigned_t value) override {
    return leaf(JsonNode::Kind::integer).number = static_cast<double>(value), true;
  }
  bool number_float(number_float_t value, const string_t&) override {
    return leaf(JsonNode::Kind::number).number = value, true;
  }
  bool string(string_t& value) override { return leaf(JsonNode::Kind::string).text = value, true; }
  bool binary(binary_t&) override { return false; }  // does not occur in text
  bool start_object(size_t) override { return open(JsonNode::Kind::object); }
  bool start_array(size_t) override { return open(JsonNode::Kind::array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const Place place = cursor_.next_token();
    JsonNode& object = *stack_.back();
    if (!keys_.back().insert(name).second) {
      for (const auto& member : object.members)
        if (member.key == name)
          fail_at(place, fmt::format("\"{}\"", name),
                  fmt::format("given twice; the first is in line {}", member.place.line));
    }
    object.members.push_back({name, place, {}});
    return true;
  }

  bool parse_error(size_t position, const std::string&, const nlohmann::detail::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 2, column 3: syntax error ...": our own place is enough.
    std::string what = error.what();
    const size_t bracket = what.find("] ");
    if (bracket != std::string::npos) what.erase(0, bracket + 2);
    if (what.compare(0, 11, "parse error") == 0) what.erase(0, std::min(what.size(), what.find(": ") + 2));
    user_error("{}: {}", cursor_.place_of(position ? position - 1 : 0).text(), what);
  }

 private:
  JsonNode& leaf(JsonNode::Kind kind) {
    JsonNode* node = &root_;
    if (!stack_.empty()) {
      JsonNode& parent = *stack_.back();
      // A parent's vector grows only while its children are closed, so the pointers on the stack stay valid.
      node = parent.kind == JsonNode::Kind::array ? &parent.items.emplace_back() : &parent.members.back().value;
    }
    node->kind = kind;
    node->place = cursor_.next_token();
    return *node;
  }

  bool open(JsonNode::Kind kind) {
    JsonNode& node = leaf(kind);
    if (stack_.size() >= kMaxJsonDepth) user_error("{}: nested deeper than {} levels", node.place.text(), kMaxJsonDepth);
    stack_.push_back(&node);
    keys_.emplace_back();
    return true;
  }

  bool close() {
    cursor_.next_token();
    stack_.pop_back();
    keys_.pop_back();
    return true;
  }

  TokenCursor cursor_;
  JsonNode root_;
  std::vector<JsonNode*> stack_;
  std::vector<std::set<std::string>> keys_;
};

void set_place(JsonNode& node, const Place& place) {
  node.place = place;
  for (auto& item : node.items) set_place(item, place);
  for (auto& member : node.members) {
    member.place = place;
    set_place(member.value, place);
  }
}

}  // namespace

std::string Place::text() const { return line ? fmt::format("{}:{}:{}", source, line, column) : source; }

const JsonNode* JsonNode::find(std::string_view key) const {
  for (const auto& member : members)
    if (member.key == key) return &member.value;
  return nullptr;
}

JsonNode* JsonNode::find(std::string_view key) {
  return const_cast<JsonNode*>(static_cast<const JsonNode*>(this)->find(key));
}

const JsonNode& JsonNode::operator[](std::string_view key) const {
  const JsonNode* node = find(key);
  if (!node) bug("scene reader: the key \"{}\" was not checked before it was read", key);
  return *node;
}

std::string JsonNode::describe() const {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return boolean ? "true" : "false";
    case Kind::integer:
    case Kind::number:
      return fmt::format("the number {:g}", number);
    case Kind::string:
      return text.size() <= 40 ? json(text).dump(-1, ' ', false, json::error_handler_t::replace) : "a long text";
    case Kind::array:
      return fmt::format("a list of {}", items.size());
    case Kind::object:
      return "an object";
  }
  return "nothing";
}

JsonNode parse_json(const std::string& text, const std::string& source) {
  TreeBuilder builder(text, source);
  json::sax_parse(text, &builder, json::input_format_t::json, true, true);
  return builder.take();
}

JsonNode read_json(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    user_error("{}: this is a folder; a JSON file is needed", file.string());
  std::ifstream in(file, std::ios::binary);
  if (!in) user_error("{}: cannot read this file", file.string());
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return parse_json(text, file.string());
}

JsonNode parse_option_value(const std::string& value, const std::string& option) {
  JsonNode node;
  try {
    node = parse_json(value, option);
  } catch (const Error&) {
    node = {};
    node.kind = JsonNode::Kind::string;
    node.text = value;
  }
  set_place(node, {option, 0, 0});
  return node;
}

void fail_at(const Place& place, const std::string& path, const std::string& what) {
  user_error("{}: {}: {}", place.text(), path, what);
}

}  // namespace wale
