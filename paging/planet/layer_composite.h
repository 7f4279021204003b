// Composes the texels of an image tile from layers of imagery. Pure.
#pragma once

#include <span>
#include <vector>

#include "lod/tree/tile_key.h"
#include "paging/planet/layer_tile.h"
#include "vpe/core/appearance/image_layers.h"

namespace paging {

// Adds layers to the texels of a tile, the uppermost first:
//   LayerComposite composite(key);
//   for (auto look = looks.rbegin(); look != looks.rend() && !composite.is_opaque(); ++look) composite.add(*look, ...);
//   const std::vector<Rgb> texels = composite.texels();
class LayerComposite {
 public:
  explicit LayerComposite(const lod::TileKey& key);

  // Adds a layer below those that were added: `tile` of the key `of`, which is that of the composite or above it. Its values
  // are stretched as stretch_table() says; a coarser tile is interpolated between its texels, without those where the layer has
  // no data. A layer covers what lies below it by its share times its opacity.
  void add(const vpe::core::ImageLayerLook& look, const LayerTile& tile, const lod::TileKey& of);

  // Returns true if further layers would not be seen.
  bool is_opaque() const;

  // Returns the texels over ground of the grey that stands for missing imagery.
  std::vector<vpe::base::Rgb> texels() const;

 private:
  struct Sum {
    float r = 0;
    float g = 0;
    float b = 0;
    float left = 1;  // share of what lies below
  };

  lod::TileKey key_;
  std::vector<Sum> sums_;
};

}  // namespace paging
