#pragma once
// Oracles are slow: their loops run on all cores of the host.
#include <algorithm>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace wale::test {

/// body(i) for every i below `count`, interleaved over threads; results must go to places of their own.
template <typename Body>
void parallel_for(size_t count, const Body& body) {
  const size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::future<void>> parts;
  for (size_t part = 0; part < threads; ++part)
    parts.push_back(std::async(std::launch::async, [&, part] {
      for (size_t i = part; i < count; i += threads) body(i);
    }));
  for (auto& part : parts) part.get();
}

}  // namespace wale::test
