// The libFuzzer program: WALE_FUZZ_TARGET in the environment names the reader, the rest are libFuzzer's own options.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <random>

#include "tests/fuzz/targets.h"

namespace {

const wale::fuzz::Target* target = nullptr;

}  // namespace

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const char* name = std::getenv("WALE_FUZZ_TARGET");
  target = name ? wale::fuzz::find_target(name) : nullptr;
  if (target) return 0;
  std::fprintf(stderr, "WALE_FUZZ_TARGET must name a reader:");
  for (const auto& known : wale::fuzz::targets()) std::fprintf(stderr, " %s", known.name);
  std::fprintf(stderr, "\n");
  std::exit(1);
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  target->run({reinterpret_cast<const char*>(data), size});
  return 0;
}

/// One time in eight a word of the format is put in; else libFuzzer's own mutations.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  std::minstd_rand random(seed);
  if (target->words.empty() || random() % 8) return LLVMFuzzerMutate(data, size, max_size);
  const std::string_view word = target->words[random() % target->words.size()];
  if (size + word.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  const size_t at = random() % (size + 1);
  std::memmove(data + at + word.size(), data + at, size - at);
  std::memcpy(data + at, word.data(), word.size());
  return size + word.size();
}
