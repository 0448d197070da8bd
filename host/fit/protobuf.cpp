#include "host/fit/protobuf.h"

#include "geom/error.h"

namespace wale::fit {
namespace {

// Groups of 7 bits, the lowest first; the last byte has no high bit.
uint64_t take_varint(std::string_view& rest, const std::string& name) {
  uint64_t value = 0;
  for (unsigned shift = 0; shift < 64; shift += 7) {
    if (rest.empty()) user_error("{}: is cut off within a number", name);
    const auto byte = static_cast<unsigned char>(rest.front());
    rest.remove_prefix(1);
    value |= uint64_t(byte & 0x7F) << shift;
    if (!(byte & 0x80)) return value;
  }
  user_error("{}: holds a number of more than 64 bits; is it damaged?", name);
}

}  // namespace

std::string_view ProtobufFields::take(uint64_t count) {
  if (count > rest_.size()) user_error("{}: is cut off: a field of {} bytes has {}", name_, count, rest_.size());
  const std::string_view taken = rest_.substr(0, size_t(count));
  rest_.remove_prefix(size_t(count));
  return taken;
}

bool ProtobufFields::next() {
  bytes_ = {};
  integer_ = 0;
  if (rest_.empty()) return false;
  const uint64_t tag = take_varint(rest_, name_);
  number_ = uint32_t(tag >> 3);
  type_ = uint32_t(tag & 7);
  if (tag >> 3 == 0 || tag >> 32 != 0) user_error("{}: a field has no number; is it damaged?", name_);
  switch (type_) {
    case 0:
      integer_ = take_varint(rest_, name_);
      return true;
    case 1:
      take(8);
      return true;
    case 2:
      bytes_ = take(take_varint(rest_, name_));
      return true;
    case 5:
      take(4);
      return true;
    default:
      user_error("{}: a field of kind {}; is it damaged?", name_, type_);
  }
}

bool PackedVarints::next(uint64_t& value) {
  if (rest_.empty()) return false;
  value = take_varint(rest_, name_);
  return true;
}

}  // namespace wale::fit
