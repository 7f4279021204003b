#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "objects/sticks/place_index.h"
#include "objects/sticks/sculpt_view.h"

namespace objects {

namespace {

constexpr std::uint16_t kNothingSeen = std::numeric_limits<std::uint16_t>::max();
constexpr int kNormalReach = 2;  // voxels on each side
constexpr int kViewsOfBox = 6;

// The first voxel that each line of sight of a view meets.
class NearestVoxels {
 public:
  NearestVoxels(const VoxelGrid& voxels, const ProjectedView& view)
      : axes_(view.axes()),
        across_(static_cast<std::size_t>(view.voxels_across())),
        depth_(across_ * static_cast<std::size_t>(view.voxels_up()), kNothingSeen) {
    if (axes_.depth == 2) {
      read_columns(voxels);
    } else {
      read_slices(voxels);
    }
  }

  bool sees(const glm::ivec3& at) const { return depth_[index(at)] == at[axes_.depth]; }

 private:
  std::size_t index(const glm::ivec3& at) const {
    return static_cast<std::size_t>(at[axes_.up]) * across_ + static_cast<std::size_t>(at[axes_.across]);
  }

  void read_columns(const VoxelGrid& voxels) {
    for (std::size_t column = 0; column < voxels.columns(); ++column) {
      int lowest = -1;
      int highest = -1;
      for_each_stretch(voxels.bits(column), [&](int begin, int end) {
        if (lowest < 0) lowest = begin;
        highest = end - 1;
      });
      if (lowest >= 0) depth_[column] = static_cast<std::uint16_t>(axes_.toward > 0 ? highest : lowest);
    }
  }

  void read_slices(const VoxelGrid& voxels) {
    const StickGrid& g = voxels.grid();
    const int slices = axes_.depth == 0 ? g.columns_x : g.columns_y;
    for (int across = 0; across < static_cast<int>(across_); ++across) {
      std::vector<std::uint64_t> open(voxels.words(), ~std::uint64_t{0});
      for (int n = 0; n < slices; ++n) {
        const int slice = axes_.toward > 0 ? slices - 1 - n : n;
        const std::span<const std::uint64_t> words =
            voxels.bits(axes_.depth == 0 ? voxels.column(slice, across) : voxels.column(across, slice));
        for (std::size_t w = 0; w < words.size(); ++w) {
          for (std::uint64_t rest = words[w] & open[w]; rest != 0; rest &= rest - 1) {
            const std::size_t z = w * 64 + static_cast<std::size_t>(std::countr_zero(rest));
            depth_[z * across_ + static_cast<std::size_t>(across)] = static_cast<std::uint16_t>(slice);
          }
          open[w] &= ~words[w];
        }
      }
    }
  }

  SculptAxes axes_;
  std::size_t across_;
  std::vector<std::uint16_t> depth_;  // as ProjectedView counts: across, then up
};

// Returns the direction to the empty space around a voxel; it may have no length.
glm::vec3 outward(const VoxelGrid& voxels, const glm::ivec3& at) {
  glm::ivec3 sum(0);
  for (int y = -kNormalReach; y <= kNormalReach; ++y) {
    for (int x = -kNormalReach; x <= kNormalReach; ++x) {
      for (int z = -kNormalReach; z <= kNormalReach; ++z) {
        if (voxels.is_set(at.x + x, at.y + y, at.z + z)) sum -= glm::ivec3(x, y, z);
      }
    }
  }
  return glm::vec3(sum);
}

// Appends the voxels of a column that have an empty one at a side.
void append_surface(const VoxelGrid& voxels, int x, int y, std::vector<glm::ivec3>& out) {
  const StickGrid& g = voxels.grid();
  const std::span<const std::uint64_t> words = voxels.bits(voxels.column(x, y));
  const auto word_at = [&](int i, int j, std::size_t w) {
    return i < 0 || j < 0 || i >= g.columns_x || j >= g.columns_y ? 0 : voxels.bits(voxels.column(i, j))[w];
  };
  for (std::size_t w = 0; w < words.size(); ++w) {
    if (words[w] == 0) continue;
    const std::uint64_t below = (words[w] << 1) | (w > 0 ? words[w - 1] >> 63 : 0);
    const std::uint64_t above = (words[w] >> 1) | (w + 1 < words.size() ? words[w + 1] << 63 : 0);
    const std::uint64_t walled = below & above & word_at(x - 1, y, w) & word_at(x + 1, y, w) &
                                 word_at(x, y - 1, w) & word_at(x, y + 1, w);
    for (std::uint64_t rest = words[w] & ~walled; rest != 0; rest &= rest - 1)
      out.emplace_back(x, y, static_cast<int>(w) * 64 + std::countr_zero(rest));
  }
}

class SurfacePainter {
 public:
  SurfacePainter(VoxelGrid& voxels, std::span<const ProjectedView> views) : voxels_(voxels), views_(views) {
    for (const ProjectedView& view : views) nearest_.emplace_back(voxels, view);
    for (int y = 0; y < voxels.grid().columns_y; ++y) {
      for (int x = 0; x < voxels.grid().columns_x; ++x) append_surface(voxels, x, y, surface_);
    }
    for (const glm::ivec3& at : surface_) {
      index_.add(voxels.place(at.x, at.y, at.z));
      normals_.push_back(outward(voxels, at));
    }
    colours_.resize(surface_.size());
    is_done_.resize(surface_.size());
  }

