#pragma once
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "geom/error.h"

namespace wale {

/// One line of a text that is not blank, cut into words, with its number in the text (from 1). The words lie in the
/// text, which has to outlive them.
struct TextLine {
  int number = 0;
  std::vector<std::string_view> words;
};

/// The whole file as bytes. Throws a user error if it cannot be read.
std::string read_bytes(const std::filesystem::path& file);

/// Non-blank lines without comments; `comment` starts one ('\0': none).
std::vector<TextLine> text_lines(std::string_view text, char comment = '\0');

/// The word as a finite number; throws a user error naming file and line.
double finite_number(const std::filesystem::path& file, int line, std::string_view word);

/// The word as a whole number; throws a user error naming file and line.
long whole_number(const std::filesystem::path& file, int line, std::string_view word);

/// Writes the text under a temporary name and renames it, so that no reader sees half a file.
void write_whole_file(const std::filesystem::path& file, std::string_view text);

}  // namespace wale
