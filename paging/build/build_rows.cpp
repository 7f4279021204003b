#include "paging/build/build_steps.h"

namespace paging {

Node node_of(const NodeRow& row) {
  Node node;
  node.min_m = row.min_m;
  node.max_m = row.max_m;
  node.slope = row.slope;
  node.inner = row.inner;
  node.coarser_neighbour_mask = row.coarser_neighbour_mask;
  const std::vector<int> sources = source_indices(row.sources).value();  // read_nodes() has checked it
  node.sources.insert(sources.begin(), sources.end());
  node.variants = row.variants;
  if (row.posts_terms) node.posts_terms = *row.posts_terms;
  return node;
}

NodeRow to_row(const lod::TileKey& key, const Node& node) {
  NodeRow row;
  row.key = lod::pack(key);
  row.min_m = node.min_m;
  row.max_m = node.max_m;
  row.slope = node.slope;
  row.inner = node.inner;
  row.coarser_neighbour_mask = node.coarser_neighbour_mask;
  for (const int s : node.sources) {
    if (!row.sources.empty()) row.sources.push_back(',');
    row.sources.append(std::to_string(s));
  }
  row.variants = node.variants;
  if (node.inner) row.posts_terms = node.posts_terms;
  return row;
}

Node recall_leaf(const PlanetMeta& meta, const NodeRow& row) {
  Node node = node_of(row);
  const int level = lod::unpack(row.key)->level;
  const double spacing = lod::post_spacing_m(level, meta.tile.intervals(), meta.radius_m);
  node.lowest_m = node.min_m - facet_sagitta_m(spacing, meta.radius_m);
  return node;
}

Node recall_inner(const Nodes& nodes, const NodeRow& row) {
  Node node = recall_measured(nodes, row);
  node.posts_terms = node.variants.front().terms = {};  // measured again, or taken from checkpoints
  return node;
}

Node recall_measured(const Nodes& nodes, const NodeRow& row) {
  Node node = node_of(row);
  for (int c = 0; c < 4; ++c) {
    const double lowest = nodes.at(lod::child(*lod::unpack(row.key), c)).lowest_m;
    node.lowest_m = c == 0 ? lowest : std::min(node.lowest_m, lowest);
  }
  return node;
}

}  // namespace paging