  void run() {
    std::vector<std::uint32_t> todo;
    for (std::uint32_t n = 0; n < surface_.size(); ++n) {
      if (!paint(n)) todo.push_back(n);
    }
    spread(todo);
    std::vector<VoxelGrid::Coloured> out;
    out.reserve(surface_.size());
    for (std::size_t n = 0; n < surface_.size(); ++n) {
      const auto byte = [](double c) {
        return static_cast<std::uint8_t>(std::clamp(std::lround(c), 0L, 255L));
      };
      const Rgba colour{byte(colours_[n].x), byte(colours_[n].y), byte(colours_[n].z), 255};
      out.push_back({index_.places()[n], stick_voxel(colour, normals_[n])});
    }
    voxels_.set_coloured(std::move(out));
    voxels_.tidy();
  }

 private:
  // Returns false if no view sees the voxel.
  bool paint(std::uint32_t n) {
    const glm::ivec3& at = surface_[n];
    std::array<std::pair<float, std::size_t>, kViewsOfBox> order{};
    std::size_t count = 0;
    for (std::size_t v = 0; v < views_.size() && count < order.size(); ++v) {
      if (!nearest_[v].sees(at)) continue;
      const SculptAxes& axes = views_[v].axes();
      order[count++] = {-normals_[n][axes.depth] * static_cast<float>(axes.toward), v};
    }
    std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t k = 0; k < count; ++k) {
      const ProjectedView& view = views_[order[k].second];
      const std::optional<glm::dvec3> seen = view.colour(at[view.axes().across], at[view.axes().up]);
      if (!seen) continue;
      colours_[n] = *seen;
      is_done_[n] = 1;
      return true;
    }
    return false;
  }

  // Colours voxels from neighbours, in rings around those that views see.
  void spread(const std::vector<std::uint32_t>& unseen) {
    std::vector<std::uint32_t> ring;
    for (const std::uint32_t n : unseen) {
      if (mean_of_neighbours(n)) ring.push_back(n);
    }
    std::vector<std::uint8_t> is_queued(surface_.size());
    while (!ring.empty()) {
      for (const std::uint32_t n : ring) is_done_[n] = 1;
      std::vector<std::uint32_t> next;
      for (const std::uint32_t n : ring) {
        for_each_neighbour(n, [&](std::uint32_t other) {
          if (is_done_[other] != 0 || is_queued[other] != 0) return;
          is_queued[other] = 1;
          next.push_back(other);
        });
      }
      for (const std::uint32_t n : next) mean_of_neighbours(n);
      ring = std::move(next);
    }
    for (const std::uint32_t n : unseen) {
      const Rgba& c = voxels_.filling.colour;
      if (is_done_[n] == 0) colours_[n] = {c.r, c.g, c.b};
    }
  }

  template <class Visit>
  void for_each_neighbour(std::uint32_t n, const Visit& visit) const {
    const StickGrid& g = voxels_.grid();
    const glm::ivec3 at = surface_[n];
    for (int y = std::max(at.y - 1, 0); y <= std::min(at.y + 1, g.columns_y - 1); ++y) {
      for (int x = std::max(at.x - 1, 0); x <= std::min(at.x + 1, g.columns_x - 1); ++x) {
        for (int z = std::max(at.z - 1, 0); z <= std::min(at.z + 1, g.height - 1); ++z) {
          if (const std::uint32_t other = index_.find(voxels_.place(x, y, z)); other != PlaceIndex::kNone)
            visit(other);
        }
      }
    }
  }

  bool mean_of_neighbours(std::uint32_t n) {
    glm::dvec3 sum(0);
    int count = 0;
    for_each_neighbour(n, [&](std::uint32_t other) {
      if (is_done_[other] == 0) return;
      sum += colours_[other];
      ++count;
    });
    if (count == 0) return false;
    colours_[n] = sum / static_cast<double>(count);
    return true;
  }

  VoxelGrid& voxels_;
  std::span<const ProjectedView> views_;
  std::vector<NearestVoxels> nearest_;
  std::vector<glm::ivec3> surface_;
  std::vector<glm::vec3> normals_;
  std::vector<glm::dvec3> colours_;
  std::vector<std::uint8_t> is_done_;
  PlaceIndex index_;
};

}  // namespace

void colour_surface(VoxelGrid& voxels, std::span<const ProjectedView> views) {
  SurfacePainter(voxels, views).run();
}

}  // namespace objects
