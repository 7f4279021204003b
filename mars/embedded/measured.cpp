#include "mars/embedded/measured.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "mars/embedded/data_files.h"
#include "mars/embedded/math.h"
#include "mars/raster/gdal_raster.h"
#include "vpe/base/parallel.h"

namespace mars::embedded {

namespace {

constexpr int kColumns = kMeasuredColumns;
constexpr int kRows = kColumns / 2;
constexpr int kCoarseColumns = kColumns / Character::kCoarser;
constexpr int kCoarseRows = kCoarseColumns / 2;

using Posts = std::vector<float>;

// Returns the cosine of the latitude of a row.
double row_cosine(int row, int rows) { return exact_sin_cos_deg(90.0 - (row + 0.5) * 180.0 / rows).cos; }

// Returns how many columns are about as long as one row.
int columns_per_row(int row, int rows) {
  return std::max(1, static_cast<int>(std::min(rows / 2.0, 1.0 / row_cosine(row, rows)) + 0.5));
}

// Reads a post that may lie beyond the seam or a pole.
struct Globe {
  const float* posts;
  int columns;
  float operator()(int column, int row) const {
    const int rows = columns / 2;
    if (row < 0 || row >= rows) {
      row = row < 0 ? -1 - row : columns - 1 - row;
      column += rows;
    }
    column %= columns;
    if (column < 0) column += columns;
    return posts[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)];
  }
};

// Averages over `reach` rows to both sides, and over as many metres along the parallels.
void average(Posts& posts, int columns, int reach) {
  const int rows = columns / 2;
  const auto width = static_cast<std::size_t>(columns);
  Posts out(posts.size());
  std::vector<double> sums;
  for (int j = 0; j < rows; ++j) {
    const auto half =
        static_cast<std::size_t>(std::min(rows - 1.0, reach / std::max(1e-9, row_cosine(j, rows)) + 0.5));
    const float* row = posts.data() + static_cast<std::size_t>(j) * width;
    // sums[k]: of the posts before the k-th, where the row begins `half` posts earlier and ends as many later.
    sums.resize(width + 2 * half + 1);
    sums[0] = 0.0;
    for (std::size_t k = 0; k < width + 2 * half; ++k)
      sums[k + 1] = sums[k] + static_cast<double>(row[(k + width - half) % width]);
    const double share = 1.0 / static_cast<double>(2 * half + 1);
    for (std::size_t i = 0; i < width; ++i)
      out[static_cast<std::size_t>(j) * width + i] =
          static_cast<float>((sums[i + 2 * half + 1] - sums[i]) * share);
  }
  sums.assign(width, 0.0);
  // Adds a row, which may lie beyond a pole and so on the opposite meridians.
  const auto add = [&](int j, double sign) {
    const bool is_beyond = j < 0 || j >= rows;
    const int real = j < 0 ? -1 - j : (j >= rows ? columns - 1 - j : j);
    const float* row = out.data() + static_cast<std::size_t>(real) * width;
    const std::size_t shift = is_beyond ? width / 2 : 0;
    for (std::size_t i = 0; i < width - shift; ++i) sums[i] += sign * static_cast<double>(row[i + shift]);
    for (std::size_t i = width - shift; i < width; ++i)
      sums[i] += sign * static_cast<double>(row[i + shift - width]);
  };
  for (int j = -reach; j <= reach; ++j) add(j, 1.0);
  for (int j = 0; j < rows; ++j) {
    for (std::size_t i = 0; i < width; ++i)
      posts[static_cast<std::size_t>(j) * width + i] = static_cast<float>(sums[i] / (2 * reach + 1));
    add(j + reach + 1, 1.0);
    add(j - reach, -1.0);
  }
}

// Returns the means of kCoarser x kCoarser posts.
Posts coarser(const Posts& fine) {
  Posts out(static_cast<std::size_t>(kCoarseColumns) * kCoarseRows);
  constexpr int kStep = Character::kCoarser;
  for (int j = 0; j < kCoarseRows; ++j) {
    for (int i = 0; i < kCoarseColumns; ++i) {
      double sum = 0.0;
      for (int b = 0; b < kStep; ++b) {
        for (int a = 0; a < kStep; ++a) {
          sum += static_cast<double>(fine[static_cast<std::size_t>(j * kStep + b) * kColumns +
                                          static_cast<std::size_t>(i * kStep + a)]);
        }
      }
      out[static_cast<std::size_t>(j) * kCoarseColumns + static_cast<std::size_t>(i)] =
          static_cast<float>(sum / (kStep * kStep));
    }
  }
  return out;
}

// The posts near the poles are metres apart along their parallels and rounded to whole metres, which would make steep
// steps: there they are averaged along the parallel, but moved by no more than kPolarShift_m.
constexpr float kPolarShift_m = 0.75F;
void smooth_polar_steps(Posts& posts) {
  Posts row(kColumns);
  for (int j = 0; j < kRows; ++j) {
    const int half = columns_per_row(j, kRows) / 8;
    if (half == 0) continue;
    float* line = posts.data() + static_cast<std::size_t>(j) * kColumns;
    const Posts before(line, line + kColumns);
    for (int pass = 0; pass < 2; ++pass) {
      double sum = 0.0;
      const auto wrapped = [&](int i) {
        return static_cast<double>(line[static_cast<std::size_t>((i % kColumns + kColumns) % kColumns)]);
      };
      for (int i = -half; i <= half; ++i) sum += wrapped(i);
      for (int i = 0; i < kColumns; ++i) {
        row[static_cast<std::size_t>(i)] = static_cast<float>(sum / (2 * half + 1));
        sum += wrapped(i + half + 1) - wrapped(i - half);
      }
      std::copy(row.begin(), row.end(), line);
    }
    for (std::size_t i = 0; i < kColumns; ++i)
      line[i] = std::clamp(line[i], before[i] - kPolarShift_m, before[i] + kPolarShift_m);
  }
}

// Finds relief and pits: curvature of the ground at the distance of one post, and posts lower than all around.
void find_relief(const Posts& posts, Posts& energy, Posts& pits) {
  energy.resize(posts.size());
  pits.resize(posts.size());
  const Globe at{posts.data(), kColumns};
  for (int j = 0; j < kRows; ++j) {
    const int n = columns_per_row(j, kRows);
    for (int i = 0; i < kColumns; ++i) {
      const float here = at(i, j);
      const float west = at(i - n, j), east = at(i + n, j), north = at(i, j - 1), south = at(i, j + 1);
      const float bend = here - 0.25F * (west + east + north + south);
      const std::size_t k = static_cast<std::size_t>(j) * kColumns + static_cast<std::size_t>(i);
      energy[k] = bend * bend;
      const float lowest = std::min(
          {west, east, north, south, at(i - n, j - 1), at(i + n, j - 1), at(i - n, j + 1), at(i + n, j + 1)});
      const float around = 0.25F * (at(i - 2 * n, j) + at(i + 2 * n, j) + at(i, j - 2) + at(i, j + 2));
      pits[k] = here <= lowest && around - here > 60.0F ? 1.0F : 0.0F;
    }
  }
}

Posts read_band(const GdalRaster& raster, const std::string& path, int band) {
  if (raster.grid().width != kColumns || raster.grid().height != kRows)
    throw SourceError(path + ": expected " + std::to_string(kColumns) + " x " + std::to_string(kRows) +
                      " pixels; install the file again");
  Posts posts(static_cast<std::size_t>(kColumns) * kRows);
  raster.read(band, -1, {0, 0, kColumns, kRows}, kColumns, posts.data());
  return posts;
}

}  // namespace

