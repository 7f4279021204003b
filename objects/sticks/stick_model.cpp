#include "objects/sticks/stick_model.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

namespace objects {

namespace {

template <class T>
std::size_t stored_bytes(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

std::string grid_fault(const StickGrid& g) {
  for (const int side : {g.columns_x, g.columns_y, g.height}) {
    if (side < 1 || side > StickLimits::kMostSide)
      return "a side has " + std::to_string(side) + " voxels; 1 to " + std::to_string(StickLimits::kMostSide) +
             " are allowed";
  }
  if (static_cast<std::size_t>(g.columns_x) * static_cast<std::size_t>(g.columns_y) > StickLimits::kMostColumns)
    return "it has more than " + std::to_string(StickLimits::kMostColumns) + " columns";
  const double side_m = static_cast<double>(g.voxel_m) * std::max({g.columns_x, g.columns_y, g.height});
  if (!(g.voxel_m >= std::numeric_limits<float>::min()) || !(side_m <= MeshLimits::kMostExtent_m))
    return "the edge of its voxels is not positive, or it is over 1e9 m large";
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(static_cast<double>(g.corner_m[k])) <= MeshLimits::kMostExtent_m))
      return "its corner is not finite or over 1e9 m away";
  }
  return "";
}

std::string run_fault(const StickModel::Level& level, const StickModel::Run& run, std::size_t number) {
  const auto says = [&](const char* what) { return "run " + std::to_string(number) + " " + what; };
  if (run.length == 0) return says("has no voxel");
  if (run.begin + run.length > level.grid.height) return says("ends above the grid");
  const std::size_t colours = run.is_uniform ? 1U : run.length;
  if (run.first_voxel > level.voxels.size() || colours > level.voxels.size() - run.first_voxel)
    return says("names a voxel beyond the last one");
  for (std::size_t n = 0; n < colours; ++n) {
    const int alpha = level.voxels[run.first_voxel + n].colour.a;
    if (run.is_opaque ? alpha != 255 : alpha == 0 || alpha == 255)
      return says("has another opacity than its voxels");
  }
  return "";
}

std::string stick_fault(const StickModel::Level& level, std::size_t number) {
  const StickModel::Stick& stick = level.sticks[number];
  const auto says = [&](const char* what) { return "stick " + std::to_string(number) + " " + what; };
  if (stick.kind > StickKind::kComplex) return says("is of an unknown kind");
  if ((stick.runs == 0) != (stick.kind == StickKind::kEmpty)) return says("has not the runs of its kind");
  if (stick.first_run > level.runs.size() || stick.runs > level.runs.size() - stick.first_run)
    return says("names a run beyond the last one");
  bool is_solid = true;
  for (std::size_t n = 0; n < stick.runs; ++n) {
    const StickModel::Run& run = level.runs[stick.first_run + n];
    is_solid = is_solid && run.is_opaque;
    if (n == 0) continue;
    const StickModel::Run& below = level.runs[stick.first_run + n - 1];
    if (run.begin < below.begin + below.length) return says("has runs that overlap or descend");
    is_solid = is_solid && run.begin == below.begin + below.length;
  }
  const bool is_uniform = stick.runs == 1 && level.runs[stick.first_run].is_uniform;
  if ((stick.kind == StickKind::kUniform && !(is_solid && is_uniform)) ||
      (stick.kind == StickKind::kTextured && !is_solid))
    return says("has not the runs of its kind");
  return "";
}

struct ColumnHeights {
  int low = 0;
  int high = 0;
};

ColumnHeights heights_of(const StickModel::Level& level, std::uint32_t stick_number) {
  const StickModel::Stick& stick = level.sticks[stick_number];
  if (stick.runs == 0) return {};
  const StickModel::Run& last = level.runs[stick.first_run + stick.runs - 1U];
  return {level.runs[stick.first_run].begin, last.begin + last.length};
}

// Calls visit(x, y, heights) for each column that has voxels.
template <class Visit>
void for_each_stick(const StickModel::Level& level, const Visit& visit) {
  std::size_t at = 0;
  for (int y = 0; y < level.grid.columns_y; ++y) {
    for (int x = 0; x < level.grid.columns_x; ++x, ++at) {
      if (const ColumnHeights h = heights_of(level, level.columns[at]); h.high > h.low) visit(x, y, h);
    }
  }
}

