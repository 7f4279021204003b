// A view to come back to.
#pragma once

#include <string>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

struct SavedView {
  mars::Pose pose;
  double fov_deg = 60;  // vertical
};

// To the bit.
bool same(const SavedView& a, const SavedView& b);

// How far apart two views are, for whoever asks whether they are one.
struct ViewDifference {
  double distance_m = 0;  // straight, between the eyes
  double turn_deg = 0;    // the larger of the turns of what is ahead and of what is up
  double zoom = 1;        // larger field of view / smaller one
};
ViewDifference difference(const SavedView& a, const SavedView& b, double radius_m);

// What files hold of a view: the ranges of the flight format. Empty when all is well, else what is wrong.
std::string problem_of(const SavedView& view);

}  // namespace vpe::explore
