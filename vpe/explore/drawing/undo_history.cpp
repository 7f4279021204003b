#include "vpe/explore/drawing/undo_history.h"

#include <algorithm>

namespace vpe::explore {

namespace {

std::size_t count_of(const std::deque<std::size_t>& order, std::size_t number) {
  return static_cast<std::size_t>(std::count(order.begin(), order.end(), number));
}

// Removes the newest step of a store.
void drop_newest(std::deque<std::size_t>& order, std::size_t number) {
  const auto found = std::find(order.rbegin(), order.rend(), number);
  if (found != order.rend()) order.erase(std::next(found).base());
}

void drop_oldest(std::deque<std::size_t>& order, std::size_t number) {
  const auto found = std::find(order.begin(), order.end(), number);
  if (found != order.end()) order.erase(found);
}

}  // namespace

void UndoHistory::join(UndoStore& store) {
  const std::size_t number = stores_.size();
  const UndoState state = store.undo_state();
  stores_.push_back({&store, state});
  undo_.insert(undo_.begin(), state.undo_steps, number);
  redo_.insert(redo_.begin(), state.redo_steps, number);
}

void UndoHistory::forget_other_redo(std::size_t number) {
  for (std::size_t n = 0; n < stores_.size(); ++n) {
    if (n == number || stores_[n].store->undo_state().redo_steps == 0) continue;
    stores_[n].store->forget_redo();
  }
  redo_.clear();
}

void UndoHistory::follow(std::size_t number) {
  Joined& joined = stores_[number];
  const UndoState now = joined.store->undo_state();
  if (now.generation != joined.seen.generation) {
    std::erase(undo_, number);
    std::erase(redo_, number);
    joined.seen = {now.generation, 0, 0, 0, 0};
  }
  for (std::uint64_t n = joined.seen.dropped; n < now.dropped; ++n) drop_oldest(undo_, number);
  if (const std::uint64_t made = now.made - joined.seen.made; made > 0) {
    // The last steps made may have been undone already.
    const std::size_t added =
        made > now.redo_steps
            ? static_cast<std::size_t>(std::min<std::uint64_t>(made - now.redo_steps, now.undo_steps))
            : 0;
    while (count_of(undo_, number) > now.undo_steps - added) drop_newest(undo_, number);
    undo_.insert(undo_.end(), added, number);
    forget_other_redo(number);
  }
  while (count_of(redo_, number) < now.redo_steps) {
    if (count_of(undo_, number) > now.undo_steps) drop_newest(undo_, number);
    redo_.push_back(number);
  }
  while (count_of(redo_, number) > now.redo_steps) {
    drop_newest(redo_, number);
    if (count_of(undo_, number) < now.undo_steps) undo_.push_back(number);
  }
  while (count_of(undo_, number) > now.undo_steps) drop_oldest(undo_, number);
  joined.seen = now;
}

void UndoHistory::update() {
  for (std::size_t n = 0; n < stores_.size(); ++n) follow(n);
}

std::string UndoHistory::undo_text() {
  update();
  return undo_.empty() ? "" : stores_[undo_.back()].store->undo_text();
}

std::string UndoHistory::redo_text() {
  update();
  return redo_.empty() ? "" : stores_[redo_.back()].store->redo_text();
}

std::string UndoHistory::undo() {
  update();
  if (undo_.empty()) return "";
  UndoStore& store = *stores_[undo_.back()].store;
  std::string what = store.undo_text();
  if (!store.undo()) return "";
  update();
  return what.empty() ? "edit" : what;
}

std::string UndoHistory::redo() {
  update();
  if (redo_.empty()) return "";
  UndoStore& store = *stores_[redo_.back()].store;
  std::string what = store.redo_text();
  if (!store.redo()) return "";
  update();
  return what.empty() ? "edit" : what;
}

}  // namespace vpe::explore
