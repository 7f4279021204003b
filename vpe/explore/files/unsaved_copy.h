// Copies of unsaved work, which outlive a program that is killed or loses its display.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace vpe::explore {

// Keeps a copy of one piece of work, unsaved.HOST-PID.EXTENSION, as long as it has unsaved changes. For one
// thread at a time.
//
// Typical usage, after each edit:
//   if (std::string problem = copy.update({revision, saves}, is_changed, to_text); !problem.empty()) show(problem);
class UnsavedCopy {
 public:
  // Tells states of the work apart, for example by numbers that change with each edit and each save.
  using State = std::array<std::uint64_t, 3>;

  // Keeps copies in `folder`, which is made when it is needed. Keeps nothing if it is empty. `extension` has
  // its dot. `noun` names the work in messages: "flight".
  UnsavedCopy(std::filesystem::path folder, std::string extension, std::string noun);

  // Writes the text if the state is not that of the last call; removes the copy if nothing is unsaved. Returns
  // what went wrong, or "". A failure is reported once for each state.
  [[nodiscard]] std::string update(const State& state, bool is_unsaved,
                                   const std::function<std::string()>& to_text);

  // Returns the copy's name. There is a file only while changes are unsaved.
  const std::filesystem::path& file() const { return file_; }

  // Returns the copies in the folder whose programs are gone, the newest first.
  std::vector<std::filesystem::path> abandoned() const;

  // Makes a copy of another program this one's, so that it is replaced or removed by the next update() that
  // finds another state. Throws std::filesystem::filesystem_error if it cannot be renamed.
  void adopt(const std::filesystem::path& copy);

 private:
  std::filesystem::path folder_;
  std::string extension_;
  std::string noun_;
  std::filesystem::path file_;
  bool exists_ = false;
  State seen_{};
};

}  // namespace vpe::explore
