// Copies of flights with unsaved changes, which outlive a program that is killed or loses its display.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "vpe/explore/files/unsaved_copy.h"
#include "vpe/explore/flight_editor.h"

namespace vpe::explore {

// Keeps a copy of one flight, unsaved.HOST-PID.flight, as long as the flight has unsaved changes. For one thread
// at a time.
//
// Typical usage, after each edit:
//   if (std::string problem = backup.update(flights.editor()); !problem.empty()) show(problem);
class FlightBackup {
 public:
  // Keeps copies in `folder`, which is made when it is needed. Keeps nothing if it is empty.
  explicit FlightBackup(std::filesystem::path folder) : copy_(std::move(folder), ".flight", "flight") {}

  // Writes the copy if the flight has changed since the last call; removes it if the flight is saved or null.
  // Returns what went wrong, or "". A failure is reported once for each change.
  [[nodiscard]] std::string update(const FlightEditor* editor) {
    if (editor == nullptr) return copy_.update({}, false, {});
    return copy_.update({editor->revision(), editor->saves(), 0}, editor->is_changed(),
                        [editor] { return editor->to_text(); });
  }

  // Do the same as those of UnsavedCopy.
  const std::filesystem::path& file() const { return copy_.file(); }
  std::vector<std::filesystem::path> abandoned() const { return copy_.abandoned(); }
  void adopt(const std::filesystem::path& copy) { copy_.adopt(copy); }

 private:
  UnsavedCopy copy_;
};

}  // namespace vpe::explore
