// Posts and texels for painting, and coarser ones in place of those that are not there.
//
// Stage of the pipeline (vpe/voxel/ray_renderer.h): between PaintTiles and paging::TerrainShader. One
// PaintSources serves an image.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "paging/shading/terrain_shader.h"
#include "vpe/voxel/cast/reading_rule.h"

namespace vpe::voxel {

// Names posts or texels that painting uses.
struct PaintPage {
  lod::TileKey key;
  bool is_image = false;
  // Describe posts: the exaggeration, and the sun where shadows are cast, else 0.
  double exaggeration = 1;
  glm::dvec3 sun{0, 0, 0};
  bool has_differences = false;  // in place of heights (paging::NormalTile)
  paging::ImageStretch stretch;  // describes texels
  bool operator==(const PaintPage&) const = default;
};

// A page that an image needed and that was not there.
struct AbsentPage {
  PaintPage page;
  lod::TileKey shown;                  // the coarser tile that was shown
  std::optional<std::string> failure;  // why it cannot be read; absent: not loaded yet
};

// Keeps the pages that could not be read, so that they are not read again. Any thread may call any member.
class PaintFailures {
 public:
  void record(const PaintPage& page, const std::string& why);
  std::optional<std::string> of(const PaintPage& page) const;
  void clear();

 private:
  struct Less {
    bool operator()(const PaintPage& a, const PaintPage& b) const {
      const auto order = [](const PaintPage& page) {
        return std::tuple(page.is_image, page.has_differences, lod::pack(page.key));
      };
      return order(a) < order(b);
    }
  };
  mutable std::mutex mutex_;
  std::map<PaintPage, std::string, Less> why_;
};

// Return the page of the posts of a tile, and that of the texels of an image tile, as `shading` needs them.
PaintPage posts_page(const lod::TileKey& key, const paging::ShadingParams& shading);
PaintPage texels_page(const lod::TileKey& key, const paging::ShadingParams& shading);

// Any thread may call any member. What is decided of a page holds for the whole image.
class PaintSources {
 public:
  // Without a rule every page is read, and paging::PlanetError is thrown for those that cannot be read. The
  // others must outlive this.
  PaintSources(const paging::PlanetFile& planet, const paging::TerrainShader& shader,
               const paging::ShadingParams& shading, PaintFailures& failures, std::optional<ReadingRule> rule);

  struct Texels {
    std::shared_ptr<const paging::ImageTile> tile;
    lod::TileKey key;
  };
  // Return the posts of a tile that the planet has, or the texels of an image tile, or those of the nearest
  // ancestor that is there. The coarsest ancestor is read in any case. Throw paging::PlanetError.
  std::shared_ptr<const paging::NormalTile> posts(const lod::TileKey& key);
  Texels texels(const lod::TileKey& key);

  // Returns what was absent, in no particular order but always the same one.
  std::vector<AbsentPage> absent() const;

 private:
  template <class Read, class Held>
  auto find(const PaintPage& page, const Read& read, const Held& held);
  std::optional<lod::TileKey> coarser(const PaintPage& page) const;
  std::optional<lod::TileKey> shown(const PaintPage& page) const;

  const paging::PlanetFile& planet_;
  const paging::TerrainShader& shader_;
  const paging::ShadingParams& shading_;
  PaintFailures& failures_;
  std::optional<ReadingRule> rule_;
  mutable std::mutex mutex_;
  std::map<std::pair<bool, std::int64_t>, AbsentPage> absent_;  // by kind and packed key
};

}  // namespace vpe::voxel
