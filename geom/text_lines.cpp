#include "geom/text_lines.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>

namespace wale {

std::string read_bytes(const std::filesystem::path& file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) user_error("{}: no such file", file.string());
  if (std::filesystem::is_directory(file, failed)) user_error("{}: is a folder; name a file", file.string());
  std::ifstream in(file, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) user_error("{}: cannot be read", file.string());
  return bytes;
}

std::vector<TextLine> text_lines(std::string_view text, char comment) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  std::vector<TextLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (comment != '\0') rest = rest.substr(0, rest.find(comment));
    TextLine line{number, {}};
    for (size_t from; (from = rest.find_first_not_of(kBlank)) != std::string_view::npos;) {
      rest.remove_prefix(from);
      const size_t length = std::min(rest.find_first_of(kBlank), rest.size());
      line.words.push_back(rest.substr(0, length));
      rest.remove_prefix(length);
    }
    if (!line.words.empty()) lines.push_back(std::move(line));
  }
  return lines;
}

double finite_number(const std::filesystem::path& file, int line, std::string_view word) {
  double value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, failed] = std::from_chars(word.data(), end, value);
  if (failed != std::errc() || stop != end) user_error("{}:{}: '{}' is not a number", file.string(), line, word);
  if (!std::isfinite(value)) user_error("{}:{}: '{}' is not a finite number", file.string(), line, word);
  return value;
}

long whole_number(const std::filesystem::path& file, int line, std::string_view word) {
  long value = 0;
  const char* end = word.data() + word.size();
  const auto [stop, failed] = std::from_chars(word.data(), end, value);
  if (failed != std::errc() || stop != end) user_error("{}:{}: '{}' is not a whole number", file.string(), line, word);
  return value;
}

void write_whole_file(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path temporary = file;
  temporary += ".tmp";
  {
    std::ofstream out(temporary, std::ios::binary);
    out.write(text.data(), static_cast<std::streamsize>(text.size()));
    out.flush();
    if (!out) user_error("{}: cannot be written; choose a folder that exists and is writable", file.string());
  }
  std::error_code failed;
  std::filesystem::rename(temporary, file, failed);
  if (failed) user_error("{}: cannot be written: {}", file.string(), failed.message());
}

}  // namespace wale