StickBlocks blocks_of(const StickModel::Level& level) {
  constexpr int kSide = StickBlocks::kSide;
  StickBlocks out;
  out.blocks_x = (level.grid.columns_x + kSide - 1) / kSide;
  const int blocks_y = (level.grid.columns_y + kSide - 1) / kSide;
  out.blocks.resize(static_cast<std::size_t>(out.blocks_x) * static_cast<std::size_t>(blocks_y));
  out.low = {level.grid.columns_x, level.grid.columns_y, level.grid.height};
  for_each_stick(level, [&](int x, int y, const ColumnHeights& h) {
    StickBlocks::Heights& block =
        out.blocks[static_cast<std::size_t>(y / kSide) * static_cast<std::size_t>(out.blocks_x) +
                   static_cast<std::size_t>(x / kSide)];
    const bool is_first = block.high == 0;
    block.low = static_cast<std::uint16_t>(is_first ? h.low : std::min<int>(block.low, h.low));
    block.high = static_cast<std::uint16_t>(std::max<int>(block.high, h.high));
    out.low = {std::min(out.low[0], x), std::min(out.low[1], y), std::min(out.low[2], h.low)};
    out.high = {std::max(out.high[0], x + 1), std::max(out.high[1], y + 1), std::max(out.high[2], h.high)};
  });
  return out;
}

Ball ball_of(const std::vector<StickModel::Level>& levels, const std::vector<StickBlocks>& blocks) {
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high(-low);
  for (std::size_t n = 0; n < levels.size(); ++n) {
    const StickGrid& g = levels[n].grid;
    if (blocks[n].high[0] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      low[k] = std::min(low[k], g.corner_m[k] + blocks[n].low[axis] * static_cast<double>(g.voxel_m));
      high[k] = std::max(high[k], g.corner_m[k] + blocks[n].high[axis] * static_cast<double>(g.voxel_m));
    }
  }
  if (!(low.x <= high.x)) return {};
  const glm::vec3 centre(0.5 * (low + high));
  double radius_m = 0;
  for (const StickModel::Level& level : levels) {
    const glm::dvec3 corner_m = glm::dvec3(level.grid.corner_m) - glm::dvec3(centre);
    const auto edge_m = static_cast<double>(level.grid.voxel_m);
    for_each_stick(level, [&](int x, int y, const ColumnHeights& h) {
      const auto farthest = [&](double from_m, int begin, int end) {
        return std::max(std::abs(from_m + begin * edge_m), std::abs(from_m + end * edge_m));
      };
      const glm::dvec3 far_m(farthest(corner_m.x, x, x + 1), farthest(corner_m.y, y, y + 1),
                             farthest(corner_m.z, h.low, h.high));
      radius_m = std::max(radius_m, glm::length(far_m));
    });
  }
  return {centre, std::nextafter(static_cast<float>(radius_m), std::numeric_limits<float>::infinity())};
}

}  // namespace

std::size_t StickModel::Level::bytes() const {
  return stored_bytes(columns) + stored_bytes(sticks) + stored_bytes(runs) + stored_bytes(voxels);
}

std::string check(const StickModel::Level& level) {
  if (const std::string fault = grid_fault(level.grid); !fault.empty()) return fault;
  const auto columns =
      static_cast<std::size_t>(level.grid.columns_x) * static_cast<std::size_t>(level.grid.columns_y);
  if (level.columns.size() != columns) return "its list of columns has not the size of its grid";
  if (level.voxels.size() > StickLimits::kMostVoxels || level.runs.size() > StickLimits::kMostVoxels)
    return "it has more than " + std::to_string(StickLimits::kMostVoxels) + " runs or coloured voxels";
  if (level.sticks.empty() || level.sticks[0].kind != StickKind::kEmpty)
    return "its first stick is not the empty one";
  if (level.sticks.size() > columns + 1) return "it has more sticks than columns";
  for (std::size_t n = 0; n < level.runs.size(); ++n) {
    if (const std::string fault = run_fault(level, level.runs[n], n); !fault.empty()) return fault;
  }
  for (std::size_t n = 0; n < level.sticks.size(); ++n) {
    if (const std::string fault = stick_fault(level, n); !fault.empty()) return fault;
  }
  for (std::size_t n = 0; n < columns; ++n) {
    if (level.columns[n] >= level.sticks.size())
      return "column " + std::to_string(n) + " names a stick beyond the last one";
  }
  return "";
}

StickModel::StickModel(std::vector<Level> levels) : levels_(std::move(levels)) {
  for (std::size_t n = 0; n < levels_.size(); ++n) {
    const std::string name = "level " + std::to_string(n) + " of a model of sticks is wrong: ";
    if (const std::string fault = check(levels_[n]); !fault.empty()) throw std::invalid_argument(name + fault);
    if (n > 0 && !(levels_[n].grid.voxel_m > levels_[n - 1].grid.voxel_m))
      throw std::invalid_argument(name + "its voxels are not larger than those of the level before");
    blocks_.push_back(blocks_of(levels_[n]));
  }
  ball_ = ball_of(levels_, blocks_);
}

std::size_t StickModel::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) sum += level.bytes();
  for (const StickBlocks& b : blocks_) sum += stored_bytes(b.blocks);
  return sum;
}

}  // namespace objects
