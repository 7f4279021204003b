// Views of a panorama, drawn by OpenGL: textures of the image's levels on a faceted surface around the camera.
//
// Any orientation of the camera costs the same, roll too. A view shows the image as panorama::render_view() does: the same
// levels, the same samples, its directions within PartOptions::shift_px; colours differ by the rounding of the graphics
// pipeline. Only the textures that a view needs are read, and kept within a budget.
//
// Typical usage:
//   OverlookRenderer renderer(gl::Context::create(), tiled_image, map, {});
//   const core::RgbImage image = renderer.draw(viewer.view()).image;
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "panorama/image/tiled_image.h"
#include "panorama/viewer/level_grid.h"
#include "vpe/base/rgb.h"
#include "vpe/core/image/image.h"
#include "vpe/core/view.h"
#include "vpe/gl/context.h"
#include "vpe/gl/objects.h"
#include "vpe/gl/target.h"
#include "vpe/overlook/parts.h"

namespace vpe::overlook {

struct OverlookOptions {
  static constexpr std::size_t kMinBudget_bytes = std::size_t{8} << 20;

  panorama::ImageOrigin origin;
  base::Rgb outside{38, 40, 46};  // colour of directions that the image does not show
  // Limits the memory of textures, beside those of one view. Smaller: textures are made again more often; larger: more
  // memory. Values below kMinBudget_bytes are raised to it.
  std::size_t budget_bytes = std::size_t{128} << 20;
  int threads = 0;  // that read and decode tiles; 0 = all cores
  PartOptions parts;
};

// Draws views of one image. Belongs to the thread of its context.
class OverlookRenderer {
 public:
  // The image must outlive it. Throws std::invalid_argument for a map that panorama::check() refuses, and
  // std::runtime_error if OpenGL refuses its programs.
  OverlookRenderer(std::shared_ptr<gl::Context> context, const panorama::TiledImage& image,
                   const panorama::PanoramaMap& map, const OverlookOptions& options);

  struct Drawn {
    core::RgbImage image;
    bool is_complete = true;  // no texture was missing
  };
  // Draws a perspective view whose axes are in the panorama's frame. Reads at most `most_new` textures that it does not
  // have yet, beside those of the coarsest level; where more are wanted, coarser ones stand in. Throws
  // std::invalid_argument for other views, what reading tiles throws, and std::runtime_error when OpenGL reports an error.
  Drawn draw(const core::View& view, int most_new = std::numeric_limits<int>::max());

  // Returns the textures read so far, and the memory of those kept.
  std::int64_t reads() const { return reads_; }
  std::size_t bytes() const;

 private:
  struct Texture {
    gl::Texture2D name;
    std::uint64_t used = 0;  // number of the view that used it last
  };

  void read(const std::vector<TextureKey>& keys);
  void upload(const std::vector<Part>& parts, const core::View& view);
  void draw_part(const Part& part, std::size_t first_index, std::size_t indices);
  const gl::Program& filtered(std::size_t levels, int samples);
  void evict();

  std::shared_ptr<gl::Context> context_;
  const panorama::TiledImage& image_;
  panorama::PanoramaMap map_;
  OverlookOptions options_;
  std::vector<panorama::LevelGrid> grids_;
  std::map<TextureKey, Texture> textures_;
  std::optional<gl::Target> target_;
  gl::Program enlarged_;
  std::map<std::pair<std::size_t, int>, gl::Program>
      filtered_;  // by levels and most samples, once one is drawn
  gl::VertexArray array_;
  gl::Buffer vertices_;
  gl::Buffer indices_;
  std::vector<float> vertex_data_;
  std::vector<std::uint32_t> index_data_;
  std::vector<std::size_t> first_index_;  // of each part, and the end
  std::uint64_t views_ = 0;
  std::int64_t reads_ = 0;
};

}  // namespace vpe::overlook
