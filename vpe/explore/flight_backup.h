// Copies of flights with unsaved changes, which outlive a program that is killed or loses its display.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

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
  explicit FlightBackup(std::filesystem::path folder);

  // Writes the copy if the flight has changed since the last call; removes it if the flight is saved or null.
  // Returns what went wrong, or "". A failure is reported once for each change.
  [[nodiscard]] std::string update(const FlightEditor* editor);

  // Returns the copy's name. There is a file only while changes are unsaved.
  const std::filesystem::path& file() const { return file_; }

  // Returns the copies in the folder whose programs are gone, the newest first.
  std::vector<std::filesystem::path> abandoned() const;

  // Makes a copy of another program this one's, so that it is replaced or removed by the next update() that
  // finds a change. Throws std::filesystem::filesystem_error if it cannot be renamed.
  void adopt(const std::filesystem::path& copy);

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
  bool exists_ = false;
  std::pair<std::uint64_t, std::uint64_t> seen_{0, 0};  // FlightEditor::revision() and saves()
};

}  // namespace vpe::explore
