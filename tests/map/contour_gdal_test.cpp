// Contours against those of GDAL (GDALContourGenerateEx), on made-up ground and on real ground.
#include <gdal_alg.h>
#include <gdal_priv.h>
#include <gtest/gtest.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/support.h"
#include "tests/support/worst.h"
#include "vpe/map/contour/contour.h"

namespace vpe::map {
namespace {

struct OracleEdge {
  glm::dvec2 a{0};
  glm::dvec2 b{0};
};

// All lines of one level, as loose edges.
using EdgesByLevel = std::map<double, std::vector<OracleEdge>>;

// Clips an edge to the rectangle of the posts' centres: GDAL draws lines half a pixel beyond them. Returns
// false if nothing is left.
bool clip(OracleEdge& edge, glm::dvec2 most) {
  double begin = 0;
  double end = 1;
  const glm::dvec2 along = edge.b - edge.a;
  for (const int axis : {0, 1}) {
    const double from = edge.a[axis];
    const double step = along[axis];
    if (step == 0) {
      if (from < 0 || from > most[axis]) return false;
      continue;
    }
    const double enter = ((step > 0 ? 0 : most[axis]) - from) / step;
    const double leave = ((step > 0 ? most[axis] : 0) - from) / step;
    begin = std::max(begin, enter);
    end = std::min(end, leave);
  }
  if (begin >= end) return false;
  edge = {edge.a + begin * along, edge.a + end * along};
  return true;
}

EdgesByLevel gdal_contours(const HeightGrid& grid, double interval_m, double base_m) {
  GDALAllRegister();
  GDALDriver* memory = GetGDALDriverManager()->GetDriverByName("MEM");
  const std::unique_ptr<GDALDataset> raster(
      memory->Create("", grid.columns, grid.rows, 1, GDT_Float32, nullptr));
  std::array<double, 6> to_map{-0.5, 1, 0, -0.5, 0, 1};
  raster->SetGeoTransform(to_map.data());
  GDALRasterBand* band = raster->GetRasterBand(1);
  EXPECT_EQ(band->RasterIO(GF_Write, 0, 0, grid.columns, grid.rows, const_cast<float*>(grid.heights_m.data()),
                           grid.columns, grid.rows, GDT_Float32, 0, 0, nullptr),
            CE_None);
  GDALDriver* vector_driver = GetGDALDriverManager()->GetDriverByName("Memory");
  const std::unique_ptr<GDALDataset> lines(vector_driver->Create("", 0, 0, 0, GDT_Unknown, nullptr));
  OGRLayer* layer = lines->CreateLayer("lines", nullptr, wkbLineString, nullptr);
  OGRFieldDefn field("level", OFTReal);
  EXPECT_EQ(layer->CreateField(&field), OGRERR_NONE);
  CPLStringList options;
  options.SetNameValue("LEVEL_INTERVAL", std::to_string(interval_m).c_str());
  options.SetNameValue("LEVEL_BASE", std::to_string(base_m).c_str());
  options.SetNameValue("ELEV_FIELD", "0");
  EXPECT_EQ(GDALContourGenerateEx(band, layer, options.List(), nullptr, nullptr), CE_None);
  EdgesByLevel found;
  const glm::dvec2 most(grid.columns - 1, grid.rows - 1);
  for (const auto& feature : layer) {
    const OGRLineString* line = feature->GetGeometryRef()->toLineString();
    for (int n = 0; n + 1 < line->getNumPoints(); ++n) {
      OracleEdge edge{{line->getX(n), line->getY(n)}, {line->getX(n + 1), line->getY(n + 1)}};
      if (clip(edge, most)) found[feature->GetFieldAsDouble(0)].push_back(edge);
    }
  }
  return found;
}

EdgesByLevel edges_by_level(const std::vector<ContourLine>& lines) {
  EdgesByLevel found;
  for (const ContourLine& line : lines)
    for (std::size_t n = 0; n + (line.is_closed ? 0 : 1) < line.points.size(); ++n)
      found[line.level_m].push_back({line.points[n], line.points[(n + 1) % line.points.size()]});
  return found;
}

double total_length(const std::vector<OracleEdge>& edges) {
  double sum = 0;
  for (const OracleEdge& e : edges) sum += std::hypot(e.b.x - e.a.x, e.b.y - e.a.y);
  return sum;
}

double distance_to_edge(glm::dvec2 point, const OracleEdge& edge) {
  const glm::dvec2 along = edge.b - edge.a;
  const double length2 = along.x * along.x + along.y * along.y;
  const glm::dvec2 from = point - edge.a;
  const double share =
      length2 > 0 ? std::clamp((from.x * along.x + from.y * along.y) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(from.x - share * along.x, from.y - share * along.y);
}

// Returns the largest distance of points on edges, five on each, from the other edges; at most 3, which is how
// far it looks.
double one_way_distance(const std::vector<OracleEdge>& edges, const std::vector<OracleEdge>& others) {
  std::map<std::pair<int, int>, std::vector<OracleEdge>> near;
  const auto cell = [](double x) { return static_cast<int>(std::floor(x / 2)); };
  for (const OracleEdge& e : others) {
    const glm::dvec2 middle = (e.a + e.b) * 0.5;
    near[{cell(middle.x), cell(middle.y)}].push_back(e);
  }
  double most = 0;
  for (const OracleEdge& e : edges)
    for (const double share : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const glm::dvec2 point = e.a + share * (e.b - e.a);
      double least = 3;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (const auto found = near.find({cell(point.x) + dx, cell(point.y) + dy}); found != near.end())
            for (const OracleEdge& other : found->second)
              least = std::min(least, distance_to_edge(point, other));
      most = std::max(most, least);
    }
  return most;
}

// Returns whether an edge lies in a cell with two posts at or above the level on one diagonal and two below on
// the other. GDAL always joins the same two there.
bool is_ambiguous(const HeightGrid& grid, const OracleEdge& edge, double level_m) {
  const glm::dvec2 middle = (edge.a + edge.b) * 0.5;
  const int column = std::min(static_cast<int>(middle.x), grid.columns - 2);
  const int row = std::min(static_cast<int>(middle.y), grid.rows - 2);
  const bool first = grid.at(column, row) >= level_m;
  const bool second = grid.at(column + 1, row) >= level_m;
  return first != second && (grid.at(column + 1, row + 1) >= level_m) == first &&
         (grid.at(column, row + 1) >= level_m) == second;
}

// Returns the edges that can be compared: not those in ambiguous cells, nor GDAL's rings of a millionth of a
// post around posts that are at the level.
std::vector<OracleEdge> comparable(const HeightGrid& grid, const std::vector<OracleEdge>& edges,
                                   double level_m) {
  std::vector<OracleEdge> kept;
  for (const OracleEdge& e : edges)
    if (std::hypot(e.b.x - e.a.x, e.b.y - e.a.y) > 1e-5 && !is_ambiguous(grid, e, level_m)) kept.push_back(e);
  return kept;
}

void expect_as_gdal(const HeightGrid& grid, double interval_m, double base_m, const std::string& name) {
  SCOPED_TRACE(name);
  ContourOptions options;
  options.interval_m = interval_m;
  options.base_m = base_m;
  EdgesByLevel ours = edges_by_level(contours(grid, options, 2));
  EdgesByLevel theirs = gdal_contours(grid, interval_m, base_m);
  ASSERT_GT(ours.size(), 3U);
  for (const auto& [level_m, edges] : ours) EXPECT_TRUE(theirs.contains(level_m)) << level_m;
  for (const auto& [level_m, edges] : theirs)
    EXPECT_TRUE(ours.contains(level_m) || comparable(grid, edges, level_m).empty()) << level_m;
  double our_length = 0;
  double their_length = 0;
  double whole_length = 0;
  double whole_difference = 0;
  double distance = 0;
  for (const auto& [level_m, edges] : ours) {
    const std::vector<OracleEdge>& other_edges = theirs[level_m];
    const std::vector<OracleEdge> mine = comparable(grid, edges, level_m);
    const std::vector<OracleEdge> other = comparable(grid, other_edges, level_m);
    our_length += total_length(mine);
    their_length += total_length(other);
    whole_length += total_length(edges);
    whole_difference += total_length(edges) - total_length(other_edges);
    distance = std::max({distance, one_way_distance(mine, other_edges), one_way_distance(other, edges)});
  }
  using test_support::record_worst;
  record_worst("contours against GDAL: length", std::abs(our_length / their_length - 1), 0.0005, "");
  record_worst("contours against GDAL: distance", distance, 1e-4, "posts");
  record_worst("contours against GDAL: length with ambiguous cells", std::abs(whole_difference / whole_length),
               0.01, "");
}

HeightGrid real_grid(const std::filesystem::path& file, int column, int row, int side) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> raster(GDALDataset::Open(file.c_str(), GDAL_OF_RASTER));
  HeightGrid grid{side, side, 1,
                  std::vector<float>(static_cast<std::size_t>(side) * static_cast<std::size_t>(side))};
  EXPECT_NE(raster, nullptr);
  if (raster == nullptr) return grid;
  EXPECT_EQ(raster->GetRasterBand(1)->RasterIO(GF_Read, column, row, side, side, grid.heights_m.data(), side,
                                               side, GDT_Float32, 0, 0, nullptr),
            CE_None);
  EXPECT_GT(*std::min_element(grid.heights_m.begin(), grid.heights_m.end()), -20000) << "nodata in the window";
  return grid;
}

TEST(ContourOracle, MadeUpGroundAsGdal) {
  test_support::Random random(31);
  HeightGrid grid{160, 120, 1, {}};
  const double phase = random.uniform(0, 6);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.heights_m.push_back(static_cast<float>(40 * std::sin(0.09 * column + phase) * std::cos(0.11 * row) +
                                                  9 * std::sin(0.31 * column - 0.2 * row) + 0.3 * column));
  expect_as_gdal(grid, 5, 0, "waves");
  expect_as_gdal(grid, 7.5, 1.25, "waves from another base");
}

TEST(ContourOracle, WholeMetresAsGdal) {
  // Many posts are exactly at a level.
  HeightGrid grid{150, 150, 1, {}};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      grid.heights_m.push_back(
          static_cast<float>(std::round(60 * std::sin(0.07 * column) * std::cos(0.05 * row) + 0.2 * row)));
  expect_as_gdal(grid, 10, 0, "whole metres");
}

TEST(ContourOracle, RealGroundAsGdal) {
  VPE_NEED_SHARED(mola, "mola8/mola8_topo.lbl");
  expect_as_gdal(real_grid(mola, 300, 500, 400), 250, 0, "MOLA, whole metres");
  VPE_NEED_SHARED(ctx, "gale-ctx20/gale_ctx20_mosaic.tif");
  expect_as_gdal(real_grid(ctx, 200, 900, 350), 20, 0, "CTX");
}

}  // namespace
}  // namespace vpe::map
