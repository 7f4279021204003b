// What is drawn while tiles of a selection are not there yet: a pure function of (selection, what is ready).
#pragma once

#include <vector>

#include "lod/select.h"

namespace lod {

// Whether a tile can be drawn with a variant now. Pure while substitute() runs.
struct IsResident {
  bool (*is_ready)(const void* context, const TileInfo& tile, int variant) = nullptr;
  const void* context = nullptr;
  bool operator()(const TileInfo& tile, int variant) const { return is_ready(context, tile, variant); }
};

struct FallbackSelection {
  // What to draw: all ready, disjoint, along the Z curve. Covers every place that the selection covers, except
  // below roots that are not ready.
  Selection drawn;
  std::vector<std::size_t> missing;  // places in selection.tiles of those that are not drawn as selected
  int substituted = 0;               // tiles of `drawn` that were not selected
  int uncovered = 0;                 // selected tiles that nothing ready covers
};

// A selected tile that is not ready is replaced by another of its own meshes (the nearest finer one, else the
// nearest coarser one), else by all of its descendants, up to two levels down, else by its nearest ready
// ancestor; an ancestor takes the place of everything selected below it, so that never one child is drawn
// without its siblings. Errors and distances of what is drawn are its own. The same arguments give the same
// result.
void select_fallbacks(const SelectOptions& options, const TileTree& tree, const SelectView& view,
                      const Selection& selection, const IsResident& ready, FallbackSelection& result);

}  // namespace lod
