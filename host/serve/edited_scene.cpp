#include "host/serve/edited_scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "geom/error.h"
#include "host/atomic_file.h"
#include "host/json_text.h"
#include "host/scene_overrides.h"

namespace wale {
namespace fs = std::filesystem;
namespace {

constexpr size_t kMostSteps = 200;  // of undo
constexpr size_t kMostEdits = 1000;

std::string path_of(const std::string& override_text) { return override_text.substr(0, override_text.find('=')); }

// An override makes earlier ones of the same path, or below it, say nothing.
void add(std::vector<std::string>& edits, const std::string& one) {
  const std::string path = path_of(one);
  std::erase_if(edits, [&](const std::string& before) {
    return path_of(before) == path || path_of(before).starts_with(path + ".");
  });
  edits.push_back(one);
}

// What the scene leaves to defaults and the editor wants to change: written out, it shows the same.
std::vector<std::string> groundwork(const JsonNode& document) {
  std::vector<std::string> out;
  const JsonNode *fabrics = document.find("fabrics"), *materials = document.find("materials");
  std::string wool = "wool";
  while (materials && materials->has(wool)) wool += "_";
  bool made = false;
  for (size_t i = 0; fabrics && i < fabrics->items.size(); ++i) {
    if (fabrics->items[i].has("material")) continue;
    if (!std::exchange(made, true)) out.push_back("materials." + wool + "={\"type\":\"ply\",\"preset\":\"wool\"}");
    out.push_back(fmt::format("fabrics.{}.material={}", i, wool));
  }
  const JsonNode* lights = document.find("lights");
  if (!lights || lights->items.empty()) out.push_back("lights=[{\"type\":\"environment\",\"radiance\":1}]");
  return out;
}

std::string shell_quoted(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./=:,-+";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

bool plain_name(const std::string& name) {
  return name.size() > 5 && name.size() <= 100 && name.ends_with(".json") && name[0] != '.' && name[0] != '-' &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '_' ||
                  c == '-';
         });
}

}  // namespace

EditedScene::EditedScene(const fs::path& file, std::vector<std::string> overrides)
    : file_(file),
      overrides_(std::move(overrides)),
      original_(read_json(file)),
      fence_(fs::absolute(file).parent_path()) {
  JsonNode document = document_with({});
  opened_ = fenced_scene(document, file_, fence_);  // its errors come before those of what is added
  groundwork_ = groundwork(document);
  const JsonNode* units = document.find("units");
  metres_per_unit_ = units && units->text == "mm" ? 1e-3 : 1;
  document_ = document_with({});
  opened_ = scene_ = fenced_scene(document_, file_, fence_);
  fence_.close();
}

JsonNode EditedScene::document_with(const std::vector<std::string>& more) const {
  JsonNode document = original_;
  for (const Edits* list : {&overrides_, &groundwork_, &edits_, &more}) apply_overrides(document, *list);
  return document;
}

Scene EditedScene::scene_with(const std::vector<std::string>& more) const {
  FileFence fence = fence_;
  return fenced_scene(document_with(more), file_, fence);
}

void EditedScene::take(Edits edits) {
  Edits before = std::exchange(edits_, std::move(edits));
  try {
    JsonNode document = document_with({});
    scene_ = fenced_scene(document, file_, fence_);
    document_ = std::move(document);
  } catch (...) {
    edits_ = std::move(before);
    throw;
  }
}

void EditedScene::edit(const std::vector<std::string>& set, const std::string& gesture) {
  Edits next = edits_;
  for (const std::string& one : set) {
    if (const std::string path = path_of(one); path == "units" || path == "wale" || path == "$schema")
      user_error("--set {}: \"{}\" is not edited", one_line(one.substr(0, 60)), path);
    add(next, one);
  }
  if (next.size() > kMostEdits)
    user_error("more than {} values are edited; save the scene and open it anew", kMostEdits);
  auto before = std::make_shared<const Edits>(edits_);
  take(std::move(next));
  if (gesture.empty() || gesture != gesture_) past_.push_back({std::move(before), next_step_});
  if (past_.size() > kMostSteps) past_.erase(past_.begin());
  gesture_ = gesture;
  future_.clear();
}

bool EditedScene::undo() {
  if (past_.empty()) return false;
  auto now = std::make_shared<const Edits>(edits_);
  take(*past_.back().edits);
  future_.push_back({std::move(now), past_.back().number});
  past_.pop_back();
  gesture_.clear();
  return true;
}

bool EditedScene::redo() {
  if (future_.empty()) return false;
  auto now = std::make_shared<const Edits>(edits_);
  take(*future_.back().edits);
  past_.push_back({std::move(now), future_.back().number});
  future_.pop_back();
  gesture_.clear();
  return true;
}

bool EditedScene::reset() {
  if (edits_.empty()) return false;
  auto now = std::make_shared<const Edits>(edits_);
  take({});
  past_.push_back({std::move(now), next_step_});
  future_.clear();
  gesture_.clear();
  return true;
}

std::string EditedScene::command(const std::vector<std::string>& more, const std::string& goal) const {
  std::string out = "wale render " + shell_quoted(file_.string()) + " -o picture.png";
  const auto add_all = [&](const Edits& list) {
    for (const std::string& one : list) out += " --set " + shell_quoted(one);
  };
  add_all(overrides_);
  if (!edits_.empty() || !more.empty()) add_all(groundwork_);
  add_all(edits_);
  add_all(more);
  return out + goal;
}

fs::path EditedScene::save(const std::string& name, bool replace) const {
  if (!plain_name(name))
    user_error("file: \"{}\" is no plain name; letters, digits, \"-\", \"_\" and \".\", and \".json\" at the end",
               one_line(name.substr(0, 60)));
  const fs::path target = fs::absolute(file_).parent_path() / name;
  if (!replace && fs::exists(fs::symlink_status(target))) return {};
  const std::string text = json_text(document_);
  parse_scene(text, target);  // what is saved can be opened
  if (replace) {
    write_text_file(target, text);
    return target;
  }
  return write_new_text_file(target, text) ? target : fs::path();
}

}  // namespace wale
