// The steps of one store that keeps its former states.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <utility>

#include "vpe/explore/drawing/undo_history.h"

namespace vpe::explore {

// Keeps former states of type State, each with the name of the edit that ended it. The oldest go when all
// together are larger than a limit; the last one always stays. For one thread at a time.
//
// Typical usage:
//   steps.keep(std::exchange(state_, next), bytes, "move vertex 3");
//   steps.undo(state_);
template <class State>
class UndoSteps {
 public:
  explicit UndoSteps(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // Records that the state `before`, which takes this many bytes, was edited.
  void keep(State before, std::size_t bytes, std::string what) {
    redo_.clear();
    undo_.push_back({std::move(before), bytes, std::move(what)});
    ++made_;
    std::size_t all = 0;
    for (const Step& step : undo_) all += step.bytes;
    for (; all > most_bytes_ && undo_.size() > 1; undo_.pop_front(), ++dropped_) all -= undo_.front().bytes;
  }

  // Exchange the present state for the one before or after it. Return false if there is none.
  bool undo(State& now) { return step(undo_, redo_, now); }
  bool redo(State& now) { return step(redo_, undo_, now); }
  void forget_redo() { redo_.clear(); }
  // Drops all steps, as when another file is opened.
  void clear() {
    undo_.clear();
    redo_.clear();
    ++generation_;
    made_ = dropped_ = 0;
  }

  std::string undo_text() const { return undo_.empty() ? "" : undo_.back().what; }
  std::string redo_text() const { return redo_.empty() ? "" : redo_.back().what; }
  UndoState state() const { return {generation_, made_, dropped_, undo_.size(), redo_.size()}; }

 private:
  struct Step {
    State state;
    std::size_t bytes = 0;
    std::string what;
  };
  static bool step(std::deque<Step>& from, std::deque<Step>& to, State& now) {
    if (from.empty()) return false;
    Step taken = std::move(from.back());
    from.pop_back();
    std::swap(taken.state, now);
    to.push_back(std::move(taken));
    return true;
  }

  std::size_t most_bytes_;
  std::uint64_t generation_ = 0;
  std::uint64_t made_ = 0;
  std::uint64_t dropped_ = 0;
  std::deque<Step> undo_;
  std::deque<Step> redo_;
};

}  // namespace vpe::explore
