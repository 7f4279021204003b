#include "vpe/app/scene/poster_images.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "panorama/image/tiled_image.h"
#include "panorama/metadata/open_panorama.h"
#include "vpe/app/planet/planet_argument.h"
#include "vpe/app/scene/panorama_lookup.h"
#include "vpe/core/image/image.h"

namespace vpe::app {

namespace {

objects::Rgba opaque(const base::Rgb& c) { return {c.r, c.g, c.b, 255}; }

objects::PosterImage image_of(objects::Texture texture) {
  objects::PosterImage image;
  image.width_px = texture.width;
  image.height_px = texture.height;
  image.texture = std::make_shared<const objects::TexturePyramid>(std::move(texture));
  return image;
}

objects::PosterImage read_photograph(const std::filesystem::path& file) {
  const core::RgbImage image = core::read_image(file);
  objects::Texture texture{image.width, image.height, {}};
  texture.texels.reserve(image.pixels.size());
  std::ranges::transform(image.pixels, std::back_inserter(texture.texels), opaque);
  return image_of(std::move(texture));
}

// Returns the finest level within kMostDomePixels; of a pair the left eye.
objects::Texture read_panorama(const panorama::PanoramaDescription& description) {
  panorama::TiledImageOptions options;
  options.cache_folder = [] {
    const std::filesystem::path folder = cache_folder() / "pictures";
    std::filesystem::create_directories(folder);
    return folder;
  };
  const auto image = panorama::open_tiled_image(description.image, description.format, options);
  const std::vector<panorama::ImageLevel>& levels = image->levels();
  std::size_t level = 0;
  while (level + 1 < levels.size() && levels[level].width_px * levels[level].height_px > kMostDomePixels)
    ++level;
  const panorama::ImageLevel& l = levels[level];
  const bool is_side_by_side = description.pair == panorama::PairLayout::kSideBySide;
  const bool is_over_under = description.pair == panorama::PairLayout::kOverUnder;
  objects::Texture texture;
  texture.width = static_cast<int>(is_side_by_side ? std::max<std::int64_t>(1, l.width_px / 2) : l.width_px);
  texture.height = static_cast<int>(is_over_under ? std::max<std::int64_t>(1, l.height_px / 2) : l.height_px);
  const auto width = static_cast<std::size_t>(texture.width);
  texture.texels.resize(width * static_cast<std::size_t>(texture.height));
  for (std::int64_t row = 0; row * l.tile_height_px < texture.height; ++row) {
    for (std::int64_t column = 0; column * l.tile_width_px < texture.width; ++column) {
      const auto tile = image->tile(static_cast<int>(level), column, row);
      const std::int64_t x0 = column * l.tile_width_px;
      const std::int64_t y0 = row * l.tile_height_px;
      const std::int64_t columns = std::min<std::int64_t>(tile->width_px, texture.width - x0);
      const std::int64_t rows = std::min<std::int64_t>(tile->height_px, texture.height - y0);
      for (std::int64_t y = 0; y < rows; ++y) {
        const base::Rgb* from = tile->pixels.data() + y * tile->width_px;
        std::transform(from, from + columns,
                       texture.texels.begin() + (y0 + y) * static_cast<std::int64_t>(width) + x0, opaque);
      }
    }
  }
  return texture;
}

}  // namespace

std::vector<std::filesystem::path> files_of_poster(const objects::PosterEntry& entry) {
  std::vector<std::filesystem::path> files{entry.file};
  if (entry.form != objects::PosterForm::kDome) return files;
  std::filesystem::path sidecar = entry.file;
  sidecar.replace_extension(".json");
  if (sidecar != entry.file && std::filesystem::exists(sidecar)) files.push_back(std::move(sidecar));
  return files;
}

const PosterImages::Known& PosterImages::known(const objects::PosterEntry& entry) {
  const bool is_dome = entry.form == objects::PosterForm::kDome;
  Known& known = known_[{entry.file, is_dome}];
  const auto is_same = [](const auto& file) {
    return file.second && base::file_stamp(file.first) == file.second;
  };
  if (known.image.texture && std::ranges::all_of(known.stamps, is_same)) return known;
  Known next;
  for (const std::filesystem::path& file : files_of_poster(entry))
    next.stamps.emplace_back(file, base::file_stamp(file));
  if (!is_dome) {
    next.image = read_photograph(entry.file);
    return known = std::move(next);
  }
  const panorama::PanoramaDescription description = panorama::describe(entry.file);
  objects::Texture texture = read_panorama(description);
  const panorama::PanoramaMap& map = description.map;
  const glm::dvec2 reduced(static_cast<double>(map.width_px) / texture.width,
                           static_cast<double>(map.height_px) / texture.height);
  next.image = image_of(std::move(texture));
  next.image.lookup = panorama_lookup(map, reduced);
  next.image.is_full_circle = map.is_full_turn();
  next.image.formula = panorama_formula(map);
  if (const auto& viewpoint = description.viewpoint) {
    next.place = mars::LonLat{viewpoint->lon_deg, viewpoint->lat_deg};
    next.height_kind = viewpoint->alt_m ? objects::HeightKind::kAltitude : objects::HeightKind::kAboveGround;
    next.height_m = viewpoint->alt_m ? viewpoint->alt_m : viewpoint->height_m;
  }
  return known = std::move(next);
}

objects::PlacedPoster PosterImages::placed(const objects::PosterEntry& entry, double planet_radius_m,
                                           const objects::GroundRadius& ground_radius_m) {
  const Known& of = known(entry);
  objects::PosterEntry at = entry;
  if (!at.place) {
    if (!of.place || !of.height_m) {
      throw std::runtime_error(entry.file.string() +
                               ": its metadata do not state where it was taken; add lon, lat, and height or "
                               "altitude to the [[picture]]");
    }
    at.place = of.place;
    at.height_kind = of.height_kind;
    at.height_m = *of.height_m;
  }
  return objects::place_entry(at, of.image, planet_radius_m, ground_radius_m);
}

bool PosterImages::has_changed() const {
  return std::ranges::any_of(known_, [](const auto& one) {
    return std::ranges::any_of(one.second.stamps,
                               [](const auto& file) { return base::file_stamp(file.first) != file.second; });
  });
}

std::size_t PosterImages::bytes() const {
  std::size_t sum = 0;
  for (const auto& [file, known] : known_) sum += known.image.texture ? known.image.texture->bytes() : 0;
  return sum;
}

}  // namespace vpe::app
