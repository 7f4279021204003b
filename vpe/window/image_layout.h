// Places the images of the eyes in the view of the explore window.
#pragma once

#include <glm/vec2.hpp>
#include <optional>

#include "vpe/core/stereo.h"
#include "vpe/window/ui/imgui_helpers.h"

namespace vpe::window {

// Converts positions between the window and the image of one eye. Side by side each eye has half of the view's width
// and all of its height; over and under all of the width and half of the height; else there is one image. Pure.
struct ImageLayout {
  ViewArea view;
  std::optional<core::StereoLayout> stereo;

  // Returns how many images there are beside each other, and below each other: 1 or 2.
  glm::ivec2 counts() const;
  int eyes() const { return counts().x * counts().y; }
  // Returns the size of one eye's image, pixels.
  glm::ivec2 eye_size() const;
  // Returns where all images together are; up to a pixel of the view is left over.
  ViewArea image_area() const;
  // Returns where the image of an eye is; 0 is the left eye.
  ViewArea eye_area(int eye) const;
  // Returns the eye in whose image a position is, or the nearest one.
  int eye_at(glm::dvec2 cursor) const;
  // Converts a position of the window to a position of the image of the eye that is there; returns nullopt
  // beside the images.
  std::optional<glm::dvec2> camera_xy(glm::dvec2 cursor) const;
  // Converts likewise to the image of a certain eye, which positions outside of it continue.
  glm::dvec2 xy_of(int eye, glm::dvec2 cursor) const;
};

}  // namespace vpe::window
