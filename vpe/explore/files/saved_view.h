// A view that the user can return to.
#pragma once

#include <string>

#include "mars/geodesy/pose.h"

namespace vpe::explore {

struct SavedView {
  mars::Pose pose;
  double fov_deg = 60;  // vertical
};

// Returns true if the views are equal bit by bit.
bool same(const SavedView& a, const SavedView& b);

// Measures how far two views are apart.
struct ViewDifference {
  double distance_m = 0;    // straight, between the cameras
  double rotation_deg = 0;  // the larger of the angles between the forward axes and between the up axes
  double zoom = 1;          // larger field of view / smaller one
};
ViewDifference difference(const SavedView& a, const SavedView& b, double radius_m);

// Returns what is wrong with a view, or "". Files hold views within the limits of the flight format.
std::string problem_of(const SavedView& view);

}  // namespace vpe::explore
