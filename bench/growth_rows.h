#pragma once
// What the programs of one growth measurement found, one figure a row: bench/plot_growth.py plots them.
#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>
#include <string>

namespace wale::bench {

class GrowthRows {
 public:
  /// Rows are appended to the file at `path`; a new one gets its header. Without a path nothing is written. Throws
  /// std::runtime_error where the file cannot be opened.
  explicit GrowthRows(const char* path) : file_(path ? std::fopen(path, "a") : nullptr) {
    if (path && !file_) throw std::runtime_error(fmt::format("{}: cannot be written", path));
    if (!file_) return;
    std::fseek(file_, 0, SEEK_END);
    if (std::ftell(file_) == 0) fmt::print(file_, "segments,form,quantity,unit,value\n");
  }
  ~GrowthRows() {
    if (file_) std::fclose(file_);
  }
  GrowthRows(const GrowthRows&) = delete;
  GrowthRows& operator=(const GrowthRows&) = delete;

  /// `form`: stored, procedural, embree, or stored of lattice.
  void add(size_t segments, const std::string& form, const std::string& quantity, const char* unit, double value) {
    if (file_) fmt::print(file_, "{},{},\"{}\",{},{:.5g}\n", segments, form, quantity, unit, value);
  }

 private:
  std::FILE* file_;
};

}  // namespace wale::bench
