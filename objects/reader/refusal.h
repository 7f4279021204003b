// Why the reader of models refuses a file.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace objects {

// Reports a file that is not read: what() is the reason and advice() what to do, both without the file's name.
class Refusal : public std::runtime_error {
 public:
  explicit Refusal(const std::string& reason,
                   std::string advice = "the file may be damaged; export it again, or try another format")
      : std::runtime_error(reason), advice_(std::move(advice)) {}
  const std::string& advice() const { return advice_; }

 private:
  std::string advice_;
};

// Returns the note "2 cameras are ignored" or "1 camera is ignored".
inline std::string ignored_note(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one + " is" : many + " are") + " ignored";
}

}  // namespace objects
