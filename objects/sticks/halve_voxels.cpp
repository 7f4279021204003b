#include "objects/sticks/halve_voxels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace objects {

namespace {

constexpr std::array<glm::ivec3, 6> kVoxelSides{
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

// The parts of a coarse voxel: part 2 * (2 * y + x) + z.
using PartAlphas = std::array<std::uint8_t, 8>;

struct ColourSum {
  double weight = 0;
  glm::dvec3 colour{0, 0, 0};
  glm::dvec3 normal{0, 0, 0};
  StickVoxel first;

  void add(const StickVoxel& v) {
    if (weight == 0) first = v;
    const double w = v.colour.a;
    weight += w;
    colour += w * glm::dvec3(v.colour.r, v.colour.g, v.colour.b);
    normal += w * glm::dvec3(v.normal[0], v.normal[1], v.normal[2]);
  }
  StickVoxel mean(std::uint8_t alpha) const {
    const auto byte = [&](double sum) { return static_cast<std::uint8_t>(std::lround(sum / weight)); };
    const Rgba c{byte(colour.x), byte(colour.y), byte(colour.z), alpha};
    const glm::dvec3 n = normal / weight;
    if (n.x * n.x + n.y * n.y + n.z * n.z >= 1.0) return stick_voxel(c, glm::vec3(n));
    StickVoxel v = first;  // opposite normals cancel out
    v.colour = c;
    return v;
  }
};

// Returns the mean of what rays along the axes lose in a voxel of these parts.
std::uint8_t alpha_along_axes(const PartAlphas& parts) {
  double sum = 0;
  for (const unsigned step : {1U, 2U, 4U}) {
    for (unsigned n = 0; n < 8; ++n) {
      if ((n & step) == 0) sum += 1.0 - (1.0 - parts[n] / 255.0) * (1.0 - parts[n | step] / 255.0);
    }
  }
  return static_cast<std::uint8_t>(std::clamp(std::lround(sum / 12.0 * 255.0), 1L, 254L));
}

struct PartlyVoxel {
  glm::ivec3 at;
  StickVoxel voxel;
  bool has_opaque_parts = false;
};

// Halves the columns of one coarse column at a time.
class VoxelHalver {
 public:
  VoxelHalver(const VoxelGrid& fine, VoxelGrid& coarse)
      : fine_(fine),
        coarse_(coarse),
        first_(fine.first_colours()),
        parts_(static_cast<std::size_t>(coarse.grid().height)),
        sums_(parts_.size()) {}

  std::vector<PartlyVoxel> run() {
    for (int y = 0; y < coarse_.grid().columns_y; ++y) {
      for (int x = 0; x < coarse_.grid().columns_x; ++x) {
        if (gather(x, y)) store(x, y);
      }
    }
    return std::move(partly_);
  }

 private:
  bool gather(int x, int y) {
    bool has_any = false;
    for (int part = 0; part < 4; ++part) {
      const int fx = 2 * x + part % 2;
      const int fy = 2 * y + part / 2;
      if (fx >= fine_.grid().columns_x || fy >= fine_.grid().columns_y) continue;
      const std::size_t column = fine_.column(fx, fy);
      for_each_stretch(fine_.bits(column), [&](int begin, int end) {
        has_any = true;
        for (int z = begin; z < end; ++z) part_at(part, z) = 255;
      });
      const std::uint64_t foot = std::uint64_t{column} * static_cast<std::uint64_t>(fine_.grid().height);
      for (std::uint32_t n = first_[column]; n < first_[column + 1]; ++n) {
        const VoxelGrid::Coloured& c = fine_.coloured()[n];
        const int z = static_cast<int>(c.place - foot);
        part_at(part, z) = c.voxel.colour.a;
        sums_[static_cast<std::size_t>(z) / 2].add(c.voxel);
      }
    }
    return has_any;
  }

  std::uint8_t& part_at(int part, int z) {
    return parts_[static_cast<std::size_t>(z) / 2][static_cast<std::size_t>(2 * part + z % 2)];
  }

  void store(int x, int y) {
    for (int z = 0; z < coarse_.grid().height; ++z) {
      const auto at = static_cast<std::size_t>(z);
      std::uint64_t all = 0;
      std::memcpy(&all, parts_[at].data(), sizeof(all));
      if (all == 0) continue;
      const auto opaque = std::count(parts_[at].begin(), parts_[at].end(), std::uint8_t{255});
      ColourSum& sum = sums_[at];
      if (opaque >= 4) {
        coarse_.set(x, y, z);
        if (sum.weight > 0) coarse_.add_colour(coarse_.place(x, y, z), sum.mean(255));
      } else {
        if (sum.weight == 0) sum.add(fine_.filling);
        partly_.push_back({{x, y, z}, sum.mean(alpha_along_axes(parts_[at])), opaque > 0});
      }
      parts_[at] = {};
      sum = {};
    }
  }

  const VoxelGrid& fine_;
  VoxelGrid& coarse_;
  std::vector<std::uint32_t> first_;
  std::vector<PartAlphas> parts_;
  std::vector<ColourSum> sums_;
  std::vector<PartlyVoxel> partly_;
};

bool has_neighbour(const VoxelGrid& grid, const glm::ivec3& at) {
  return std::any_of(kVoxelSides.begin(), kVoxelSides.end(), [&](const glm::ivec3& side) {
    return grid.is_set(at.x + side.x, at.y + side.y, at.z + side.z);
  });
}

// Fills gaps of one voxel between bits of `opaque`, except where `grid` has a voxel.
void fill_gaps(VoxelGrid& grid, const VoxelGrid& opaque) {
  const std::vector<VoxelGrid::Coloured> colours = grid.coloured();
  const auto colour_at = [&](std::uint64_t place) -> const StickVoxel* {
    const auto found =
        std::lower_bound(colours.begin(), colours.end(), place,
                         [](const VoxelGrid::Coloured& c, std::uint64_t p) { return c.place < p; });
    return found != colours.end() && found->place == place ? &found->voxel : nullptr;
  };
  for (std::size_t column = 0; column < grid.columns(); ++column) {
    const std::span<const std::uint64_t> walls = opaque.bits(column);
    const std::span<std::uint64_t> words = grid.bits(column);
    for (std::size_t w = 0; w < words.size(); ++w) {
      const std::uint64_t below = (walls[w] << 1) | (w > 0 ? walls[w - 1] >> 63 : 0);
      const std::uint64_t above = (walls[w] >> 1) | (w + 1 < words.size() ? walls[w + 1] << 63 : 0);
      const std::uint64_t gaps = below & above & ~words[w];
      words[w] |= gaps;
      for (std::uint64_t rest = gaps; rest != 0; rest &= rest - 1) {
        const std::uint64_t place = std::uint64_t{column} * static_cast<std::uint64_t>(grid.grid().height) +
                                    w * 64 + static_cast<std::uint64_t>(std::countr_zero(rest));
        const StickVoxel* voxel = colour_at(place - 1);
        if (voxel == nullptr) voxel = colour_at(place + 1);
        if (voxel != nullptr) grid.add_colour(place, *voxel);
      }
    }
  }
}

}  // namespace

VoxelGrid halved_voxels(const VoxelGrid& fine) {
  StickGrid grid = fine.grid();
  grid.columns_x = (grid.columns_x + 1) / 2;
  grid.columns_y = (grid.columns_y + 1) / 2;
  grid.height = (grid.height + 1) / 2;
  grid.voxel_m *= 2;
  VoxelGrid coarse(grid);
  coarse.filling = fine.filling;
  const std::vector<PartlyVoxel> partly = VoxelHalver(fine, coarse).run();
  const VoxelGrid opaque = coarse;
  for (const PartlyVoxel& p : partly) {
    if (!p.has_opaque_parts || !has_neighbour(opaque, p.at)) coarse.set(p.at.x, p.at.y, p.at.z, p.voxel);
  }
  coarse.tidy();
  fill_gaps(coarse, opaque);
  coarse.tidy();
  return coarse;
}

void drop_hidden_colours(VoxelGrid& voxels) {
  VoxelGrid opaque(voxels.grid());
  for (std::size_t column = 0; column < voxels.columns(); ++column)
    std::copy_n(voxels.bits(column).begin(), voxels.words(), opaque.bits(column).begin());
  for (const VoxelGrid::Coloured& c : voxels.coloured()) {
    const glm::ivec3 at = voxels.voxel_of(c.place);
    if (c.voxel.colour.a < 255) opaque.clear(at.x, at.y, at.z);
  }
  std::vector<VoxelGrid::Coloured> seen;
  seen.reserve(voxels.coloured().size());
  for (const VoxelGrid::Coloured& c : voxels.coloured()) {
    const glm::ivec3 at = voxels.voxel_of(c.place);
    const bool is_hidden = std::all_of(kVoxelSides.begin(), kVoxelSides.end(), [&](const glm::ivec3& side) {
      return opaque.is_set(at.x + side.x, at.y + side.y, at.z + side.z);
    });
    if (c.voxel.colour.a < 255 || !is_hidden) seen.push_back(c);
  }
  voxels.set_coloured(std::move(seen));
}

}  // namespace objects
