#include "host/animation.h"

#include <algorithm>
#include <array>

#include "geom/error.h"
#include "host/key_frames.h"
#include "host/scene_overrides.h"

namespace wale {
namespace {

constexpr double kFarthestFrame = 1e6;

// What is settled before frames are told apart.
constexpr std::array<std::string_view, 4> kNeverKeyed = {"animation", "units", "wale", "$schema"};

double number_or(const JsonNode& object, std::string_view key, double otherwise) {
  const JsonNode* node = object.find(key);
  return node && node->is_number() ? node->number : otherwise;
}

KeyWay way_between_keys(const JsonNode& animation) {
  const JsonNode* word = animation.find("interpolation");
  if (!word) return KeyWay::linear;
  const auto& ways = key_ways();
  const auto found = std::find(ways.begin(), ways.end(), word->text);
  return found == ways.end() ? KeyWay::linear : KeyWay(found - ways.begin());  // the check refuses another word
}

}  // namespace

Type animation_type() {
  return object({
      {"frame", number({-kFarthestFrame, kFarthestFrame}), "shown where no --frames are given", "0"},
      {"fps", number({0.001, 1000}), "frames per second of a video", "24"},
      {"shutter", number({0, 10}), "frames that the shutter stays open; 0 = no motion blur", "0"},
      {"shutter_steps", integer({2, 1024}), "moments that the samples of a blurred frame are shared out to", "8"},
      {"interpolation", word(key_ways()), "from one key to the next, where the key does not say", "linear"},
      {"keys", map(list(list(any(), 2), 1)),
       "by the path of a value, \"camera.position\": [[frame, value], [frame, value, \"smooth\"], ...]", "{}"},
  });
}

void apply_key_frames(JsonNode& document) {
  const JsonNode* animation = document.find("animation");
  if (!animation) return;
  const JsonNode* keys = animation->find("keys");
  if (!keys || keys->kind != JsonNode::Kind::object) return;
  const double frame = number_or(*animation, "frame", 0);
  const KeyWay way = way_between_keys(*animation);
  // The document changes while they are applied.
  const std::vector<JsonNode::Member> tracks = keys->members;
  for (const auto& [path, place, list] : tracks) {
    const std::string name = "animation.keys." + path;
    const std::string first = path.substr(0, path.find('.'));
    if (std::find(kNeverKeyed.begin(), kNeverKeyed.end(), first) != kNeverKeyed.end())
      fail_at(place, name,
              "cannot change from frame to frame; key values of the camera, materials, fabrics, lights ...");
    apply_override(document, path, KeyTrack(list, name, way).at(frame), place.text() + ": " + name);
  }
}

void forget_key_frames(JsonNode& document) {
  JsonNode* animation = document.find("animation");
  if (!animation || animation->kind != JsonNode::Kind::object) return;
  const bool open = number_or(*animation, "shutter", 0) > 0;
  std::erase_if(animation->members, [&](const auto& member) {
    if (member.key == "fps") return true;
    if (member.key == "frame") return member.value.number == 0;
    return !open && (member.key == "keys" || member.key == "interpolation" || member.key == "shutter" ||
                     member.key == "shutter_steps");
  });
}

}  // namespace wale
