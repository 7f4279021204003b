// Published figures of the papers that vpe follows, for comparison with those of this machine.
#pragma once

#include <array>

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

}  // namespace vpe::report
