#include "vpe/app/picture/scene_digests.h"

#include <algorithm>

#include "objects/files/scene_file.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/scene/poster_images.h"

namespace vpe::app {

SceneDigests::Known SceneDigests::of(const std::string& scene_file) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(scene_file);
  if (found != entries_.end() && std::ranges::all_of(found->second.stamps, [](const auto& file) {
        return file.second && base::file_stamp(file.first) == file.second;
      }))
    return found->second.known;
  Entry entry;
  // Stamps are taken before the files are read: what is written in between is seen by the next call.
  const std::optional<base::FileStamp> stamp = base::file_stamp(scene_file);
  const objects::SceneFile scene = objects::read_scene_file(scene_file);
  entry.known.has_paths = !scene.paths.empty();
  entry.stamps.emplace_back(scene_file, stamp);
  for (const std::filesystem::path& file : objects::files_of(scene)) {
    entry.stamps.emplace_back(file, base::file_stamp(file));
    entry.known.checksums.push_back(checksum_of(file));
  }
  for (const objects::PosterEntry& poster : scene.posters) {
    // The image itself is one of files_of().
    for (const std::filesystem::path& file : files_of_poster(poster)) {
      if (file == poster.file) continue;
      entry.stamps.emplace_back(file, base::file_stamp(file));
      entry.known.checksums.push_back(checksum_of(file));
    }
  }
  return (entries_[scene_file] = std::move(entry)).known;
}

}  // namespace vpe::app
