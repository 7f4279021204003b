// Saving over files that people may have written by hand.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace vpe::explore {

// Returns the name under which the former state of a file is kept: FILE~.
std::filesystem::path kept_name(const std::filesystem::path& file);

struct SaveOptions {
  bool keeps_former = false;   // in any case
  std::size_t most_bytes = 0;  // of a file that is there
  // Returns true if a text holds nothing that the new one could not hold, such as comments or another order of lines.
  std::function<bool(std::string_view former)> is_as_written;
};

// Writes a text to a file. A file with another text is kept as kept_name() if `keeps_former` or unless is_as_written(); an
// earlier kept file is replaced. Returns the kept file, or nullopt. Throws base::FileError; the file is unchanged then.
std::optional<std::filesystem::path> save_text(const std::filesystem::path& file, std::string_view text,
                                               const SaveOptions& options);

}  // namespace vpe::explore
