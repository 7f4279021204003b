// The state of one piece of work that is edited, saved and undone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "vpe/explore/drawing/undo_history.h"
#include "vpe/explore/drawing/undo_steps.h"

namespace vpe::explore {

// Holds the present state, its former ones, and which one is saved. For one thread at a time.
//
// Typical usage:
//   class Editor : public EditedState<Items> { ... };
//   void Editor::remove(...) { edit(next, bytes, "delete 'Rim'"); }
template <class State>
class EditedState : public UndoStore {
 public:
  // Returns a number that changes whenever the state does.
  std::uint64_t revision() const { return revision_; }
  // Returns true if the state differs from the one that was loaded or last marked as saved.
  bool is_changed() const { return now_.number != saved_; }
  void mark_saved() { mark(now_.number); }
  void mark_unsaved() { mark(0); }
  // Returns a number that changes whenever the state is loaded or marked.
  std::uint64_t saves() const { return saves_; }

  UndoState undo_state() const override { return steps_.state(); }
  std::string undo_text() const override { return steps_.undo_text(); }
  std::string redo_text() const override { return steps_.redo_text(); }
  bool undo() override { return go(steps_.undo(now_)); }
  bool redo() override { return go(steps_.redo(now_)); }
  void forget_redo() override { steps_.forget_redo(); }

 protected:
  // Keeps at most about most_bytes of former states.
  explicit EditedState(std::size_t most_bytes) : steps_(most_bytes) { load_state({}); }

  const State& state() const { return now_.state; }
  // Replaces the state, which counts as saved. Ends all steps of undo.
  void load_state(State state) {
    now_ = {std::move(state), ++last_number_};
    steps_.clear();
    ++revision_;
    mark(now_.number);
  }
  // Makes the next state by an edit of that name. The former one takes up these bytes. With `continues` both are one step of undo
  // if the last edit had the same key.
  void edit(State next, std::size_t bytes, std::string what, const std::string& key = {},
            bool continues = false) {
    Numbered before = std::exchange(now_, {std::move(next), ++last_number_});
    if (!continues || key.empty() || going_on_ != key) steps_.keep(std::move(before), bytes, std::move(what));
    going_on_ = key;
    ++revision_;
  }

 private:
  struct Numbered {
    State state = {};
    std::uint64_t number = 0;  // tells states apart
  };
  void mark(std::uint64_t saved) {
    saved_ = saved;
    going_on_.clear();
    ++saves_;
  }
  bool go(bool has_gone) {
    going_on_.clear();
    if (has_gone) ++revision_;
    return has_gone;
  }

  Numbered now_;
  UndoSteps<Numbered> steps_;
  std::uint64_t last_number_ = 0;
  std::uint64_t saved_ = 0;
  std::uint64_t saves_ = 0;
  std::uint64_t revision_ = 0;
  std::string going_on_;  // key of the edit that the next one may continue
};

}  // namespace vpe::explore
