// One order of undo for everything that a user edits: drawings, bookmarks, a flight.
//
// Each store keeps its own steps. The history holds only in which order the stores made them.
//
// Typical usage:
//   UndoHistory history;
//   history.join(drawings);
//   history.join(flight);
//   history.update();                       // after each event, at least once between edits of two stores
//   if (std::string what = history.undo(); !what.empty()) show("undone: " + what);
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace vpe::explore {

// Describes the steps of a store.
struct UndoState {
  std::uint64_t generation = 0;  // changes when all steps are replaced, as by another file
  std::uint64_t made = 0;  // steps ever made in this generation; grows with each edit that undo() reverts alone
  std::uint64_t dropped = 0;   // of the oldest steps, for want of memory, in this generation
  std::size_t undo_steps = 0;  // that undo() can revert
  std::size_t redo_steps = 0;  // that redo() can repeat
};

// Reverts and repeats edits of one kind of work, the last one first. A new edit ends what redo() could repeat.
class UndoStore {
 public:
  virtual ~UndoStore() = default;
  virtual UndoState undo_state() const = 0;
  // Return the edit that undo() or redo() would revert or repeat, such as "move vertex 3 of 'Rim'", or "".
  virtual std::string undo_text() const = 0;
  virtual std::string redo_text() const = 0;
  // Return false if there is no step.
  virtual bool undo() = 0;
  virtual bool redo() = 0;
  virtual void forget_redo() = 0;
};

// Orders the steps of several stores. Steps that a store has dropped, undone or redone by itself are followed.
// For one thread at a time.
class UndoHistory {
 public:
  // Adds a store, which must outlive the history. Its present steps count as older than all later ones.
  void join(UndoStore& store);

  // Takes over what the stores did since the last call. If two stores made steps since then, those of the store
  // that joined first count as older.
  void update();

  // Return the edit that undo() or redo() would revert or repeat, or "". They call update() first.
  std::string undo_text();
  std::string redo_text();
  // Revert or repeat the last edit of all stores. Return its name, or "" if there is none.
  std::string undo();
  std::string redo();

 private:
  struct Joined {
    UndoStore* store = nullptr;
    UndoState seen;
  };
  using Order = std::deque<std::size_t>;  // stores by number, the newest step last
  void follow(std::size_t number);
  void forget_other_redo(std::size_t number);

  std::vector<Joined> stores_;
  Order undo_;
  Order redo_;
};

}  // namespace vpe::explore
