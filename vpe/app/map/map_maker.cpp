#include "vpe/app/map/map_maker.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "mars/raster/output/raster_strips.h"
#include "mars/raster/raster_memory.h"
#include "vpe/app/cli/digest.h"
#include "vpe/app/cli/folder_lock.h"
#include "vpe/app/cli/interrupt.h"
#include "vpe/app/cli/progress.h"
#include "vpe/base/file.h"
#include "vpe/base/parallel.h"

namespace vpe::app {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStripBytes = std::int64_t{64} << 20;
constexpr int kMostStripRows = 512;
constexpr int kFewestRows = 4;
constexpr std::int64_t kMostPixelsOfItem = std::int64_t{1} << 19;
constexpr int kItemsOfThread = 4;

// Returns a power of two: rows of which all channels take at most kStripBytes, but at least kFewestRows.
int rows_of_strip(int columns, std::size_t channels) {
  int rows = kMostStripRows;
  while (rows > kFewestRows &&
         std::int64_t{rows} * columns * static_cast<std::int64_t>(channels * 4) > kStripBytes)
    rows /= 2;
  return rows;
}

// Returns the rows that a thread makes at once: as many as the sampler likes, but so few that all threads have work and an
// interruption is soon seen.
int rows_of_item(const map::MapSampler& sampler, int strip_rows, int threads) {
  int rows = sampler.rows_at_once();
  while (rows > kFewestRows && (rows * kItemsOfThread * threads > strip_rows ||
                                std::int64_t{rows} * sampler.grid().columns > kMostPixelsOfItem))
    rows /= 2;
  return rows;
}

map::MapGrid plan_grid(const MapRequest& request, const mars::MapCrs& crs) {
  try {
    return map::grid_of_box(crs, request.box, request.spacing_m);
  } catch (const std::invalid_argument& e) {
    throw UsageError(std::string("vpe map: ") + e.what());
  }
}

std::string read_text(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

MapMaker::MapMaker(std::shared_ptr<const paging::PlanetFile> planet, MapRequest request, fs::path output,
                   const Common& common)
    : planet_(std::move(planet)),
      request_(std::move(request)),
      output_(std::move(output)),
      folder_(output_.string() + ".strips"),
      common_(common),
      crs_(request_.crs, planet_->meta().radius_m),
      grid_(plan_grid(request_, crs_)),
      info_(raster_info(request_, crs_, grid_, planet_->meta())),
      rows_(rows_of_strip(grid_.columns, info_.bands.size())),
      strips_((grid_.rows + rows_ - 1) / rows_) {}

fs::path MapMaker::strip_path(int strip) const {
  char name[32];
  std::snprintf(name, sizeof name, "strip_%06d.tif", strip);
  return folder_ / name;
}

fs::path MapMaker::ground_path(int strip) const {
  return fs::path(strip_path(strip)).replace_extension(".json");
}

int MapMaker::strip_rows(int strip) const { return std::min(rows_, grid_.rows - strip * rows_); }

std::string MapMaker::recipe() const {
  Digest digest;
  digest.add("map").add(version()).add(planet_->meta().identity).add(info_.wkt).add(std::int64_t{rows_});
  for (const double number : info_.to_map) digest.add(number);
  digest.add(std::int64_t{grid_.columns}).add(std::int64_t{grid_.rows});
  for (const mars::BandInfo& band : info_.bands) digest.add(band.name);
  for (const auto& [key, value] : info_.metadata) digest.add(key).add(value);
  // The place whose sky has the sun.
  digest.add(request_.box.west_deg)
      .add(request_.box.east_deg)
      .add(request_.box.south_deg)
      .add(request_.box.north_deg);
  return digest.hex();
}

void MapMaker::claim_folder(const base::Shard& shard) const {
  const fs::path file = folder_ / "recipe.txt";
  std::error_code none;
  const bool is_same = read_text(file) == recipe();
  if (is_same) return;
  if (fs::exists(file, none)) {
    if (!shard.is_all()) {
      throw std::runtime_error("'" + folder_.string() +
                               "' holds strips of another map; remove it, or choose another output");
    }
    for (const auto& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("strip_")) fs::remove(entry.path(), none);
    }
  }
  base::write_file(file, recipe());
}

int MapMaker::make_strips(const base::Shard& shard) {
  const FolderLock lock(folder_, shard.is_all() ? FolderLock::Use::kAlone : FolderLock::Use::kShared, output_);
  claim_folder(shard);
  const auto exists = [&](int strip) {
    std::error_code none;
    return fs::exists(strip_path(strip), none);
  };
  const auto bytes = static_cast<std::size_t>(common_.memory_mb) << 20;
  mars::set_raster_memory(bytes / 8);
  const bool has_colour = std::ranges::find(request_.bands, map::MapBand::colour) != request_.bands.end();
  if (has_colour && planet_->meta().image_tiles == 0)
    throw UsageError("band colour: this planet has no imagery");
  const paging::Surface surface(planet_, has_colour ? bytes / 3 : bytes / 2);
  std::optional<paging::TerrainShader> shader;
  if (has_colour) shader.emplace(planet_, bytes / 4);
  const map::MapSampler sampler(surface, shader ? &*shader : nullptr, crs_, grid_, request_.bands,
                                light_of(request_, planet_->meta()));
  base::ThreadPool pool(common_.threads);
  ProgressLine progress(common_.quiet);
  const InterruptGuard guard;
  const auto begin = static_cast<int>(shard.begin(strips_));
  const auto end = static_cast<int>(shard.end(strips_));
  const int item_rows = rows_of_item(sampler, rows_, pool.threads());
  for (int strip = begin; strip < end; ++strip) {
    if (exists(strip)) continue;
    const int first = strip * rows_;
    const int rows = strip_rows(strip);
    const auto columns = static_cast<std::size_t>(grid_.columns);
    map::MapRows all(info_.bands.size(), std::vector<float>(columns * static_cast<std::size_t>(rows)));
    map::MapGround ground;
    std::mutex mutex;
    const auto items = static_cast<std::size_t>((rows + item_rows - 1) / item_rows);
    std::size_t done = 0;
    pool.run(items, [&](std::size_t item) {
      InterruptGuard::check();
      const int row = static_cast<int>(item) * item_rows;
      map::MapGround own;
      const map::MapRows part = sampler.rows(first + row, std::min(item_rows, rows - row), own);
      for (std::size_t c = 0; c < all.size(); ++c)
        std::ranges::copy(
            part[c], all[c].begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(row) * columns));
      const std::lock_guard hold(mutex);
      ground.add(own);
      ++done;
      progress.show("mapping",
                    (strip - begin + static_cast<double>(done) / static_cast<double>(items)) / (end - begin));
    });
    mars::RasterInfo info = info_;
    info.rows = rows;
    info.to_map[3] -= first * grid_.spacing;
    base::write_file(ground_path(strip), to_json(ground).dump());
    mars::write_strip(strip_path(strip), info, all);
  }
  int missing = 0;
  for (int strip = 0; strip < strips_; ++strip) missing += exists(strip) ? 0 : 1;
  return missing;
}

nlohmann::json MapMaker::join() {
  map::MapGround ground;
  std::vector<mars::RasterStrip> strips;
  for (int strip = 0; strip < strips_; ++strip) {
    ground.add(ground_from_json(nlohmann::json::parse(read_text(ground_path(strip)))));
    strips.push_back({strip_path(strip), strip_rows(strip)});
  }
  mars::RasterInfo info = info_;
  describe_ground(ground, planet_->meta(), info);
  mars::join_strips(output_, info, strips);
  std::error_code none;
  fs::remove_all(folder_, none);
  return map_json(request_, crs_, grid_, ground, planet_->meta());
}

}  // namespace vpe::app