const MeasuredMars& MeasuredMars::get() {
  static const MeasuredMars mars(find_data_file(kEmbeddedFiles[0]), find_data_file(kEmbeddedFiles[1]));
  return mars;
}

MeasuredMars::MeasuredMars(const std::string& height_file, const std::string& colour_file) {
  static std::atomic<std::uint64_t> count{0};
  id_ = ++count;
  // Returns why the file is left out.
  const auto load = [](const char* name, const std::string& path, auto&& read) -> std::string {
    if (path.empty()) {
      std::string folders;
      for (const std::string& folder : data_folders()) folders += (folders.empty() ? "" : ", ") + folder;
      return std::string(name) + " is missing in " + folders + "; set VPE_DATA to the folder that has it";
    }
    try {
      read(path);
    } catch (const std::exception& e) {
      return e.what();
    }
    return {};
  };
  vpe::base::ThreadPool pool(2);
  pool.run(2, [&](std::size_t n) {
    if (n == 0)
      height_fault_ =
          load(kEmbeddedFiles[0], height_file, [&](const std::string& path) { load_heights(path); });
    else
      colour_fault_ =
          load(kEmbeddedFiles[1], colour_file, [&](const std::string& path) { load_colours(path); });
  });
}

void MeasuredMars::load_heights(const std::string& path) {
  const GdalRaster raster(path);
  Posts posts = read_band(raster, path, 1);
  smooth_polar_steps(posts);
  Posts energy, pits;
  find_relief(posts, energy, pits);

  Posts relief = coarser(energy);
  average(relief, kCoarseColumns, 1);
  // In the octave about 8 km the ground has this part of the curvature that posts 7.4 km apart show. Measured on the
  // MOLA grid of 128 posts a degree at Gale, in plains, hills and walls.
  constexpr double kShare = 0.45;
  for (float& x : relief) x = static_cast<float>(kShare * std::sqrt(static_cast<double>(x)));
  character_.relief = GlobeSpline::near(relief, kCoarseColumns);

  Posts density = coarser(pits);
  average(density, kCoarseColumns, 10);
  average(density, kCoarseColumns, 8);
  constexpr float kHighlands = 0.012F;  // pits a post in the southern highlands
  for (float& x : density) x = std::min(1.5F, x / kHighlands);
  character_.pits = GlobeSpline::near(density, kCoarseColumns);

  Posts broad = coarser(posts);
  average(broad, kCoarseColumns, 8);
  average(broad, kCoarseColumns, 6);
  character_.broad = GlobeSpline::near(broad, kCoarseColumns);
  heights_ = GlobeSpline::through(posts, kColumns);
}

void MeasuredMars::load_colours(const std::string& path) {
  const GdalRaster raster(path);
  // The mosaic begins at longitude -180.
  const auto band = [&](int number) {
    Posts posts = read_band(raster, path, number);
    for (int j = 0; j < kRows; ++j) {
      const auto row = posts.begin() + static_cast<std::ptrdiff_t>(j) * kColumns;
      std::rotate(row, row + kColumns / 2, row + kColumns);
    }
    return posts;
  };
  const Posts red = band(1), green = band(2), blue = band(3);
  Posts tone(red.size()), white(red.size());
  for (std::size_t k = 0; k < red.size(); ++k) {
    tone[k] = (0.3F * red[k] + 0.59F * green[k] + 0.11F * blue[k]) / 255.0F;
    white[k] = std::min(1.0F, blue[k] / std::max(16.0F, red[k]));
  }
  character_.tone = GlobeSpline::near(coarser(tone), kCoarseColumns);
  character_.white = GlobeSpline::near(coarser(white), kCoarseColumns);
  red_ = GlobeSpline::through(red, kColumns);
  green_ = GlobeSpline::through(green, kColumns);
  blue_ = GlobeSpline::through(blue, kColumns);
}

}  // namespace mars::embedded
