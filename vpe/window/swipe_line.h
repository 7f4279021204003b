// A vertical line over the view: the earlier planet is shown on its left, the planet on its right.
#pragma once

#include <glm/vec2.hpp>

#include "vpe/window/ui/imgui_helpers.h"

struct ImDrawList;

namespace vpe::window {

// Keeps where the line is, and drags it. For the main thread. All positions are framebuffer pixels.
class SwipeLine {
 public:
  static constexpr double kReach_px = 8;   // at scale 1: a press this near to the line takes it
  static constexpr double kStep = 0.02;    // of the view's width, for a key
  static constexpr double kMargin = 0.01;  // of it, from the line to the view's border at least

  bool is_on() const { return is_on_; }
  void set_on(bool is_on);

  // Returns the place of the line, as a share of the view's width from its left.
  double share() const { return share_; }
  // Returns the same in pixels of a view.
  double x_px(const ViewArea& area) const;
  void move_by(double share);

  // Takes the line at a position if it is on and near enough. Returns whether it did.
  bool press(const ViewArea& area, glm::dvec2 cursor, double scale);
  // Moves the line along with the cursor while it is held. Returns whether it is held.
  bool drag(const ViewArea& area, glm::dvec2 cursor);
  // Lets the line go. Returns whether it was held.
  bool release();
  // Returns whether the line is held, or a press at a position would take it.
  bool is_at(const ViewArea& area, glm::dvec2 cursor, double scale) const;

  // Draws the line, its handle, and which planet is on which side.
  void draw(ImDrawList& list, const ViewArea& area, double scale) const;

 private:
  bool is_on_ = false;
  double share_ = 0.5;
  bool is_held_ = false;
  double grip_px_ = 0;  // of the cursor from the line when it was taken
};

}  // namespace vpe::window
