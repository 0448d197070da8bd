#include "host/key_frames.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "geom/error.h"
#include "host/schema.h"
#include "host/suggest.h"

namespace wale {
namespace {

using Kind = JsonNode::Kind;

bool is_color(const JsonNode& node) {
  return node.kind == Kind::string && node.text.size() == 7 && node.text[0] == '#' &&
         std::all_of(node.text.begin() + 1, node.text.end(), [](unsigned char c) { return std::isxdigit(c); });
}

// A colour as light, so that what is half way between two is half of each.
void to_light(JsonNode& node) {
  if (!is_color(node)) return;
  for (size_t i = 0; i < 3; ++i) {
    JsonNode channel;
    channel.kind = Kind::number;
    channel.number = srgb_to_linear(std::stoi(node.text.substr(1 + 2 * i, 2), nullptr, 16) / 255.0);
    channel.place = node.place;
    node.items.push_back(channel);
  }
  node.kind = Kind::array;
  node.text.clear();
}

// Both are numbers, or lists that are alike in turn, or neither is either.
bool alike(const JsonNode& a, const JsonNode& b) {
  if (a.is_number() || b.is_number()) return a.is_number() && b.is_number();
  if (a.kind == Kind::array || b.kind == Kind::array)
    return a.kind == b.kind && a.items.size() == b.items.size() &&
           std::equal(a.items.begin(), a.items.end(), b.items.begin(), alike);
  return a.kind == b.kind;
}

KeyWay way_of(const JsonNode& node, const std::string& path) {
  const auto& ways = key_ways();
  const auto found = std::find(ways.begin(), ways.end(), node.text);
  if (node.kind != Kind::string || found == ways.end())
    fail_at(node.place, path,
            fmt::format("{} is no way from one key to the next; {}", node.describe(), nearest_choice(node.text, ways)));
  return KeyWay(found - ways.begin());
}

// A key that is no whole number is known to every number of the track, so that it can be refused at any frame.
void tell_fractions(const std::vector<JsonNode*>& values) {
  std::shared_ptr<const JsonNode> fraction;
  for (const JsonNode* value : values)
    if (!fraction && value->is_number() && value->number != std::floor(value->number))
      fraction = std::make_shared<const JsonNode>(*value);
  for (JsonNode* value : values) value->key_with_fraction = fraction;
  // Objects need not have the same members, nor their lists the same length.
  std::map<std::string, std::vector<JsonNode*>> parts;
  for (JsonNode* value : values) {
    for (size_t i = 0; i < value->items.size(); ++i) parts[std::to_string(i)].push_back(&value->items[i]);
    for (auto& member : value->members) parts[member.key].push_back(&member.value);
  }
  for (const auto& [name, same] : parts) tell_fractions(same);
}

// Slope of the cubic at a key: a weighted harmonic mean of the slopes beside it, 0 at an extremum and at both ends.
double slope(double h0, double d0, double h1, double d1) {
  if (!(d0 * d1 > 0)) return 0;
  const double w0 = 2 * h1 + h0, w1 = h1 + 2 * h0;
  return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

const std::vector<std::string>& key_ways() {
  static const std::vector<std::string> ways = {"linear", "smooth", "hold"};
  return ways;
}

KeyTrack::KeyTrack(const JsonNode& list, const std::string& path, KeyWay otherwise) {
  if (list.kind != Kind::array || list.items.empty())
    fail_at(list.place, path, "a list of keys is needed: [[frame, value], ...]");
  for (const JsonNode& item : list.items) {
    if (item.kind != Kind::array || item.items.size() < 2 || item.items.size() > 3 || !item.items[0].is_number())
      fail_at(item.place, path, "a key is [frame, value] or [frame, value, \"smooth\"], not " + item.describe());
    const double frame = item.items[0].number;
    if (!std::isfinite(frame) || (!keys_.empty() && frame <= keys_.back().frame))
      fail_at(item.items[0].place, path,
              fmt::format("frame {:g} does not come after frame {:g}; keys go forward in time", frame,
                          keys_.empty() ? 0.0 : keys_.back().frame));
    Key key{frame, item.items[1], item.items.size() == 3 ? way_of(item.items[2], path) : otherwise};
    to_light(key.value);
    if (!keys_.empty() && !alike(keys_.back().value, key.value))
      fail_at(key.value.place, path,
              fmt::format("{} at frame {:g} cannot follow {} at frame {:g}; the values of one key are alike",
                          key.value.describe(), frame, keys_.back().value.describe(), keys_.back().frame));
    keys_.push_back(std::move(key));
  }
  std::vector<JsonNode*> values;
  for (Key& key : keys_) values.push_back(&key.value);
  tell_fractions(values);
}

JsonNode KeyTrack::at(double frame) const {
  const auto next =
      std::upper_bound(keys_.begin(), keys_.end(), frame, [](double f, const Key& key) { return f < key.frame; });
  if (next == keys_.begin()) return keys_.front().value;
  const size_t i = size_t(next - keys_.begin()) - 1;
  const Key& key = keys_[i];
  if (next == keys_.end() || key.way == KeyWay::hold || frame == key.frame) return key.value;
  const double h = next->frame - key.frame, s = (frame - key.frame) / h;

  // One number of the value, found in every key's by the same steps down its lists.
  std::vector<size_t> steps;
  const auto number = [&](size_t k) {
    const JsonNode* node = &keys_[k].value;
    for (const size_t step : steps) node = &node->items[step];
    return node->number;
  };
  const auto between = [&] {
    const double a = number(i), b = number(i + 1);
    if (key.way == KeyWay::linear) return a + s * (b - a);
    const auto rise = [&](size_t k) { return (number(k + 1) - number(k)) / (keys_[k + 1].frame - keys_[k].frame); };
    const auto width = [&](size_t k) { return keys_[k + 1].frame - keys_[k].frame; };
    const double m0 = i == 0 ? 0 : slope(width(i - 1), rise(i - 1), h, rise(i));
    const double m1 = i + 2 == keys_.size() ? 0 : slope(h, rise(i), width(i + 1), rise(i + 1));
    const double t = s * s * (3 - 2 * s);
    return a + t * (b - a) + h * s * (1 - s) * ((1 - s) * m0 - s * m1);
  };
  JsonNode out = key.value;
  const std::function<void(JsonNode&)> fill = [&](JsonNode& node) {
    if (node.is_number()) {
      node.number = between();
      node.kind = Kind::number;
      node.between_keys = true;
    }
    for (size_t k = 0; k < node.items.size(); ++k) {
      steps.push_back(k);
      fill(node.items[k]);
      steps.pop_back();
    }
  };
  fill(out);
  return out;
}

}  // namespace wale
