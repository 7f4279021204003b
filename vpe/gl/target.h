// An offscreen image: colour and reversed float depth, with or without multisampling.
#pragma once

#include <vector>

#include "mars/sources/source.h"
#include "vpe/gl/objects.h"

namespace vpe::gl {

class Target {
 public:
  // Throws std::runtime_error when the size or sample count is beyond what this OpenGL does.
  Target(int width, int height, int samples);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

  void bind();  // makes it the draw framebuffer and sets the viewport

  // Reads back, top row first. Depth only from a target with one sample.
  void read_colour(std::vector<base::Rgb>& out) const;
  double mean_alpha() const;  // of what read_colour() read last, 0 to 1
  void read_depth(std::vector<float>& out) const;

 private:
  int width_;
  int height_;
  int samples_;
  Framebuffer draw_;
  Renderbuffer colour_;
  Renderbuffer depth_;
  Framebuffer resolve_;  // with multisampling
  Renderbuffer resolved_colour_;
};

}  // namespace vpe::gl
