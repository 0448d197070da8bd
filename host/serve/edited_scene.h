#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/file_fence.h"
#include "host/json_document.h"
#include "host/scene.h"

namespace wale {

/// A scene file and the edits made to it, each a list of overrides as `--set` takes them. Every version is checked by
/// the scene's schema before it is taken; files outside of the scene's folder, but for those it named when it was
/// opened, are refused. Copies are cheap; one is for one thread at a time.
class EditedScene {
 public:
  /// Throws the user errors of read_scene(). `overrides`: of the command line, below all edits.
  EditedScene(const std::filesystem::path& file, std::vector<std::string> overrides);

  const Scene& scene() const { return scene_; }    ///< of the newest version
  const Scene& opened() const { return opened_; }  ///< as it was opened
  /// The document with its overrides, as it was written: nothing filled in, lengths in the file's units.
  const JsonNode& document() const { return document_; }
  double metres_per_unit() const { return metres_per_unit_; }
  /// What was edited, one override a path, in the order in which they must be applied.
  const std::vector<std::string>& edits() const { return edits_; }

  /// Throws a user error of one line, and changes nothing, when the scene would not be valid. Edits that follow each
  /// other with the same `gesture`, unless it is empty, are one step of undo.
  void edit(const std::vector<std::string>& set, const std::string& gesture);
  bool undo();
  bool redo();
  /// The step that undo() or redo() would take, by the number that was given before it was first made; 0: none.
  uint64_t undo_step() const { return past_.empty() ? 0 : past_.back().number; }
  uint64_t redo_step() const { return future_.empty() ? 0 : future_.back().number; }
  /// The next new step gets this number.
  void number_next_step(uint64_t number) { next_step_ = number; }
  /// Takes all edits back, as one step of undo.
  bool reset();
  bool can_undo() const { return !past_.empty(); }
  bool can_redo() const { return !future_.empty(); }

  /// The scene with more overrides, which are not kept.
  Scene scene_with(const std::vector<std::string>& more) const;
  JsonNode document_with(const std::vector<std::string>& more) const;

  /// The command line that renders it, with more overrides.
  std::string command(const std::vector<std::string>& more, const std::string& goal) const;

  /// Writes the scene into the folder of its file, whole or not at all, and returns where. Throws a user error for a
  /// name that is not a plain one that ends in ".json". Returns an empty path, and writes nothing, where a file of that
  /// name exists and `replace` is false.
  std::filesystem::path save(const std::string& name, bool replace) const;

 private:
  using Edits = std::vector<std::string>;
  struct Step {
    std::shared_ptr<const Edits> edits;  ///< on its other side
    uint64_t number = 0;
  };
  void take(Edits edits);

  std::filesystem::path file_;
  Edits overrides_, groundwork_, edits_;
  JsonNode original_, document_;
  FileFence fence_;
  Scene opened_, scene_;
  double metres_per_unit_ = 1;
  std::vector<Step> past_, future_;
  uint64_t next_step_ = 0;
  std::string gesture_;
};

}  // namespace wale
