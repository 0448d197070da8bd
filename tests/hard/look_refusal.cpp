#include "tests/hard/look_refusal.h"

#include <fmt/format.h>

#include "geom/error.h"
#include "host/image.h"

namespace wale::test {

World build_scene(const Scene& scene) {
  return build_world(scene, Loaders{[](const auto& file) { return read_mesh(file); },
                                    [](const auto& file) { return read_image(file, true); }});
}

Finding look_at_answers(const std::vector<Question>& questions) {
  Finding found;
  found.error_float = 0;
  for (const Question& q : questions) {
    ++found.trials;
    std::string answer;
    Fault fault = Fault::user;
    try {
      q.ask();
    } catch (const Error& error) {
      answer = error.what();
      fault = error.fault();
    }
    const bool good = q.refusal.empty() ? answer.empty()
                                        : fault == Fault::user && answer.find(q.refusal) != std::string::npos &&
                                              answer.find('\n') == std::string::npos;
    if (good) continue;
    ++found.error_float;
    found.broken += fmt::format(" {}: \"{}\"", q.name, answer);
  }
  return found;
}

}  // namespace wale::test
