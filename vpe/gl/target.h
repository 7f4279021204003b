// An offscreen picture: colour and reversed float depth, with or without multisampling.
#pragma once

#include <vector>

#include "mars/source.h"
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

  // With one sample: draws `program` over all pixels; it reads this picture's colour (texture unit 0) and depth (unit
  // 1), and what it writes is what read_colour() gives until the target is drawn into again.
  void filter(const Program& program, const VertexArray& empty);

  // Reads back, top row first. Depth only from a target with one sample.
  void read_colour(std::vector<mars::Rgb>& out) const;
  void read_depth(std::vector<float>& out) const;

 private:
  int width_;
  int height_;
  int samples_;
  bool filtered_ = false;
  Framebuffer draw_;
  Renderbuffer many_colour_;  // with multisampling
  Renderbuffer many_depth_;
  Texture2D colour_;  // with one sample
  Texture2D depth_;
  Framebuffer resolve_;  // resolved samples, or what filter() wrote
  Renderbuffer resolved_colour_;
};

}  // namespace vpe::gl
