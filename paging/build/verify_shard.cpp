#include "paging/build/verify_shard.h"

#include <stdexcept>

#include "paging/build/shard_file.h"
#include "paging/planet/codec.h"
#include "paging/planet/layer_tile.h"
#include "paging/planet/planet_database.h"
#include "paging/planet/planet_file.h"
#include "vpe/core/image/image.h"

namespace paging {

namespace {

constexpr int kSideOfImage = kImageIntervals + 1;  // texels

void check_shard_rows(const ShardFile& shard, const std::vector<NodeRow>& nodes, std::size_t images,
                      VerifyReport& report) {
  const Database db = open_planet_database(shard.path());
  Statement check(db, "PRAGMA integrity_check(5)");
  while (check.step()) {
    if (check.text(0) != "ok") report.problems.push_back({"database", check.text(0)});
  }
  const auto expect = [&](const char* what, std::int64_t found, std::int64_t stated) {
    if (found == stated) return;
    report.problems.push_back({what, std::to_string(found) + " rows instead of " + std::to_string(stated)});
  };
  expect("node", static_cast<std::int64_t>(nodes.size()), shard.meta().tiles);
  expect("image", static_cast<std::int64_t>(images), shard.meta().image_tiles);
}

void check_shard_tile(ShardFile& shard, const NodeRow& row, VerifyReport& report) {
  const PlanetMeta& meta = shard.meta();
  const TilePayload payload = shard.payload(row);
  const std::size_t posts = decode_heights(payload.heights, meta.tile.posts()).size();
  if (!payload.nodata.empty()) decode_mask(payload.nodata, posts);
  for (const Bytes& mesh : payload.meshes) decode_mesh(mesh, mesh_intervals(meta.tile, row.inner));
  report.meshes += static_cast<std::int64_t>(payload.meshes.size());
  ++report.tiles;
}

void check_shard_image(ShardFile& shard, std::int64_t key, VerifyReport& report) {
  const vpe::core::RgbImage image =
      vpe::core::decode_jpeg(shard.image(key), std::int64_t{kSideOfImage} * kSideOfImage);
  if (image.width != kSideOfImage || image.height != kSideOfImage)
    throw std::runtime_error("image of the wrong size");
  ++report.images;
}

void check_shard_layers(ShardFile& shard, VerifyReport& report) {
  std::vector<ImageLayer> found = shard.meta().image_layers;
  for (ImageLayer& layer : found) layer.tiles = layer.bytes = 0;
  for (const LayerTileKey& at : shard.layer_keys()) {
    ImageLayer& layer = found[static_cast<std::size_t>(at.layer)];
    ++layer.tiles;
    try {
      const Bytes packed = shard.layer_tile(at);
      layer.bytes += static_cast<std::int64_t>(packed.size());
      decode_layer_tile(packed);
      ++report.images;
    } catch (const std::runtime_error& e) {  // PlanetError, CodecError, ImageError
      report.problems.push_back({lod::to_string(*lod::unpack(at.key)), e.what()});
    }
  }
  if (report.problems.empty() && found != shard.meta().image_layers)
    report.problems.push_back({"image_layer", "rows differ from what meta 'image_layers' states"});
}

std::string name_of_row(std::int64_t key) {
  const auto tile = lod::unpack(key);
  return tile ? lod::to_string(*tile) : "row " + std::to_string(key);
}

}  // namespace

VerifyReport verify_shard(const std::string& path, const VerifyProgress& progress) {
  ShardFile shard(path);
  VerifyReport report;
  const std::vector<NodeRow> nodes = shard.nodes();
  const std::vector<std::int64_t> images = shard.image_keys();
  check_shard_rows(shard, nodes, images.size(), report);
  const std::size_t total = nodes.size() + images.size();
  for (std::size_t n = 0; n < total; ++n) {
    const bool is_tile = n < nodes.size();
    const std::int64_t key = is_tile ? nodes[n].key : images[n - nodes.size()];
    try {
      if (is_tile) {
        check_shard_tile(shard, nodes[n], report);
      } else {
        check_shard_image(shard, key, report);
      }
    } catch (const std::runtime_error& e) {  // PlanetError, CodecError, ImageError
      report.problems.push_back({name_of_row(key), e.what()});
    }
    if (progress) progress(static_cast<double>(n + 1) / static_cast<double>(total));
  }
  check_shard_layers(shard, report);
  return report;
}

}  // namespace paging
