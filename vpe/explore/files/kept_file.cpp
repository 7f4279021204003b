#include "vpe/explore/files/kept_file.h"

#include <cstdint>
#include <vector>

#include "vpe/base/file.h"

namespace vpe::explore {

namespace fs = std::filesystem;

fs::path kept_name(const fs::path& file) {
  fs::path kept = file;
  kept += "~";
  return kept;
}

std::optional<fs::path> save_text(const fs::path& file, std::string_view text, const SaveOptions& options) {
  std::optional<fs::path> kept;
  std::error_code unknown;
  if (fs::exists(file, unknown)) {
    const std::vector<std::uint8_t> bytes = base::read_file(file, options.most_bytes);
    const std::string_view former(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (former != text && (options.keeps_former || !options.is_as_written(former))) {
      kept = kept_name(file);
      base::write_file(*kept, bytes);
    }
  }
  base::write_file(file, text);
  return kept;
}

}  // namespace vpe::explore
