#include "host/serve/tried_edits.h"

#include <algorithm>

#include "geom/error.h"

namespace wale {
namespace {

constexpr size_t kMostChanges = 64;  // of more than these the oldest two count as one

}  // namespace

void TriedEdits::Made::make(EditorState& state) const {
  change.make(state);
  for (const EditorChange& one : also) one.make(state);
}

TriedEdits::TriedEdits(EditorState opened) : good_(opened), newest_(std::move(opened)) {}

void TriedEdits::change(EditorChange change) {
  change.make(newest_);
  ++revision_;
  refusal_.reset();
  nothing_ = false;
  if (!changes_.empty() && !change.stroke.empty() && change.stroke == changes_.back().change.stroke) {
    if (bad_ == changes_.size()) bad_ = 0;  // it is another change now
    changes_.back() = {std::move(change), {}, revision_};
    return;
  }
  changes_.push_back({std::move(change), {}, revision_});
  if (changes_.size() <= kMostChanges) return;
  Made second = std::move(changes_[1]);
  changes_.erase(changes_.begin() + 1);
  changes_[0].also.push_back(std::move(second.change));
  changes_[0].also.insert(changes_[0].also.end(), second.also.begin(), second.also.end());
  changes_[0].change.stroke.clear();
  changes_[0].revision = second.revision;
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
  Trial trial{good_, good_revision_};
  if (!good_still_) return trial;
  for (size_t i = 0; i < bad_ / 2; ++i) changes_[i].make(trial.state);
  trial.revision = changes_[bad_ / 2 - 1].revision;
  return trial;
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
  if (count == 0) return;  // the stroke has gone on
  if (bad_ == 0) good_still_ = false;
  if (bad_ == 0 || count < bad_) {
    bad_ = count;
    line_ = line;
  }
  if (bad_ == 1 && good_still_) take_back();
}

// The first change, as good_ can be shown and good_ with it cannot.
void TriedEdits::take_back() {
  refusal_ = RefusedEdit{changes_[0].change.control, line_};
  const std::vector<Made> rest(std::make_move_iterator(changes_.begin() + 1), std::make_move_iterator(changes_.end()));
  changes_.clear();
  newest_ = good_;
  for (const Made& made : rest) {
    EditorState with = newest_;
    try {
      made.make(with);
    } catch (const Error& error) {  // it needs what was taken back
      if (error.fault() != Fault::user) throw;
      continue;
    }
    newest_ = std::move(with);
    changes_.push_back(made);
  }
  ++revision_;
  if (changes_.empty()) good_revision_ = revision_;
  bad_ = 0;
}

}  // namespace wale
