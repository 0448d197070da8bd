#include "host/serve/tried_edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "geom/error.h"

namespace wale {
namespace {

constexpr size_t kMostChanges = 64;  // of more than these the oldest two count as one

}  // namespace

EditorChange undo_of(const EditorState& now) {
  return {[step = now.scene.undo_step()](EditorState& state) {
    return state.scene.undo_step() == step && state.scene.undo();
  }};
}

EditorChange redo_of(const EditorState& now) {
  return {[step = now.scene.redo_step()](EditorState& state) {
    return state.scene.redo_step() == step && state.scene.redo();
  }};
}

TriedEdits::TriedEdits(EditorState opened) : good_(opened), newest_(std::move(opened)) {}

void TriedEdits::change(EditorChange change) {
  newest_.scene.number_next_step(revision_ + 1);
  if (!change.make(newest_)) return;
  ++revision_;
  refusal_.reset();
  nothing_ = false;
  if (!changes_.empty() && !change.stroke.empty() && change.stroke == changes_.back().change.stroke) {
    if (bad_ == changes_.size()) bad_ = 0;  // it is another change now
    changes_.back() = {std::move(change), revision_, newest_.scene.undo_step(), newest_};
    return;
  }
  changes_.push_back({std::move(change), revision_, newest_.scene.undo_step(), newest_});
  if (changes_.size() <= kMostChanges) return;
  changes_.erase(changes_.begin());  // what is first is never made again: where it led is enough
  changes_[0].change.stroke.clear();
  changes_[0].change.control.clear();
  if (bad_ > 0) --bad_;
}

size_t TriedEdits::changes_until(uint64_t revision) const {
  const auto later = [&](const Made& made) { return made.revision > revision; };
  return size_t(std::find_if(changes_.begin(), changes_.end(), later) - changes_.begin());
}

TriedEdits::Trial TriedEdits::next() {
  if (tried_ != revision_) {
    tried_ = revision_;
    return {newest_, revision_};
  }
  if (!good_still_) return {good_, good_revision_};
  const Made& middle = changes_[bad_ / 2 - 1];
  return {middle.after, middle.revision};
}

void TriedEdits::shown(const Trial& trial) {
  const size_t count = changes_until(trial.revision);
  good_ = trial.state;
  good_revision_ = trial.revision;
  good_still_ = true;
  changes_.erase(changes_.begin(), changes_.begin() + std::ptrdiff_t(count));
  bad_ -= std::min(bad_, count);
  if (std::exchange(nothing_, false)) refusal_.reset();
  if (bad_ == 1) take_back();
}

void TriedEdits::refused(const Trial& trial, const std::string& line) {
  if (trial.revision == good_revision_) {
    nothing_ = true;
    bad_ = 0;
    refusal_ = RefusedEdit{"", line};
    return;
  }
  const size_t count = changes_until(trial.revision);
  // A stroke that has gone on, or one of the oldest: none of these changes led there, so none is to blame. The newest
  // is another one by now, and is tried.
  if (count == 0 || changes_[count - 1].revision != trial.revision) return;
  if (bad_ == 0) good_still_ = false;
  if (bad_ == 0 || count < bad_) {
    bad_ = count;
    line_ = line;
  }
  if (bad_ == 1 && good_still_) take_back();
}

// The first change, as good_ can be shown and good_ with it cannot.
void TriedEdits::take_back() {
  bad_ = 0;
  try {
    good_.scene.scene_with({});
  } catch (const Error& error) {  // its files have gone since: then no change could be made again
    if (error.fault() != Fault::user) throw;
    nothing_ = true;
    refusal_ = RefusedEdit{"", error.what()};
    return;
  }
  refusal_ = RefusedEdit{changes_[0].change.control, line_};
  const std::vector<Made> rest(std::make_move_iterator(changes_.begin() + 1), std::make_move_iterator(changes_.end()));
  changes_.clear();
  newest_ = good_;
  size_t gone = 0;
  std::string why;
  for (const Made& made : rest) {
    newest_.scene.number_next_step(made.step);
    try {
      if (made.change.make(newest_)) changes_.push_back({made.change, made.revision, made.step, newest_});
    } catch (const Error& error) {  // it needs what was taken back
      if (error.fault() != Fault::user) throw;
      if (gone++ == 0) why = error.what();
    }
  }
  if (gone > 0)
    refusal_->line +=
        fmt::format("; {} after it went with it: {}", gone == 1 ? "one edit" : fmt::format("{} edits", gone), why);
  ++revision_;
  (changes_.empty() ? good_revision_ : changes_.back().revision) = revision_;
}

}  // namespace wale
