#include "host/fit/npy.h"

#include <algorithm>
#include <charconv>
#include <cstring>

#include "geom/error.h"

namespace wale::fit {
namespace {

constexpr size_t kMostAxes = 8;

// What the header says: a Python dictionary of three entries.
struct Header {
  std::string type;
  bool fortran = false;
  std::vector<size_t> shape;
};

class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Header read() {
    Header header;
    bool type = false, order = false, shape = false;
    expect('{');
    while (!take('}')) {
      const std::string key = quoted();
      expect(':');
      if (key == "descr")
        header.type = quoted(), type = true;
      else if (key == "fortran_order")
        header.fortran = truth(), order = true;
      else if (key == "shape")
        header.shape = tuple(), shape = true;
      else
        fail();
      if (!take(',') && peek() != '}') fail();
    }
    if (!type || !order || !shape) fail();
    return header;
  }

 private:
  [[noreturn]] void fail() const {
    user_error("{}: its header is not that of an array: {}", name_, std::string(text_.substr(0, 100)));
  }
  char peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  bool take(char c) { return peek() == c && ++at_; }
  void expect(char c) {
    if (!take(c)) fail();
  }
  std::string quoted() {
    const char quote = peek();
    if (quote != '\'' && quote != '"') fail();
    const size_t end = text_.find(quote, ++at_);
    if (end == std::string_view::npos) fail();
    std::string word(text_.substr(at_, end - at_));
    at_ = end + 1;
    return word;
  }
  bool truth() {
    peek();
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (text_.substr(std::min(at_, text_.size()), word.size()) != word) continue;
      at_ += word.size();
      return value;
    }
    fail();
  }
  std::vector<size_t> tuple() {
    std::vector<size_t> values;
    expect('(');
    while (!take(')')) {
      peek();
      size_t value = 0;
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
      if (error != std::errc() || values.size() == kMostAxes) fail();
      values.push_back(value);
      at_ = size_t(end - text_.data());
      if (!take(',') && peek() != ')') fail();
    }
    return values;
  }

  std::string_view text_;
  const std::string& name_;
  size_t at_ = 0;
};

template <typename Number>
std::vector<float> numbers(std::string_view bytes, size_t count) {
  std::vector<float> values(count);
  for (size_t i = 0; i < count; ++i) {
    Number value;
    std::memcpy(&value, bytes.data() + i * sizeof(Number), sizeof(Number));
    values[i] = float(value);
  }
  return values;
}

// From the first index fastest to the last index fastest.
std::vector<float> row_major(const std::vector<float>& values, const std::vector<size_t>& shape) {
  std::vector<float> out(values.size());
  std::vector<size_t> index(shape.size());
  for (size_t i = 0; i < out.size(); ++i) {
    size_t at = 0;
    for (size_t axis = shape.size(); axis-- > 0;) at = at * shape[axis] + index[axis];
    out[i] = values[at];
    for (size_t axis = shape.size(); axis-- > 0 && ++index[axis] == shape[axis];) index[axis] = 0;
  }
  return out;
}

}  // namespace

std::string shape_text(const std::vector<size_t>& shape) { return fmt::format("{}", fmt::join(shape, " x ")); }

NpyArray parse_npy(std::string_view bytes, const std::string& name) {
  constexpr std::string_view kMagic = "\x93NUMPY";
  if (bytes.size() < 12 || !bytes.starts_with(kMagic)) user_error("{}: not a .npy file", name);
  const auto byte = [&](size_t i) { return size_t(static_cast<unsigned char>(bytes[i])); };
  const size_t version = byte(6), start = version == 1 ? 10 : 12;
  if (version < 1 || version > 3) user_error("{}: .npy version {}; valid: 1, 2, 3", name, version);
  size_t length = byte(8) | byte(9) << 8;
  if (version > 1) length |= byte(10) << 16 | byte(11) << 24;
  if (length > bytes.size() - start) user_error("{}: is cut off in its header", name);
  const Header header = HeaderReader(bytes.substr(start, length), name).read();
  const size_t size = header.type == "<f4" ? 4 : header.type == "<f8" ? 8 : 0;
  if (size == 0)
    user_error("{}: numbers of type \"{}\"; valid: \"<f4\", \"<f8\" (array.astype('<f4'))", name, header.type);
  const std::string_view data = bytes.substr(start + length);
  size_t count = 1;
  for (const size_t extent : header.shape) {
    if (extent != 0 && count > data.size() / extent)
      user_error("{}: {} numbers do not fit into its {} bytes", name, shape_text(header.shape), data.size());
    count *= extent;
  }
  if (data.size() != count * size)
    user_error("{}: {} bytes for {} numbers of {}; is it cut off?", name, data.size(), count, size);
  NpyArray array{header.shape, size == 4 ? numbers<float>(data, count) : numbers<double>(data, count)};
  if (header.fortran) array.values = row_major(array.values, array.shape);
  return array;
}

}  // namespace wale::fit
