// A texture with coarser copies of itself, each half as wide and high, so that a pixel that shows many texels shows
// their mean (Williams 1983).
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "objects/model/mesh.h"

namespace objects {

class TexturePyramid {
 public:
  explicit TexturePyramid(Texture texture);

  // Returns the colour, 0 to 255 with alpha, at texture coordinates, which repeat. footprint_uv is the side of what a
  // pixel covers in texture coordinates; two levels are mixed by it. Bilinear in each level, pixel centres at +0.5.
  glm::vec4 sample(const glm::vec2& uv, float footprint_uv) const;
  // Returns the colour at coordinates of an image that does not repeat, or across only. Beyond its edges lies what is at them.
  // footprint_texels is the side of what a pixel covers, in texels of the finest level. Filtered as sample().
  glm::vec4 sample_within(const glm::vec2& uv, float footprint_texels, bool repeats_across) const;
  // Returns the mean of all texels.
  glm::vec4 mean() const;
  std::size_t bytes() const;
  // Returns the texture and its coarser copies.
  std::span<const Texture> levels() const { return levels_; }
  // Returns whether no texel lets anything through.
  bool is_opaque() const { return is_opaque_; }

 private:
  std::vector<Texture> levels_;
  bool is_opaque_;
};

}  // namespace objects
