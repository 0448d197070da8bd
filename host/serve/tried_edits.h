#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/serve/controls.h"
#include "host/serve/edited_scene.h"

namespace wale {

/// What the editor shows: the scene, and how.
struct EditorState {
  EditedScene scene;
  EditorSettings settings;
};

/// One step from a state to the next. It can be made again on a state that lacks some of the steps before it.
struct EditorChange {
  /// Throws a user error, and changes nothing, where it cannot be made; false: there was nothing to change.
  std::function<bool(EditorState&)> make;
  std::string control{};  ///< of the page, that asked for it
  /// A change that follows one of the same stroke stands for both; empty: it is none. Strokes set the same keys.
  std::string stroke{};
};

/// The step of undo or redo that is next in this state, and no other: without the edit that it is about it is nothing.
EditorChange undo_of(const EditorState& now);
EditorChange redo_of(const EditorState& now);

/// An edit that passed the schema and could not be shown; `control` is empty where no edit is to blame.
struct RefusedEdit {
  std::string control, line;
};

/// The changes since the version that could be shown last, and the search among them for the one that cannot be: where
/// the newest version fails, the last good one is tried again, then versions between by halving, until two neighbours
/// are known of which the first can be shown. The change between them is taken back; those before and after it stay,
/// and so does the history, but for what needs that change: an undo or redo of it goes without a word, others are told.
/// Where not even the last good version can be shown any more, as a file has gone, no change is to blame: all stay, and
/// are tried again with the next one. For one thread at a time.
class TriedEdits {
 public:
  explicit TriedEdits(EditorState opened);

  const EditorState& newest() const { return newest_; }
  /// Of the newest version; one that was taken back has had another.
  uint64_t revision() const { return revision_; }
  /// Throws what the change does, and is then as before, as it is where there was nothing to change.
  void change(EditorChange change);
  /// The last that could not be shown, until the next change.
  const std::optional<RefusedEdit>& refusal() const { return refusal_; }

  /// A version to be shown.
  struct Trial {
    EditorState state;
    uint64_t revision = 0;
  };
  /// Nothing can be shown, not even what could be last.
  bool stopped() const { return nothing_; }
  /// False: the newest was tried, and there is nothing to be searched for.
  bool pending() const { return tried_ != revision_ || bad_ > 0; }
  /// The newest version, unless it was tried already: then the next of the search.
  Trial next();
  /// It is shown.
  void shown(const Trial& trial);
  /// It cannot be, for that reason.
  void refused(const Trial& trial, const std::string& line);

 private:
  struct Made {
    EditorChange change;
    uint64_t revision = 0;
    uint64_t step = 0;  ///< of undo, that it is part of
    EditorState after;  ///< with all before it
  };
  size_t changes_until(uint64_t revision) const;
  void take_back();

  EditorState good_, newest_;  ///< shown last; with all changes
  uint64_t good_revision_ = 1, revision_ = 1;
  std::vector<Made> changes_;  ///< from good_ to newest_
  uint64_t tried_ = 0;         ///< revision of the newest version that was tried
  size_t bad_ = 0;             ///< so many changes cannot be shown; 0: none are known
  bool good_still_ = false;    ///< good_ was shown again since
  std::string line_;           ///< why they cannot be
  bool nothing_ = false;       ///< good_ cannot be shown
  std::optional<RefusedEdit> refusal_;
};

}  // namespace wale
