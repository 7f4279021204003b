// Viewsheds of one observer: ours and the program gdal_viewshed in turns, on the same ground.
//
//   viewshed_bench [FILE.tif [COLUMN ROW [HEIGHT [THREADS [ROUNDS]]]]]
//
// Without a file the ground is made up: 2049 x 2049 posts by displaced midpoints. Times are of the wall clock: of the
// program its whole run, with the reading of the ground and the writing of the result; of ours the function. Prints one
// line for each round, then medians, the ratio, and how many posts agree.
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/app/support/process.h"
#include "tests/map/viewshed_lines.h"
#include "vpe/base/quantile.h"
#include "vpe/map/viewshed/viewshed.h"

namespace {

namespace fs = std::filesystem;
using vpe::map::HeightGrid;

constexpr int kSide = 2049;
constexpr double kSpacing_m = 30;
constexpr double kHeight_m = 400;
constexpr double kRoughness = 1.2;

using DatasetOwner = std::unique_ptr<GDALDataset, void (*)(GDALDataset*)>;

DatasetOwner owned(GDALDataset* dataset, const std::string& what) {
  if (dataset == nullptr) throw std::runtime_error("cannot open " + what + ": " + CPLGetLastErrorMsg());
  return {dataset, [](GDALDataset* d) { GDALClose(d); }};
}

template <class Value>
void transfer(GDALDataset& dataset, GDALRWFlag direction, GDALDataType type, std::vector<Value>& values) {
  const int columns = dataset.GetRasterXSize();
  const int rows = dataset.GetRasterYSize();
  values.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  if (dataset.GetRasterBand(1)->RasterIO(direction, 0, 0, columns, rows, values.data(), columns, rows, type, 0,
                                         0, nullptr) != CE_None)
    throw std::runtime_error(CPLGetLastErrorMsg());
}

void make_ground(const fs::path& path) {
  HeightGrid grid = vpe::map::fractal_grid(kSide, kSpacing_m, kHeight_m, kRoughness, 5);
  const auto raster = owned(GetGDALDriverManager()->GetDriverByName("GTiff")->Create(path.c_str(), kSide, kSide,
                                                                                     1, GDT_Float32, nullptr),
                            path.string());
  double to_map[6] = {0, kSpacing_m, 0, 0, 0, -kSpacing_m};
  raster->SetGeoTransform(to_map);
  transfer(*raster, GF_Write, GDT_Float32, grid.heights_m);
}

template <class Function>
double seconds(const Function& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

void bench(const std::vector<std::string>& words) {
  const auto word = [&](std::size_t n, double otherwise) {
    return n < words.size() ? std::stod(words[n]) : otherwise;
  };
  const test_support::TempDir folder;
  fs::path path = folder / "ground.tif";
  if (words.empty()) {
    make_ground(path);
  } else {
    path = fs::absolute(words[0]);
  }
  HeightGrid grid;
  std::array<double, 6> to_map{};
  {
    const auto raster = owned(GDALDataset::Open(path.c_str()), path.string());
    raster->GetGeoTransform(to_map.data());
    grid.columns = raster->GetRasterXSize();
    grid.rows = raster->GetRasterYSize();
    grid.spacing_m = to_map[1];
    transfer(*raster, GF_Read, GDT_Float32, grid.heights_m);
  }
  vpe::map::ViewshedOptions options;
  options.column = static_cast<int>(word(1, grid.columns / 2));
  options.row = static_cast<int>(word(2, grid.rows / 2));
  options.observer_height_m = word(3, 100);
  vpe::base::ThreadPool pool(static_cast<int>(word(4, 2)));
  const int rounds = static_cast<int>(word(5, 5));

  app_test::Command program;
  program.program = app_test::find_program("gdal_viewshed");
  if (program.program.empty()) throw std::runtime_error("gdal_viewshed is not on PATH");
  program.folder = folder.path();
  program.arguments = {"-q",
                       "-cc",
                       "0",
                       "-md",
                       "0",
                       "-vv",
                       "1",
                       "-iv",
                       "0",
                       "-ov",
                       "255",
                       "-oz",
                       std::to_string(options.observer_height_m),
                       "-ox",
                       std::to_string(to_map[0] + (options.column + 0.5) * to_map[1]),
                       "-oy",
                       std::to_string(to_map[3] + (options.row + 0.5) * to_map[5]),
                       path.string(),
                       "theirs.tif"};
  std::vector<double> theirs_s;
  std::vector<double> ours_s;
  std::vector<double> needed_s;
  vpe::map::Viewshed shed;
  for (int round = 0; round < rounds; ++round) {
    theirs_s.push_back(seconds([&] {
      const app_test::Result result = app_test::run(program);
      if (result.exit_code != 0) throw std::runtime_error("gdal_viewshed failed: " + result.err);
    }));
    ours_s.push_back(seconds([&] { shed = vpe::map::viewshed(grid, options, pool); }));
    needed_s.push_back(seconds([&] { static_cast<void>(vpe::map::needed_heights(grid, options, pool)); }));
    std::printf("round %d: gdal_viewshed %.4f s, viewshed %.4f s, needed_heights %.4f s\n", round + 1,
                theirs_s.back(), ours_s.back(), needed_s.back());
  }
  std::vector<std::uint8_t> theirs;
  transfer(*owned(GDALDataset::Open((folder / "theirs.tif").c_str()), "theirs.tif"), GF_Read, GDT_Byte, theirs);
  std::size_t equal = 0;
  std::size_t seen = 0;
  for (std::size_t n = 0; n < theirs.size(); ++n) {
    equal += static_cast<std::uint8_t>(shed.sights[n]) == theirs[n] ? 1U : 0U;
    seen += shed.sights[n] == vpe::map::Sight::seen ? 1U : 0U;
  }
  const double theirs_median_s = vpe::base::median_upper(theirs_s);
  const double ours_median_s = vpe::base::median_upper(ours_s);
  const double posts = static_cast<double>(theirs.size());
  std::printf(
      "%d x %d posts, %d threads, medians of %d: gdal_viewshed %.4f s, viewshed %.4f s, needed_heights %.4f s\n",
      grid.columns, grid.rows, pool.threads(), rounds, theirs_median_s, ours_median_s,
      vpe::base::median_upper(needed_s));
  std::printf("ratio %.2f; seen %.3f %%; equal %.3f %%\n", theirs_median_s / ours_median_s,
              100 * static_cast<double>(seen) / posts, 100 * static_cast<double>(equal) / posts);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    GDALAllRegister();
    bench({argv + 1, argv + argc});
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "viewshed_bench: %s\n", e.what());
    return 1;
  }
}
