#include "objects/reader/vdb/vdb_reader.h"

#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "objects/reader/refusal.h"
#include "objects/volumes/volume_file.h"
#include "objects/volumes/volume_level.h"

namespace objects {

namespace {

constexpr const char* kWantedGrid = "density";
constexpr Rgba kVolumeGrey{225, 220, 215, 255};

openvdb::FloatGrid::Ptr density_of(const std::filesystem::path& path) {
  openvdb::initialize();
  openvdb::io::File file(path.string());
  file.open(false);
  std::string chosen;
  bool has_surface = false;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    const openvdb::GridBase::Ptr head = file.readGridMetadata(name.gridName());
    if (head->type() != openvdb::FloatGrid::gridType()) continue;
    if (head->getGridClass() == openvdb::GRID_LEVEL_SET) {
      has_surface = true;
      continue;
    }
    if (chosen.empty() || name.gridName() == kWantedGrid) chosen = name.gridName();
  }
  if (chosen.empty()) {
    throw Refusal(has_surface ? "it holds a level set, which is a surface" : "it holds no grid of floats",
                  "export a fog volume: a grid 'density' of floats");
  }
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid(chosen));
  if (grid == nullptr || grid->activeVoxelCount() == 0) throw Refusal("its grid is empty");
  if (!grid->transform().isLinear())
    throw Refusal("its grid is not linear", "resample it to voxels of one size");
  return grid;
}

// A file with y up faces along its +z, with +x to the left.
struct ModelFrame {
  bool is_y_up;
  double unit_m;

  glm::dvec3 model(const openvdb::Vec3d& p) const {
    return is_y_up ? unit_m * glm::dvec3(-p.x(), p.z(), p.y()) : unit_m * glm::dvec3(p.x(), p.y(), p.z());
  }
  openvdb::Vec3d file(const glm::dvec3& m) const {
    const glm::dvec3 p = m / unit_m;
    return is_y_up ? openvdb::Vec3d(-p.x, p.z, p.y) : openvdb::Vec3d(p.x, p.y, p.z);
  }
};

// The lattice around all active voxels, as fine as these.
VolumeLattice lattice_around(const openvdb::FloatGrid& grid, const ModelFrame& frame) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  glm::dvec3 low_m(std::numeric_limits<double>::infinity());
  glm::dvec3 high_m(-std::numeric_limits<double>::infinity());
  for (unsigned corner = 0; corner < 8; ++corner) {
    openvdb::Vec3d at;
    for (unsigned k = 0; k < 3; ++k)
      at[static_cast<int>(k)] = ((corner >> k) & 1) != 0 ? box.max()[k] : box.min()[k];
    const glm::dvec3 m = frame.model(grid.indexToWorld(at));
    low_m = glm::min(low_m, m);
    high_m = glm::max(high_m, m);
  }
  const openvdb::Vec3d voxel = grid.voxelSize();
  const double spacing_m =
      frame.unit_m * std::min({std::abs(voxel.x()), std::abs(voxel.y()), std::abs(voxel.z())});
  VolumeLattice lattice;
  lattice.spacing_m = static_cast<float>(spacing_m);
  lattice.corner_m = glm::vec3(low_m);
  for (int k = 0; k < 3; ++k) {
    const double posts = std::round((high_m[k] - low_m[k]) / spacing_m) + 1;
    if (!(posts >= 1 && posts <= VolumeLimits::kMostSide - 4))
      throw Refusal("its grid is over " + std::to_string(VolumeLimits::kMostSide - 4) + " voxels long",
                    "resample it to fewer voxels");
    lattice.posts[static_cast<std::size_t>(k)] = std::max(2, static_cast<int>(posts));
  }
  if (post_count(lattice) > VolumeLimits::kMostPosts / 2)
    throw Refusal("its box has over " + std::to_string(VolumeLimits::kMostPosts / 2) + " voxels",
                  "resample it to fewer voxels");
  return lattice;
}

}  // namespace

std::vector<std::uint8_t> read_with_openvdb(const std::filesystem::path& path,
                                            const ModelFileOptions& options) {
  try {
    const openvdb::FloatGrid::Ptr grid = density_of(path);
    const ModelFrame frame{options.up != UpAxis::kZ, options.unit_m};
    DenseVolume dense(lattice_around(*grid, frame));
    const VolumeLattice& lattice = dense.lattice();
    const auto accessor = grid->getConstAccessor();
    for (int z = 0; z < lattice.posts[2]; ++z) {
      for (int y = 0; y < lattice.posts[1]; ++y) {
        for (int x = 0; x < lattice.posts[0]; ++x) {
          const glm::dvec3 place_m =
              glm::dvec3(lattice.corner_m) + static_cast<double>(lattice.spacing_m) * glm::dvec3(x, y, z);
          const float density =
              openvdb::tools::BoxSampler::sample(accessor, grid->worldToIndex(frame.file(place_m)));
          dense.at(x, y, z) = density / static_cast<float>(options.unit_m);
        }
      }
    }
    return volume_bytes(build_level(dense), kVolumeGrey, path);
  } catch (const openvdb::Exception& error) {
    throw Refusal(error.what());
  } catch (const std::invalid_argument& error) {
    throw Refusal(error.what());
  }
}

}  // namespace objects
