// Offscreen render target.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
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
  // Copies colours, the mean of several samples, to a framebuffer of its size with RGBA8, and depths, of one sample, if that
  // is asked for.
  void copy_to(const Framebuffer& to, bool with_depth) const;

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

// Says what TextureFinish does with an image.
struct FinishOptions {
  bool smooth = false;     // edges, as core::smooth_edges() does
  double gamma = 1;        // as core::apply_gamma()
  glm::ivec2 cells{0, 0};  // depths at their corners are returned; 0: none
};

// Finishes the images of targets in textures, without the CPU. Colours differ by 1 of 255 at most from those of the CPU,
// where edges are smoothed by up to kFinishError.
//
// Thread rule: the context's thread. All members throw std::runtime_error when OpenGL reports an error.
class TextureFinish {
 public:
  TextureFinish();

  // Draws a target's image into a texture, top row first. The texture may be of a context that shares objects; its storage
  // is made anew where its size is another. Returns depths of the pixels below the corners of cells, row by row from the
  // top: corner n of a side of `length` pixels has pixel min(length * n / cells, length - 1).
  std::vector<float> draw(const Target& image, GLuint texture, const FinishOptions& options);
  // Returns the bytes of all textures but those of the window.
  std::size_t bytes() const;

 private:
  void resize(glm::ivec2 size);
  std::vector<float> read_corners(glm::ivec2 cells);

  glm::ivec2 size_{0, 0};
  Framebuffer source_;
  Texture2D colour_;
  Texture2D depth_;
  Framebuffer out_;
  Framebuffer corners_;
  Texture2D corner_depth_;
  glm::ivec2 corner_size_{0, 0};
  Program finish_;
  Program corner_;
  VertexArray empty_;
};
inline constexpr int kFinishError = 3;  // of 255

}  // namespace vpe::gl
