// Images of scene files, read for objects/posters: photographs whole, panoramas with what their metadata say.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "objects/files/scene_file.h"
#include "objects/posters/placed_poster.h"
#include "paging/surface/surface.h"
#include "vpe/base/file.h"

namespace vpe::app {

// Limits the pixels that are kept of a panorama; of a larger one the nearest smaller copy is taken.
inline constexpr std::int64_t kMostDomePixels = std::int64_t{1} << 25;

// Returns the files that an entry's image depends on: itself, and of a dome the sidecar beside it.
std::vector<std::filesystem::path> files_of_poster(const objects::PosterEntry& entry);

// Reads images once, until their files change. Belongs to one thread at a time.
class PosterImages {
 public:
  // Returns an entry at its place on ground with an exaggeration. Throws base::FileError for an image that cannot be read and
  // for a panorama without a description, and std::runtime_error with the file for a dome whose place nothing states.
  objects::PlacedPoster placed(const objects::PosterEntry& entry, double planet_radius_m,
                               const objects::GroundRadius& ground_radius_m);
  // Returns whether a file of an image has changed since it was read.
  bool has_changed() const;
  std::size_t bytes() const;

 private:
  using Stamps = std::vector<std::pair<std::filesystem::path, std::optional<base::FileStamp>>>;
  struct Known {
    Stamps stamps;
    objects::PosterImage image;
    std::optional<mars::LonLat> place = std::nullopt;  // as a panorama's metadata say
    objects::HeightKind height_kind = objects::HeightKind::kAboveGround;
    std::optional<double> height_m = std::nullopt;
  };
  const Known& known(const objects::PosterEntry& entry);

  std::map<std::pair<std::filesystem::path, bool>, Known> known_;  // by file, and whether it is a panorama
};

}  // namespace vpe::app
