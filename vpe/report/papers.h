// Published figures of the papers that vpe follows, for comparison with those of this machine.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "vpe/report/interleaved_timing.h"
#include "vpe/report/table.h"

namespace vpe::report {

// Rendering times of a pair of 500 x 400 pixels on a number of processors (194 MHz), seconds.
struct PublishedPair {
  int processors = 0;
  double left_s = 0;
  double right_s = 0;
};

// Wan, Zhang, Kaufman, Qu (2000), Table 1: with a lighting model, terrain of 512 x 512 x 64 voxels.
inline constexpr std::array<PublishedPair, 5> kWan2000Lit{
    {{1, 2.92, 0.28}, {4, 0.79, 0.08}, {8, 0.41, 0.04}, {12, 0.30, 0.03}, {16, 0.21, 0.02}}};
// Table 2: with the texture of a photograph.
inline constexpr std::array<PublishedPair, 5> kWan2000Textured{
    {{1, 0.93, 0.25}, {4, 0.26, 0.07}, {8, 0.14, 0.04}, {12, 0.10, 0.03}, {16, 0.07, 0.02}}};

// Section 4 and Fig. 8 of the same paper.
struct PublishedReprojection {
  double cast_to_carried = 0.043;  // pixels
  double difference = 0.031;       // mean distance of colours to the image cast in full, of the largest one
  double unfiltered_difference = 0.057;  // the same without the A-buffer
  double casting_share = 0.25;           // of the right image's time
  double incoherent_casting = 4;         // time of casting without coherent starts, over that with them
};
inline constexpr PublishedReprojection kWan2000Figure8;

// Wan, Qu, Kaufman (1999), Table 1: times of an image of 500 x 400 pixels on a number of processors (194 MHz), seconds; terrain
// of 512 x 512 x 64 voxels with a photograph, pitch -30 degrees, samples 0.6 voxels apart.
struct PublishedTerrain {
  int processors = 0;
  double accurate_s = 0;     // samples of the volume
  double approximate_s = 0;  // boundary cells alone
};
inline constexpr std::array<PublishedTerrain, 5> kWan1999Terrain{
    {{1, 0.92, 0.65}, {4, 0.28, 0.21}, {8, 0.15, 0.11}, {12, 0.11, 0.08}, {16, 0.09, 0.06}}};

// Section 7 of the same paper, on one processor.
struct PublishedTerrainTimes {
  double conventional_s = 6.71;  // every ray from the camera
  double roll_45_s = 1.04;       // accurate, with a roll of 45 degrees
  double roll_mean_s = 0.96;     // mean of 10 rolls from 0 to 45 degrees
  double triangles_s = 0.80;     // all triangles with the photograph
};
inline constexpr PublishedTerrainTimes kWan1999Times;

// Cohen-Or, Rich, Lerner, Shenkar (1996), Table 1: images a second on a number of processors, of which one hands out columns. The
// one row of three whose digits are legible in the text at hand, without decimal points: "146 110 54 25 11 036". They are set so
// that the first is the pitch and the others go by the processors that draw, as the text says.
struct PublishedRate {
  int processors = 0;
  double images_per_s = 0;
};
inline constexpr std::array<PublishedRate, 5> kCohenOr1996Rates{
    {{2, 0.36}, {4, 1.1}, {8, 2.5}, {16, 5.4}, {32, 11.0}}};
inline constexpr double kCohenOr1996Pitch_deg = 14.6;  // below the horizon

// Section 3.3 of the same paper: the database, 4 bytes a voxel and a third more for coarser levels.
struct PublishedDatabase {
  const char* name;
  double finest_voxels = 0;
  double bytes = 0;
};
inline constexpr std::array<PublishedDatabase, 3> kCohenOr1996Database{
    {{"terrain of 55 x 80 km, 1 m", 4.4e9, 23.5e9},
     {"40 target areas of 2.5, 1.25 and 0.625 km, 0.5 to 0.125 m", 3e9, 12e9},
     {"all", 7.4e9, 35e9}}};

// Hitchner (1992), sections 2.2 to 2.5: figures of merit.
struct PublishedEnvironment {
  int panorama_width = 6000;
  int panorama_height = 2000;
  int panorama_facets = 8;
  double panorama_s = 600;     // "about 10 minutes"
  double overlook_per_s = 74;  // "close to" the rate at which the screen is refreshed
  double vertex_bytes = 36;    // with a normal, a colour and places in a texture
  double most_vertices = 9e5;  // of the largest terrain
};
inline constexpr PublishedEnvironment kHitchner1992;

// Holds a published table with one time for each size of something.
struct PublishedTimes {
  std::string paper;
  std::string machine;       // and settings
  std::string size_name;     // a column's name with the unit at the end, such as "map_posts"
  std::string size_meaning;  // what the sizes are of
  struct Row {
    double size = 0;
    double time_s = 0;
    std::string picture;  // file in the paper; empty: none
  };
  std::vector<Row> rows;  // in the order of the paper
  double base_size = 0;   // of the row whose time the ratios divide by
};

// Returns the table of Vyatkin and Dolgovesov (2002): time against the resolution of the height map.
const PublishedTimes& vyatkin_2002_times();

// Returns a row for each published one: size, published time and its ratio to that of the base size; the median, least
// and largest of `timings`, their ratio to the base size (the median of the rounds' ratios, with the least and the
// largest), and the ratio here over the published ratio. Name and caption of the table are empty. Throws std::invalid_argument if there is not one timing for each
// row, if a timing has no rounds or not as many as the others, or no row has the base size.
Table compare_times(const PublishedTimes& published, std::span<const Timing> timings);

}  // namespace vpe::report
