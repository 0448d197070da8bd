#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace wale::fuzz {

/// One reader under arbitrary bytes. `run` returns true when the reader took them and false when it refused them with a
/// user error of one line; it throws Broken (expect.h) on anything else: another exception, a message of several lines,
/// or a result that is not consistent.
struct Target {
  const char* name;                     ///< also its folder of seeds below tests/fuzz/corpus
  const char* reader;                   ///< what it tries
  const char* source;                   ///< the reader's own files, with blanks between, for coverage.sh
  bool own;                             ///< no library reads these bytes
  std::vector<std::string_view> words;  ///< pieces of the format, which blind mutation would not hit upon
  bool (*run)(std::string_view bytes);
};

/// Every target, in the order in which they are listed.
const std::vector<Target>& targets();
const Target* find_target(std::string_view name);

bool pyp(std::string_view bytes);
bool leaf(std::string_view bytes);
bool bcc(std::string_view bytes);
bool tile_json(std::string_view bytes);
bool chart(std::string_view bytes);
bool chart_json(std::string_view bytes);
bool knitout(std::string_view bytes);
bool obj(std::string_view bytes);
bool ply(std::string_view bytes);
bool off(std::string_view bytes);
bool frames(std::string_view bytes);
bool pc2(std::string_view bytes);
bool mesh_text(std::string_view bytes);
bool scene(std::string_view bytes);
bool material(std::string_view bytes);
bool overrides(std::string_view bytes);
bool image(std::string_view bytes);
bool request(std::string_view bytes);
bool npy(std::string_view bytes);
bool npz(std::string_view bytes);
bool onnx(std::string_view bytes);

}  // namespace wale::fuzz
