#include "vpe/explore/reliefs/relief_saving.h"

#include <exception>

#include "relief/files/relief_file.h"

namespace vpe::explore {

namespace {

// Returns true if the text is as relief::to_toml() writes it: what it says is all in the reliefs.
bool is_reliefs_alone(const std::filesystem::path& file, std::string_view text) {
  try {
    return relief::to_toml(relief::parse_relief_toml(text, file)) == text;
  } catch (const std::exception&) {
    return false;
  }
}

}  // namespace

std::optional<std::filesystem::path> save_reliefs(std::span<const relief::ReliefSpec> reliefs,
                                                  const std::filesystem::path& file, bool keeps_former) {
  return save_text(file, relief::to_toml(reliefs),
                   {keeps_former, relief::kMostReliefFileBytes,
                    [&file](std::string_view former) { return is_reliefs_alone(file, former); }});
}

}  // namespace vpe::explore
