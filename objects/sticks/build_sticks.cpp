#include "objects/sticks/build_sticks.h"

#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <unordered_map>

#include "objects/sticks/halve_voxels.h"

namespace objects {

namespace {

constexpr int kCoarsestStickSide = 4;
// A stretch of one colour at least this long gets a run of its own: a run takes as much room as two coloured voxels.
constexpr int kLeastUniformRun = 4;

// Voxels of one colour that follow each other.
struct ColourPiece {
  int begin = 0;
  int end = 0;
  StickVoxel voxel;
};

void push_piece(std::vector<ColourPiece>& pieces, const ColourPiece& piece) {
  if (!pieces.empty() && pieces.back().end == piece.begin && pieces.back().voxel == piece.voxel) {
    pieces.back().end = piece.end;
  } else {
    pieces.push_back(piece);
  }
}

// Returns the pieces of columns, upwards.
class ColumnReader {
 public:
  explicit ColumnReader(const VoxelGrid& voxels) : voxels_(voxels), first_(voxels.first_colours()) {}

  const std::vector<ColourPiece>& pieces(std::size_t column) {
    pieces_.clear();
    foot_ = std::uint64_t{column} * static_cast<std::uint64_t>(voxels_.grid().height);
    next_ = first_[column];
    last_ = first_[column + 1];
    for_each_stretch(voxels_.bits(column), [&](int begin, int end) { read_stretch(begin, end); });
    return pieces_;
  }

 private:
  int height_of(std::uint32_t colour) const {
    return static_cast<int>(voxels_.coloured()[colour].place - foot_);
  }
  const StickVoxel& voxel_of(std::uint32_t colour) const { return voxels_.coloured()[colour].voxel; }

  void read_stretch(int begin, int end) {
    while (begin < end) {
      std::uint32_t clear = next_;
      while (clear < last_ && height_of(clear) < end && voxel_of(clear).colour.a == 255) ++clear;
      const bool has_clear = clear < last_ && height_of(clear) < end;
      const int solid_end = has_clear ? height_of(clear) : end;
      if (solid_end > begin) read_solid(begin, solid_end, clear);
      next_ = clear;
      begin = solid_end;
      if (!has_clear) continue;
      push_piece(pieces_, {begin, begin + 1, voxel_of(clear)});
      next_ = clear + 1;
      ++begin;
    }
  }

  // Shares opaque voxels out among the colours next_ to `past`.
  void read_solid(int begin, int end, std::uint32_t past) {
    if (next_ == past) {
      StickVoxel filling = voxels_.filling;
      filling.colour.a = 255;
      push_piece(pieces_, {begin, end, filling});
      return;
    }
    for (std::uint32_t n = next_; n < past; ++n) {
      const int until = n + 1 < past ? (height_of(n) + height_of(n + 1)) / 2 + 1 : end;
      push_piece(pieces_, {begin, until, voxel_of(n)});
      begin = until;
    }
  }

  const VoxelGrid& voxels_;
  std::vector<std::uint32_t> first_;
  std::vector<ColourPiece> pieces_;
  std::uint64_t foot_ = 0;
  std::uint32_t next_ = 0;
  std::uint32_t last_ = 0;
};

// Adds sticks to a level, each content once.
class StickTable {
 public:
  explicit StickTable(StickModel::Level& level) : level_(level) { level_.sticks.emplace_back(); }

  std::uint32_t add(const std::vector<ColourPiece>& pieces) {
    if (pieces.empty()) return 0;
    make_runs(pieces);
    const std::uint64_t hash = hash_of_runs();
    const auto [from, to] = sticks_.equal_range(hash);
    for (auto at = from; at != to; ++at) {
      const StickModel::Stick& stick = level_.sticks[at->second];
      if (stick.runs == runs_.size() &&
          std::equal(runs_.begin(), runs_.end(), level_.runs.begin() + stick.first_run))
        return at->second;
    }
    if (level_.runs.size() + runs_.size() > StickLimits::kMostVoxels)
      throw std::invalid_argument("the voxels make too many runs; use fewer voxels");
    const auto number = static_cast<std::uint32_t>(level_.sticks.size());
    level_.sticks.push_back({kind_of_runs(), static_cast<std::uint16_t>(runs_.size()),
                             static_cast<std::uint32_t>(level_.runs.size())});
    level_.runs.insert(level_.runs.end(), runs_.begin(), runs_.end());
    sticks_.emplace(hash, number);
    return number;
  }

