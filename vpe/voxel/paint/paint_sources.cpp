#include "vpe/voxel/paint/paint_sources.h"

#include <utility>

namespace vpe::voxel {

void PaintFailures::record(const PaintPage& page, const std::string& why) {
  const std::lock_guard lock(mutex_);
  why_.emplace(page, why);
}

std::optional<std::string> PaintFailures::of(const PaintPage& page) const {
  const std::lock_guard lock(mutex_);
  const auto at = why_.find(page);
  return at == why_.end() ? std::nullopt : std::optional(at->second);
}

void PaintFailures::clear() {
  const std::lock_guard lock(mutex_);
  why_.clear();
}

PaintPage posts_page(const lod::TileKey& key, const paging::ShadingParams& shading) {
  return {key,
          false,
          shading.exaggeration,
          shading.lit && shading.shadows ? shading.sun : glm::dvec3(0),
          paging::shows_difference(shading),
          {}};
}

PaintPage texels_page(const lod::TileKey& key, const paging::ShadingParams& shading) {
  PaintPage page;
  page.key = key;
  page.is_image = true;
  page.stretch = shading.stretch;
  return page;
}

PaintSources::PaintSources(const paging::PlanetFile& planet, const paging::TerrainShader& shader,
                           const paging::ShadingParams& shading, PaintFailures& failures,
                           std::optional<ReadingRule> rule)
    : planet_(planet), shader_(shader), shading_(shading), failures_(failures), rule_(std::move(rule)) {}

std::optional<lod::TileKey> PaintSources::coarser(const PaintPage& page) const {
  if (page.key.level == 0) return std::nullopt;
  const lod::TileKey parent = lod::ancestor(page.key, page.key.level - 1);
  return page.is_image ? planet_.image_key(parent) : parent;
}

std::optional<lod::TileKey> PaintSources::shown(const PaintPage& page) const {
  const std::lock_guard lock(mutex_);
  const auto at = absent_.find({page.is_image, lod::pack(page.key)});
  return at == absent_.end() ? std::nullopt : std::optional(at->second.shown);
}

// read(key) returns the page of a tile or throws, held(key) returns it or null.
template <class Read, class Held>
auto PaintSources::find(const PaintPage& page, const Read& read, const Held& held) {
  if (!rule_) return std::pair(read(page.key), page.key);
  PaintPage at = page;
  if (const auto coarse = shown(page)) at.key = *coarse;
  for (;;) {
    const std::optional<lod::TileKey> next = coarser(at);
    if (!next) return std::pair(read(at.key), at.key);
    if (auto there = held(at.key)) return std::pair(std::move(there), at.key);
    if (rule_->may_read() && !failures_.of(at)) {
      try {
        return std::pair(rule_->timed([&] { return read(at.key); }), at.key);
      } catch (const paging::PlanetError& e) {
        failures_.record(at, e.what());
      }
    }
    at.key = *next;
    const std::lock_guard lock(mutex_);
    absent_[{page.is_image, lod::pack(page.key)}] = {page, at.key, failures_.of(page)};
  }
}

std::shared_ptr<const paging::NormalTile> PaintSources::posts(const lod::TileKey& key) {
  return find(
             posts_page(key, shading_), [&](const lod::TileKey& at) { return shader_.normals(at, shading_); },
             [&](const lod::TileKey& at) { return shader_.held_normals(at, shading_); })
      .first;
}

PaintSources::Texels PaintSources::texels(const lod::TileKey& key) {
  auto [tile, at] = find(
      texels_page(key, shading_), [&](const lod::TileKey& k) { return shader_.image(k, shading_.stretch); },
      [&](const lod::TileKey& k) { return shader_.held_image(k, shading_.stretch); });
  return {std::move(tile), at};
}

std::vector<AbsentPage> PaintSources::absent() const {
  const std::lock_guard lock(mutex_);
  std::vector<AbsentPage> out;
  for (const auto& [name, page] : absent_) out.push_back(page);
  return out;
}

}  // namespace vpe::voxel
