#include "vpe/map/place_block.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "mars/geodesy/sphere.h"

namespace vpe::map {
namespace {

constexpr double kAcceptedBlock_rad = 2e-14;
constexpr double kMostBlockSide_rad = 0.15;
constexpr int kLeastBlockSide = 16;
constexpr int kLeastBlockPixels = 256;
constexpr int kChecksOfSide = 8;

struct BlockPixel {
  int column;
  int row;
};

// Returns pixels along the rim of a block, and five within it.
std::vector<BlockPixel> checked_pixels(const PixelRect& rect) {
  const auto along = [](int n, int pixels) { return n * (pixels - 1) / kChecksOfSide; };
  const int right = rect.columns - 1;
  const int bottom = rect.rows - 1;
  std::vector<BlockPixel> pixels;
  for (int n = 0; n < kChecksOfSide; ++n) {
    pixels.push_back({along(n, rect.columns), 0});
    pixels.push_back({right, along(n, rect.rows)});
    pixels.push_back({right - along(n, rect.columns), bottom});
    pixels.push_back({0, bottom - along(n, rect.rows)});
  }
  pixels.push_back({right / 2, bottom / 2});
  for (const int column : {right / 4, right - right / 4})
    for (const int row : {bottom / 4, bottom - bottom / 4}) pixels.push_back({column, row});
  return pixels;
}

}  // namespace

int place_block_side(const mars::MapCrs& crs, const MapGrid& grid, double radius_m) {
  const double pixel_rad = grid.spacing * crs.unit_m() / radius_m;
  int side = kMostPlaceBlockSide;
  while (side > kLeastBlockSide && side * pixel_rad > kMostBlockSide_rad) side /= 2;
  return side * pixel_rad > kMostBlockSide_rad ? 0 : side;
}

double PlaceBlock::node(int n, int pixels) {
  return 0.5 * pixels * (1 + std::cos(std::numbers::pi * (n + 0.5) / kTerms));
}

PlaceBlock::Terms PlaceBlock::chebyshev(double t) {
  Terms terms{1, t};
  for (std::size_t n = 2; n < terms.size(); ++n) terms[n] = 2 * t * terms[n - 1] - terms[n - 2];
  return terms;
}

std::optional<PlaceBlock> PlaceBlock::fit(const mars::MapCrs& crs, const MapGrid& grid, const PixelRect& rect) {
  if (rect.columns * rect.rows < kLeastBlockPixels) return std::nullopt;
  std::vector<glm::dvec2> points;
  for (int j = 0; j < kTerms; ++j) {
    for (int i = 0; i < kTerms; ++i) {
      points.emplace_back(grid.left + (rect.column + node(i, rect.columns)) * grid.spacing,
                          grid.top - (rect.row + node(j, rect.rows)) * grid.spacing);
    }
  }
  const std::vector<BlockPixel> checked = checked_pixels(rect);
  for (const BlockPixel& pixel : checked)
    points.push_back(grid.middle(rect.column + pixel.column, rect.row + pixel.row));
  crs.to_place(points);
  std::vector<glm::dvec3> known;
  for (const glm::dvec2& p : points) {
    if (!std::isfinite(p.x)) return std::nullopt;
    known.push_back(mars::direction({p.x, p.y}));
  }
  const PlaceBlock block(rect, known);
  DirectionLine line;
  for (std::size_t n = 0; n < checked.size(); ++n) {
    block.directions(checked[n].row, line);
    const glm::dvec3& expected = known[kTerms * kTerms + n];
    if (!(glm::length(line.at(checked[n].column) - expected) <= kAcceptedBlock_rad)) return std::nullopt;
  }
  return block;
}

PlaceBlock::PlaceBlock(const PixelRect& rect, const std::vector<glm::dvec3>& nodes) : rect_(rect) {
  std::array<Terms, kTerms> at_node;
  for (int n = 0; n < kTerms; ++n)
    at_node[static_cast<std::size_t>(n)] = chebyshev(std::cos(std::numbers::pi * (n + 0.5) / kTerms));
  const auto weight = [](std::size_t term) { return (term == 0 ? 1.0 : 2.0) / kTerms; };
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t b = 0; b < kTerms; ++b) {
      for (std::size_t a = 0; a < kTerms; ++a) {
        double sum = 0;
        for (std::size_t j = 0; j < kTerms; ++j) {
          double of_row = 0;
          for (std::size_t i = 0; i < kTerms; ++i) of_row += nodes[j * kTerms + i][axis] * at_node[i][a];
          sum += of_row * at_node[j][b];
        }
        coefficients_[static_cast<std::size_t>(axis)][b][a] = sum * weight(a) * weight(b);
      }
    }
  }
  for (int column = 0; column < rect.columns; ++column) {
    const Terms terms = chebyshev((2.0 * column + 1) / rect.columns - 1);
    for (std::size_t a = 0; a < kTerms; ++a) terms_of_columns_[a][static_cast<std::size_t>(column)] = terms[a];
  }
}

void PlaceBlock::directions(int row, DirectionLine& line) const {
  const Terms of_row = chebyshev((2.0 * row + 1) / rect_.rows - 1);
  std::size_t axis = 0;
  for (auto* out : {&line.x, &line.y, &line.z}) {
    Terms c{};
    for (std::size_t b = 0; b < kTerms; ++b)
      for (std::size_t a = 0; a < kTerms; ++a) c[a] += coefficients_[axis][b][a] * of_row[b];
    const auto& t = terms_of_columns_;
    for (std::size_t n = 0; n < kMostPlaceBlockSide; ++n) {
      // From the smallest terms on.
      (*out)[n] = ((((((c[7] * t[7][n] + c[6] * t[6][n]) + c[5] * t[5][n]) + c[4] * t[4][n]) + c[3] * t[3][n]) +
                    c[2] * t[2][n]) +
                   c[1] * t[1][n]) +
                  c[0];
    }
    ++axis;
  }
}

}  // namespace vpe::map
