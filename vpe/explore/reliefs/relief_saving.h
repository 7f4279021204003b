// Saving of reliefs over a file that people may have written.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "relief/spec.h"
#include "vpe/explore/files/kept_file.h"

namespace vpe::explore {

// Writes reliefs to a file. A file that is there is kept as kept_name() if it holds what reliefs have not, such as comments and
// the order of its lines, or is no file of reliefs, or if `keeps_former`; an earlier kept file is replaced. Returns the kept
// file, or nullopt. Throws what relief::to_toml() throws, and base::FileError; the file is unchanged then.
std::optional<std::filesystem::path> save_reliefs(std::span<const relief::ReliefSpec> reliefs,
                                                  const std::filesystem::path& file, bool keeps_former);

}  // namespace vpe::explore
