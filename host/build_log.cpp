#include "host/build_log.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <vector>

#include "geom/error.h"
#include "host/atomic_file.h"

namespace wale {

std::string keep_build_log(const std::string& title, const std::string& log) {
  namespace fs = std::filesystem;
  std::vector<fs::path> folders;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache)
    folders.emplace_back(cache);
  else if (const char* home = std::getenv("HOME"); home && *home)
    folders.push_back(fs::path(home) / ".cache");
  std::error_code error;
  folders.push_back(fs::temp_directory_path(error));
  std::string name = title;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  for (const fs::path& folder : folders) {
    const fs::path file = folder / "wale" / (name + ".log");
    try {
      fs::create_directories(file.parent_path(), error);
      write_text_file(file, log);
      return file.string();
    } catch (const Error&) {
      continue;
    }
  }
  return "";
}

std::string first_error(const std::string& log) {
  std::istringstream in(log);
  std::string first;
  int lines = 0;
  for (std::string line; std::getline(in, line);) {
    if (line.find("error:") != std::string::npos) return line;
    if (line.find_first_not_of(" \t\r") != std::string::npos && lines++ < 2) first += line + ' ';
  }
  return first.substr(0, first.find_last_not_of(' ') + 1);
}

}  // namespace wale
