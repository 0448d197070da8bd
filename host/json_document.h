#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace wale {

/// Where a value was written: a file with line and column (counted from 1, columns in characters), or a command line
/// option (line 0).
struct Place {
  std::string source;
  int line = 0, column = 0;
  /// "file:line:column", or the option alone.
  std::string text() const;
};

/// Levels that a document may be nested.
constexpr size_t kMaxJsonDepth = 64;

/// One value of a JSON document that remembers where it stands. Members keep the order of the file.
struct JsonNode {
  enum class Kind { null, boolean, integer, number, string, array, object } kind = Kind::null;
  struct Member;
  Place place;
  bool boolean = false;
  double number = 0;          ///< integers too
  bool between_keys = false;  ///< a number that lies between those of two key frames
  /// Of a number from key frames: the first of its keys' numbers that is not whole, wherever the frame lies.
  std::shared_ptr<const JsonNode> key_with_fraction{};
  std::string text;
  std::vector<JsonNode> items;
  std::vector<Member> members;

  bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
  /// The member of this name, or null.
  const JsonNode* find(std::string_view key) const;
  JsonNode* find(std::string_view key);
  /// The member of this name; asking for one that is absent is a bug.
  const JsonNode& operator[](std::string_view key) const;
  bool has(std::string_view key) const { return find(key) != nullptr; }
  /// "an object", "the number 3": for messages.
  std::string describe() const;
};

struct JsonNode::Member {
  std::string key;
  Place place;  ///< of the key
  JsonNode value;
};

/// Parses JSON text (comments allowed). Throws one-line user errors "source:line:column: ..." on bad syntax, a key
/// given twice, numbers beyond double, nesting deeper than kMaxJsonDepth.
JsonNode parse_json(const std::string& text, const std::string& source);

/// The same from a file; a missing or unreadable file is a user error.
JsonNode read_json(const std::filesystem::path& file);

/// A value given on the command line: JSON if it parses, else the text itself as a string. Every place is `option`.
JsonNode parse_option_value(const std::string& value, const std::string& option);

/// Throws the user error "place: path: what" as one line, whatever control characters the user's texts hold.
[[noreturn]] void fail_at(const Place& place, const std::string& path, const std::string& what);

}  // namespace wale