 private:
  void make_runs(const std::vector<ColourPiece>& pieces) {
    runs_.clear();
    for (std::size_t n = 0; n < pieces.size();) {
      const bool is_opaque = pieces[n].voxel.colour.a == 255;
      const auto is_short = [&](std::size_t k) { return pieces[k].end - pieces[k].begin < kLeastUniformRun; };
      std::size_t past = n + 1;
      while (is_short(n) && past < pieces.size() && is_short(past) &&
             pieces[past].begin == pieces[past - 1].end && (pieces[past].voxel.colour.a == 255) == is_opaque)
        ++past;
      colours_.clear();
      for (std::size_t k = n; k < past; ++k)
        colours_.insert(colours_.end(),
                        past == n + 1 ? 1U : static_cast<std::size_t>(pieces[k].end - pieces[k].begin),
                        pieces[k].voxel);
      runs_.push_back({static_cast<std::uint16_t>(pieces[n].begin),
                       static_cast<std::uint16_t>(pieces[past - 1].end - pieces[n].begin), number_of_colours(),
                       past == n + 1, is_opaque});
      n = past;
    }
  }

  std::uint32_t number_of_colours() {
    const std::size_t size = colours_.size() * sizeof(StickVoxel);
    const std::uint64_t hash = XXH3_64bits(colours_.data(), size);
    const auto [from, to] = rows_.equal_range(hash);
    for (auto at = from; at != to; ++at) {
      if (at->second.count == colours_.size() &&
          std::memcmp(level_.voxels.data() + at->second.first, colours_.data(), size) == 0)
        return at->second.first;
    }
    if (level_.voxels.size() + colours_.size() > StickLimits::kMostVoxels)
      throw std::invalid_argument("too many voxels have a colour of their own; use fewer voxels");
    const auto first = static_cast<std::uint32_t>(level_.voxels.size());
    level_.voxels.insert(level_.voxels.end(), colours_.begin(), colours_.end());
    rows_.emplace(hash, ColourRow{first, static_cast<std::uint32_t>(colours_.size())});
    return first;
  }

  std::uint64_t hash_of_runs() {
    words_.clear();
    for (const StickModel::Run& run : runs_) {
      words_.push_back(run.begin + (std::uint32_t{run.length} << 16));
      words_.push_back(run.first_voxel);
      words_.push_back((run.is_uniform ? 1U : 0U) + (run.is_opaque ? 2U : 0U));
    }
    return XXH3_64bits(words_.data(), words_.size() * sizeof(std::uint32_t));
  }

  StickKind kind_of_runs() const {
    for (std::size_t n = 0; n < runs_.size(); ++n) {
      if (!runs_[n].is_opaque || (n > 0 && runs_[n].begin != runs_[n - 1].begin + runs_[n - 1].length))
        return StickKind::kComplex;
    }
    return runs_.size() == 1 && runs_[0].is_uniform ? StickKind::kUniform : StickKind::kTextured;
  }

  struct ColourRow {
    std::uint32_t first;
    std::uint32_t count;
  };

  StickModel::Level& level_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> sticks_;
  std::unordered_multimap<std::uint64_t, ColourRow> rows_;
  std::vector<StickModel::Run> runs_;
  std::vector<StickVoxel> colours_;
  std::vector<std::uint32_t> words_;
};

StickModel::Level level_of(const VoxelGrid& voxels) {
  StickModel::Level level;
  level.grid = voxels.grid();
  level.columns.reserve(voxels.columns());
  ColumnReader reader(voxels);
  StickTable table(level);
  for (std::size_t column = 0; column < voxels.columns(); ++column)
    level.columns.push_back(table.add(reader.pieces(column)));
  level.sticks.shrink_to_fit();
  level.runs.shrink_to_fit();
  level.voxels.shrink_to_fit();
  return level;
}

}  // namespace

StickModel build_sticks(VoxelGrid voxels) {
  if (voxels.columns() == 0) return {};
  std::vector<StickModel::Level> levels;
  voxels.tidy();
  while (true) {
    drop_hidden_colours(voxels);
    levels.push_back(level_of(voxels));
    const StickGrid& g = voxels.grid();
    if (std::max({g.columns_x, g.columns_y, g.height}) <= kCoarsestStickSide) break;
    voxels = halved_voxels(voxels);
  }
  return StickModel(std::move(levels));
}

double stick_error_m(const StickModel& model, std::size_t level) {
  const double fine_m = static_cast<double>(model.levels().at(0).grid.voxel_m);
  const double coarse_m = static_cast<double>(model.levels().at(level).grid.voxel_m);
  return std::sqrt(6.0) * (coarse_m - fine_m) * (1.0 + 1e-9);
}

}  // namespace objects
