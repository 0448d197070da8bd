#pragma once
// Input that must be taken, or refused with one line.
#include <functional>

#include "host/world.h"
#include "tests/hard/trap.h"

namespace wale::test {

/// Builds everything of a scene that needs no device, reading real files.
World build_scene(const Scene& scene);

struct Question {
  std::string name;
  std::function<void()> ask;
  std::string refusal;  ///< what the one line of the refusal contains; empty: it must be taken
};

/// Error: the number of questions with another answer than wanted.
Finding look_at_answers(const std::vector<Question>& questions);

}  // namespace wale::test
