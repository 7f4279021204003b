// The inner loops of a fan of rays over a map's posts, many at a time. Private to vpe/map/viewshed; fan.h uses them.
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/map/viewshed/viewshed.h"

namespace vpe::map {

// Holds neighbouring rays from the observer and the posts of two lines that they cross: of the ring they have come to, and
// of the one before it. A ring is a line of posts at a whole number of posts from the observer; along it posts
// count from the observer's axis. Members have kPad entries more than there are rays or posts, so that vectors may reach
// beyond their end. For one thread.
struct RayFan {
  static constexpr int kPad = 32;

  // Of each ray:
  std::vector<float> slope;          // posts along a ring for each ring, 0 to 1
  std::vector<float> slope_inverse;  // 0 for slope 0
  std::vector<float> horizon;        // largest rise so far, divided by its distance in rings
  std::vector<float>
      ridge;  // the ring of that rise; the post along rings, negative, if it lies between two rings
  // Of the posts of a ring, from the first that the rays need:
  std::vector<float> rises_m;
  std::vector<float> rises_before_m;  // of the ring before, from its own first post
  std::vector<float> needed_m;        // out: least rises of targets that are seen
  std::vector<Sight> sights;          // out: of the posts
  std::vector<std::int32_t> doubts;   // out: posts in doubt, counted from the first that was asked for
};

// Describes where a ring is crossed.
struct RingCrossing {
  int rays = 0;
  int ring = 1;
  float start = 0;       // of the first ray on the ring: posts from the first of rises_m
  float step = 0;        // from ray to ray on the ring, in posts
  int first_post = 0;    // along the ring, of the first of rises_m
  int shift_before = 0;  // first post of rises_m less that of rises_before_m
};

// Raises the horizons of rays by the edge between two posts that each crosses on its way from the ring before, if any,
// and by the edge that it crosses on the ring.
void raise_horizons(const RingCrossing& crossing, RayFan& fan);

// Describes the posts of a ring between rays.
struct RingPosts {
  int rays = 0;
  int posts = 0;
  int ring = 1;
  int first = 0;                     // entry of needed_m and of sights of the first one
  float start = 0;                   // of the first one: rays from the first ray
  float step = 0;                    // from post to post, in rays
  const float* targets_m = nullptr;  // rises of targets, from that of the first entry of rises_m
};

// Interpolates the horizons at posts between those of the rays on both sides, as rises that targets need, and judges
// targets by them. Finds posts in doubt: nearer to the mean of the horizons of their rays than `doubt` differences of
// these. Returns the number of these posts.
int judge_posts(const RingPosts& posts, float doubt, RayFan& fan);

}  // namespace vpe::map
