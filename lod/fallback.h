// Selects replacements for tiles that are selected but not loaded yet: a pure function of the selection and of
// the tiles that are resident.
//
// Typical usage, once per frame:
//   select(options, tree, view, scratch, selection);
//   select_fallbacks(options, tree, view, selection, resident, fallbacks);
//   draw(fallbacks.drawn);
//   for (std::size_t n : fallbacks.missing) load(selection.tiles[n]);
#pragma once

#include <cstddef>
#include <vector>

#include "lod/select.h"

namespace lod {

// Returns true if a tile can be drawn with a variant now. Its answers must not change during
// select_fallbacks().
struct IsResident {
  bool (*is_ready)(const void* context, const TileInfo& tile, int variant) = nullptr;
  const void* context = nullptr;
  bool operator()(const TileInfo& tile, int variant) const { return is_ready(context, tile, variant); }
};

struct FallbackSelection {
  // The tiles to draw: all resident, disjoint, in Morton order. They cover all that can be seen of what the
  // selection covers, except below roots that are not resident.
  Selection drawn;
  std::vector<std::size_t> missing;  // indices in selection.tiles of the tiles that are not drawn as selected
  int substituted = 0;               // number of tiles in `drawn` that were not selected
  int uncovered = 0;                 // number of selected tiles that no resident tile covers
};

// Replaces each selected tile that is not resident. The first of these that is resident takes its place:
// another of its own meshes (the nearest finer one, else the nearest coarser one), all of its descendants up to
// two levels down that can be seen, or its nearest ancestor. An ancestor replaces everything selected below it, so that a child
// is never drawn without its siblings. Errors and distances in `result` are those of the drawn tiles.
// Deterministic.
void select_fallbacks(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                      const Selection& selection, const IsResident& resident, FallbackSelection& result);

}  // namespace lod
