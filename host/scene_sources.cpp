#include "host/scene_sources.h"

#include <cmath>

#include "host/scene_nodes.h"

namespace wale {
namespace {

long whole_of(const JsonNode& node, std::string_view key) { return std::lround(number_of(node, key)); }

// What the schema cannot say of files of frames: that they are there, and which.
SequenceSource sequence_of(const JsonNode& node, const SceneMoment& moment) {
  SequenceSource out;
  if (node.has("cache")) {
    out.base = node["file"].text;
    out.cache = node["cache"].text;
  } else {
    out.frames = std::filesystem::absolute(moment.folder / node["frames"].text).lexically_normal();
    if (moment.fence && !moment.fence->admits_all(out.frames))
      fail(node["frames"], "frames", "{}", moment.fence->refusal(node["frames"].text));
  }
  out.first = whole_of(node, "first");
  out.step = whole_of(node, "step");
  if (out.step == 0) fail(node["step"], "step", "0 shows one file only; name it as \"file\", or give 1 or more");
  if (node.has("last")) out.last = whole_of(node, "last");
  out.rest = whole_of(node, "rest");
  out.hold = node["missing"].text == "hold";
  out.changing = node["topology"].text == "changing";
  return out;
}

}  // namespace

Transform transform_of(const JsonNode& node) {
  return {number_of(node, "scale"), vector_of(node["rotate"]), vector_of(node["translate"])};
}

MeshSource mesh_of(const JsonNode& node, const SceneMoment& moment) {
  MeshSource mesh;
  if (node.kind == JsonNode::Kind::string) {
    mesh.file = node.text;
  } else if (node.has("frames") || node.has("cache")) {
    mesh.sequence = sequence_of(node, moment);
    mesh.frame = moment.frame;
  } else if (node.has("file")) {
    mesh.file = node["file"].text;
  } else {
    mesh.generator = node["generator"].text;
    const std::pair<const char*, double*> sizes[] = {{"width", &mesh.width},
                                                     {"height", &mesh.height},
                                                     {"radius", &mesh.radius},
                                                     {"thickness", &mesh.thickness},
                                                     {"length", &mesh.length},
                                                     {"size", &mesh.size},
                                                     {"sphere_radius", &mesh.sphere_radius}};
    for (const auto& [key, value] : sizes)
      if (node.has(key)) *value = number_of(node, key);
    mesh.nu = integer_of(node, "nu");
    mesh.nv = node.has("nv") ? integer_of(node, "nv") : mesh.nu;
  }
  return mesh;
}

PatternSource pattern_of(const JsonNode& node) {
  PatternSource pattern;
  if (node.kind == JsonNode::Kind::string) {
    pattern.file = node.text;
  } else if (node.has("builtin")) {
    pattern.builtin = node["builtin"].text;
  } else {
    pattern.file = node["file"].text;
    if (node.has("period")) pattern.hints.period = pair_of(node["period"]);
    if (node.has("yarn_radius")) pattern.hints.yarn_radius = number_of(node, "yarn_radius");
    if (node.has("stitches")) pattern.hints.stitches = ivec2(pair_of(node["stitches"]));
    if (node.has("unit")) pattern.hints.unit = number_of(node, "unit");
  }
  return pattern;
}

}  // namespace wale
