#include <fmt/format.h>

#include <array>
#include <bit>
#include <limits>

#include "geom/base_mesh.h"
#include "geom/error.h"
#include "geom/pattern.h"
#include "tests/hard/wild_numbers.h"
#include "tests/temporary_folder.h"

namespace wale::test {
namespace {

/// A file of one format whose text holds @ where one number stands, and what the complaint must name besides the file.
struct Format {
  std::string name, file, text, place;
  bool pattern = false;
};

/// A number as text or, in binary files, as the four bytes of a float.
using Write = std::string (*)(double);
std::string as_bytes(double x) {
  const auto bits = std::bit_cast<std::array<char, 4>>(float(x));
  return {bits.begin(), bits.end()};
}

const std::string kPlyHead =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

std::vector<Format> text_formats() {
  const std::string pyp =
      "*pattern\n0.004 0.003 0.0002 4\n*Q\n-0.001 0.0005 0 0\n0 0.0014 0.0001 0\n0.0005 0.0004 @ 0\n0.0015 0.0005 0 0\n"
      "*E\n0 1 0 0\n1 2 0 0\n2 3 0 0\n3 0 1 0\n";
  const std::string json =
      "{\"wale_tile\": 1, \"period\": [0.004, 0.004], \"yarn_radius\": 0.0003, \"curves\": [{\"points\":\n"
      "[[0, 0.001, 0], [0.002, @, 0], [0.004, 0.001, 0]]}]}";
  return {
      {"OBJ vertex", "a.obj", "v 0 0 0\nv 1 @ 0\nv 0 1 0\nf 1 2 3\n", "vertex 2"},
      {"OBJ texture coordinate", "b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 @\nf 1/1 2/2 3/3\n",
       "texture coordinate 3"},
      {"PLY text", "a.ply", "ply\nformat ascii 1.0\n" + kPlyHead + "0 0 0 0 0\n1 @ 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
       ":13:"},
      {"OFF", "a.off", "OFF\n3 1 0\n0 0 0\n1 @ 0\n0 1 0\n3 0 1 2\n", ":4:"},
      {"pyp", "a.pyp", pyp, ":6:", true},
      {"Leaf", "a_0.3.txt", "Num Yarns: 1\n5\n0 0 0\n1 0.2 0\n2 @ 0.1\n3 0.1 0\n4 0 0\n", ":5:", true},
      {"JSON tile", "a.json", json, "", true},
  };
}

/// Vertices as bytes: 0.5 stands where the number goes.
std::vector<Format> binary_formats() {
  std::string ply = "ply\nformat binary_little_endian 1.0\n" + kPlyHead;
  const float corners[3][5] = {{0, 0, 0, 0, 0}, {1, 0, 0, 1, 0}, {0, 1, 0, 0, 1}};
  for (int v = 0; v < 3; ++v)
    for (int k = 0; k < 5; ++k) ply += v == 1 && k == 1 ? std::string("@") : as_bytes(corners[v][k]);
  ply += '\3';
  for (const int32_t i : {0, 1, 2}) {
    const auto bits = std::bit_cast<std::array<char, 4>>(i);
    ply.append(bits.begin(), bits.end());
  }
  const auto whole = [](auto value) {
    const auto bits = std::bit_cast<std::array<char, sizeof(value)>>(value);
    return std::string(bits.begin(), bits.end());
  };
  std::string bcc = std::string("BCC\x44") + "C0" + '\x03' + '\x02' + whole(uint64_t(1)) + whole(uint64_t(3));
  bcc.resize(64, '\0');
  bcc += whole(int32_t(3)) + as_bytes(0) + as_bytes(0) + as_bytes(0) + as_bytes(0.5) + "@" + as_bytes(0) + as_bytes(1) +
         as_bytes(0) + as_bytes(0);
  return {{"PLY binary", "b.ply", ply, "vertex 2"}, {"BCC", "a.bcc", bcc, "point 1", true}};
}

void load(const std::filesystem::path& file, bool pattern) {
  if (!pattern) {
    (void)read_mesh(file);
    return;
  }
  PatternHints hints;
  if (file.extension() == ".bcc" || file.extension() == ".txt") hints.period = {0.01, 0.01};
  if (file.extension() == ".bcc") hints.yarn_radius = 0.0005;
  if (file.extension() == ".txt") hints.period = {0.004, 0.004};
  (void)read_pattern(file, hints);
}

/// What is wrong with how a file was met; empty when it was refused as promised (or, for a sound one, read).
std::string complaint(const TemporaryFolder& folder, const Format& format, const std::string& number, bool sound) {
  std::string text = format.text;
  text.replace(text.find('@'), 1, number);
  const auto file = folder.write(format.file, text);
  try {
    load(file, format.pattern);
    return sound ? "" : "was read";
  } catch (const Error& error) {
    const std::string what = error.what();
    if (sound || error.fault() != Fault::user) return "says " + what;
    const bool named = what.find(file.string()) != std::string::npos && what.find(format.place) != std::string::npos;
    return named && what.find('\n') == std::string::npos ? "" : "says only: " + what;
  }
}

}  // namespace

Finding look_at_files_that_are_not_finite() {
  Finding f;
  f.error_float = 0;
  const TemporaryFolder folder;
  const auto check = [&](const Format& format, const std::string& number, const std::string& shown, bool sound) {
    const std::string what = complaint(folder, format, number, sound);
    ++f.trials;
    if (what.empty()) return;
    ++f.error_float;
    if (f.broken.empty()) f.broken = fmt::format("{} with {} {}", format.name, shown, what);
  };
  for (const Format& format : text_formats()) {
    check(format, "0.5", "0.5", true);
    for (const std::string bad : {"nan", "NaN", "-nan", "inf", "-inf", "Infinity", "1e999", "-1e999"})
      check(format, bad, bad, false);
  }
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const Format& format : binary_formats()) {
    check(format, as_bytes(0.5), "0.5", true);
    for (const double bad : {nan, -nan, inf, -inf}) check(format, as_bytes(bad), fmt::format("{}", bad), false);
  }
  return f;
}

}  // namespace wale::test
