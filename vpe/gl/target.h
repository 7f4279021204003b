// Offscreen render target.
#pragma once

#include <cstdint>
#include <vector>

#include "vpe/base/rgb.h"
#include "vpe/gl/objects.h"

namespace vpe::gl {

// Owns an offscreen framebuffer: colour and reversed float depth, with or without multisampling.
//
// Thread rule: the context's thread. All members throw std::runtime_error when OpenGL reports an error.
//
// Typical usage:
//
//   Target target(640, 480, 4);
//   target.bind();
//   ... clear and draw ...
//   target.read_colour(pixels);
class Target {
 public:
  // samples: 1 for no multisampling. Throws std::runtime_error if this OpenGL cannot do the size or sample
  // count.
  Target(int width, int height, int samples);

  int width() const { return width_; }
  int height() const { return height_; }
  int samples() const { return samples_; }

  // Makes it the draw framebuffer and sets the viewport.
  void bind();

  // Reads colours back, top row first.
  void read_colour(std::vector<base::Rgb>& out) const;
  // Returns the mean alpha, 0 to 1, of the image that read_colour() read last.
  double mean_alpha() const;
  // Reads depths back, top row first. Only for a target with one sample.
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
  mutable std::vector<std::uint8_t> read_;  // by read_colour(), with alpha, the bottom row first
};

}  // namespace vpe::gl
