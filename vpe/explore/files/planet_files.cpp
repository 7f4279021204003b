#include "vpe/explore/files/planet_files.h"

#include <algorithm>
#include <system_error>

namespace vpe::explore {

namespace fs = std::filesystem;

std::vector<fs::path> planet_files(std::span<const fs::path> folders) {
  std::vector<fs::path> found;
  for (const fs::path& folder : folders) {
    if (folder.empty()) continue;
    std::error_code failed;
    for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
      std::error_code unknown;
      if (at->path().extension() == ".vpe" && at->is_regular_file(unknown))
        found.push_back(fs::absolute(at->path(), unknown).lexically_normal());
    }
  }
  std::ranges::sort(found, [](const fs::path& a, const fs::path& b) {
    return a.filename() != b.filename() ? a.filename() < b.filename() : a < b;
  });
  found.erase(std::unique(found.begin(), found.end()), found.end());
  if (found.size() > kMostPlanets) found.resize(kMostPlanets);
  return found;
}

}  // namespace vpe::explore
