// The edits of a session's flight as a part of one undo order (vpe/explore/drawing/undo_history.h).
#pragma once

#include <string>

#include "vpe/explore/drawing/undo_history.h"
#include "vpe/explore/flight_controller.h"

namespace vpe::explore {

// Refers to the flight, which must outlive it. A flight that is loaded or removed ends all former steps.
class FlightUndo : public UndoStore {
 public:
  explicit FlightUndo(FlightController& flights) : flights_(flights) {}

  UndoState undo_state() const override {
    const FlightEditor* editor = flights_.editor();
    if (editor == nullptr) return {flights_.loads(), 0, 0, 0, 0};
    return {flights_.loads(), editor->steps_made(), editor->steps_dropped(), editor->undo_steps(),
            editor->redo_steps()};
  }
  std::string undo_text() const override {
    return flights_.editor() == nullptr ? "" : flights_.editor()->undo_text();
  }
  std::string redo_text() const override {
    return flights_.editor() == nullptr ? "" : flights_.editor()->redo_text();
  }
  bool undo() override { return flights_.editor() != nullptr && flights_.editor()->undo(); }
  bool redo() override { return flights_.editor() != nullptr && flights_.editor()->redo(); }
  void forget_redo() override {
    if (flights_.editor() != nullptr) flights_.editor()->forget_redo();
  }

 private:
  FlightController& flights_;
};

}  // namespace vpe::explore
