#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace wale::fit {

/// The fields of one message of Protocol Buffers, one after another, without its description (protobuf.dev,
/// "Encoding"). Throws user errors that begin with `name` where the bytes are no such message; never reads past them.
///
///     ProtobufFields fields(bytes, name);
///     while (fields.next()) if (fields.number() == 7) use(fields.bytes());
class ProtobufFields {
 public:
  ProtobufFields(std::string_view message, const std::string& name) : rest_(message), name_(name) {}

  /// Goes to the next field; false behind the last one.
  bool next();
  uint32_t number() const { return number_; }
  bool is_bytes() const { return type_ == 2; }
  bool is_integer() const { return type_ == 0; }
  /// Texts, messages, packed numbers; empty for fields of other kinds.
  std::string_view bytes() const { return bytes_; }
  /// Varints; 0 for fields of other kinds.
  uint64_t integer() const { return integer_; }

 private:
  std::string_view take(uint64_t count);

  std::string_view rest_, bytes_;
  const std::string& name_;
  uint32_t number_ = 0, type_ = 0;
  uint64_t integer_ = 0;
};

/// Varints one after another, as a packed field holds them.
class PackedVarints {
 public:
  PackedVarints(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}
  bool next(uint64_t& value);

 private:
  std::string_view rest_;
  const std::string& name_;
};

}  // namespace wale::fit
