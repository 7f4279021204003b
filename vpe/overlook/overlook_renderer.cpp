#include "vpe/overlook/overlook_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <set>
#include <stdexcept>
#include <string>

#include "vpe/base/parallel.h"
#include "vpe/gl/opengl.h"
#include "vpe/overlook/shader_texts.h"
#include "vpe/overlook/texture_pixels.h"

namespace vpe::overlook {

namespace {

constexpr std::size_t kTexture_bytes = std::size_t{kBorderedSide_px} * kBorderedSide_px * 4;
constexpr std::size_t kFloatsPerVertex = 5;
constexpr GLint kPlaceLocation = 0;
constexpr GLint kReductionLocation = 4;
constexpr GLint kPerOctaveLocation = 5;

gl::Program make_overlook_program(const std::string& label, std::string_view fragment) {
  return gl::make_program(label, std::string(shader_text::kPartVertex).c_str(), std::string(fragment).c_str());
}

// From directions to clip coordinates x, y, w, in double: at narrow fields of view float would move pixels.
struct ClipMap {
  explicit ClipMap(const core::View& view) : axes(view.camera.axes) {
    const core::SubRectangle part = core::drawn_part(view);
    const double focal_px = core::focal_px(view);
    scale = {2.0 * focal_px / part.width, 2.0 * focal_px / part.height};
    const glm::dvec2 principal =
        0.5 * glm::dvec2(view.width, view.height) + view.principal_offset_px - glm::dvec2(part.x, part.y);
    shift = {2.0 * principal.x / part.width - 1.0, 1.0 - 2.0 * principal.y / part.height};
  }
  glm::dvec3 operator()(const glm::dvec3& direction) const {
    const double w = glm::dot(direction, axes.forward);
    return {scale.x * glm::dot(direction, axes.right) + shift.x * w,
            scale.y * glm::dot(direction, axes.up) + shift.y * w, w};
  }
  mars::Axes axes;
  glm::dvec2 scale{1, 1};
  glm::dvec2 shift{0, 0};
};

}  // namespace

OverlookRenderer::OverlookRenderer(std::shared_ptr<gl::Context> context, const panorama::TiledImage& image,
                                   const panorama::PanoramaMap& map, const OverlookOptions& options)
    : context_(std::move(context)), image_(image), map_(map), options_(options) {
  if (const std::string trouble = panorama::check(map); !trouble.empty()) throw std::invalid_argument(trouble);
  options_.budget_bytes = std::max(options_.budget_bytes, OverlookOptions::kMinBudget_bytes);
  grids_ = panorama::level_grids(image.levels(), map, options.origin);
  enlarged_ = make_overlook_program("enlarged panorama", shader_text::kEnlargedFragment);
  array_ = gl::VertexArray::make();
  vertices_ = gl::Buffer::make();
  indices_ = gl::Buffer::make();
  const GLuint array = array_.name();
  glVertexArrayVertexBuffer(array, 0, vertices_.name(), 0, kFloatsPerVertex * sizeof(float));
  glVertexArrayElementBuffer(array, indices_.name());
  const std::array<GLint, 2> sizes{3, 2};
  GLuint offset = 0;
  for (GLuint n = 0; n < 2; ++n) {
    glEnableVertexArrayAttrib(array, n);
    glVertexArrayAttribFormat(array, n, sizes[n], GL_FLOAT, GL_FALSE, offset);
    glVertexArrayAttribBinding(array, n, 0);
    offset += static_cast<GLuint>(sizes[n]) * static_cast<GLuint>(sizeof(float));
  }
  gl::check_gl("prepare panoramas");
}

std::size_t OverlookRenderer::bytes() const { return textures_.size() * kTexture_bytes; }

void OverlookRenderer::read(const std::vector<TextureKey>& keys) {
  std::vector<std::vector<std::uint8_t>> pixels(keys.size());
  base::parallel_for(keys.size(), options_.threads, [&](std::size_t n) {
    pixels[n] = texture_pixels(image_, grids_[static_cast<std::size_t>(keys[n].level)], keys[n]);
  });
  for (std::size_t n = 0; n < keys.size(); ++n) {
    Texture texture{gl::Texture2D::make(), views_};
    const GLuint name = texture.name.name();
    glTextureStorage2D(name, 1, GL_RGBA8, kBorderedSide_px, kBorderedSide_px);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(name, 0, 0, 0, kBorderedSide_px, kBorderedSide_px, GL_RGBA, GL_UNSIGNED_BYTE,
                        pixels[n].data());
    textures_.insert_or_assign(keys[n], std::move(texture));
    ++reads_;
  }
  gl::check_gl("store the textures of a panorama");
}

void OverlookRenderer::upload(const std::vector<Part>& parts, const core::View& view) {
  const ClipMap clip(view);
  vertex_data_.clear();
  index_data_.clear();
  first_index_.clear();
  for (const Part& part : parts) {
    first_index_.push_back(index_data_.size());
    const auto first = static_cast<std::uint32_t>(vertex_data_.size() / kFloatsPerVertex);
    const Rectangle& r = part.rectangle;
    for (int row = 0; row <= part.cuts.down; ++row) {
      const double y = std::lerp(r.top, r.bottom, static_cast<double>(row) / part.cuts.down);
      for (int column = 0; column <= part.cuts.across; ++column) {
        const double x = std::lerp(r.left, r.right, static_cast<double>(column) / part.cuts.across);
        const glm::dvec3 corner = clip(direction_vector(map_, part.facet, x, y));
        for (const double value : {corner.x, corner.y, corner.z, x - r.left, y - r.top})
          vertex_data_.push_back(static_cast<float>(value));
      }
    }
    const auto stride = static_cast<std::uint32_t>(part.cuts.across) + 1;
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(part.cuts.down); ++row) {
      for (std::uint32_t column = 0; column + 1 < stride; ++column) {
        const std::uint32_t corner = first + row * stride + column;
        index_data_.insert(index_data_.end(), {corner, corner + stride, corner + 1, corner + 1, corner + stride,
                                               corner + stride + 1});
      }
    }
  }
  first_index_.push_back(index_data_.size());
  glNamedBufferData(vertices_.name(), static_cast<GLsizeiptr>(vertex_data_.size() * sizeof(float)),
                    vertex_data_.data(), GL_STREAM_DRAW);
  glNamedBufferData(indices_.name(), static_cast<GLsizeiptr>(index_data_.size() * sizeof(std::uint32_t)),
                    index_data_.data(), GL_STREAM_DRAW);
}

// Returns the program for parts of so many levels and samples.
const gl::Program& OverlookRenderer::filtered(std::size_t levels, int samples) {
  gl::Program& program = filtered_[{levels, samples}];
  if (program.name() != 0) return program;
  std::string text(shader_text::kFilteredFragment);
  const std::size_t after = text.find('\n', text.find("#version")) + 1;
  text.insert(after, "#define kLevels " + std::to_string(levels) + "\n#define kSamples " +
                         std::to_string(samples) + "\n");
  program = make_overlook_program("panorama", text);
  return program;
}

void OverlookRenderer::draw_part(const Part& part, std::size_t first_index, std::size_t indices) {
  std::array<GLfloat, 4 * Part::kMostLevels> place{};
  std::array<GLfloat, Part::kMostLevels> reduction;
  reduction.fill(1);  // of levels that are not there
  for (std::size_t n = 0; n < part.textures.size(); ++n) {
    const TextureKey& key = part.textures[n];
    const panorama::LevelGrid& grid = grids_[static_cast<std::size_t>(key.level)];
    const glm::dvec2 begin(static_cast<double>(grid.left + key.column * kTextureSide_px - 1),
                           static_cast<double>(grid.top + key.row * kTextureSide_px - 1));
    const glm::dvec2 corner =
        (glm::dvec2(part.rectangle.left, part.rectangle.top) + grid.origin_px) * grid.scale - begin;
    const std::array<double, 4> values{grid.scale.x, grid.scale.y, corner.x, corner.y};
    for (std::size_t k = 0; k < 4; ++k) place[4 * n + k] = static_cast<GLfloat>(values[k] / kBorderedSide_px);
    reduction[n] = static_cast<GLfloat>(grid.reduction);
    glBindTextureUnit(static_cast<GLuint>(n), textures_.at(key).name.name());
  }
  const GLuint program =
      part.is_enlarged ? enlarged_.name() : filtered(part.textures.size(), part.most_samples).name();
  glUseProgram(program);
  glUniform4fv(kPlaceLocation, static_cast<GLsizei>(Part::kMostLevels), place.data());
  if (!part.is_enlarged) {
    glUniform4fv(kReductionLocation, 1, reduction.data());
    std::array<GLfloat, Part::kMostLevels> per_octave{};
    for (std::size_t n = 0; n + 1 < part.textures.size(); ++n)
      per_octave[n] = 1 / std::log2(reduction[n + 1] / reduction[n]);
    glUniform4fv(kPerOctaveLocation, 1, per_octave.data());
  }
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(first_index * sizeof(std::uint32_t)));
}

void OverlookRenderer::evict() {
  while (bytes() > options_.budget_bytes) {
    const auto oldest = std::min_element(textures_.begin(), textures_.end(), [](const auto& a, const auto& b) {
      return a.second.used < b.second.used;
    });
    if (oldest->second.used == views_) return;
    textures_.erase(oldest);
  }
}

OverlookRenderer::Drawn OverlookRenderer::draw(const core::View& view, int most_new) {
  if (const std::string trouble = core::check(view); !trouble.empty()) throw std::invalid_argument(trouble);
  if (view.projection != core::Projection::kPerspective)
    throw std::invalid_argument("a panorama is drawn by OpenGL in perspective views only");
  ++views_;
  Drawn drawn;
  std::set<TextureKey> wanted;
  const auto is_ready = [&](const TextureKey& key) {
    if (textures_.contains(key) || wanted.contains(key)) return true;
    if (static_cast<std::int64_t>(wanted.size()) >= most_new) {
      drawn.is_complete = false;
      return false;
    }
    wanted.insert(key);
    return true;
  };
  const std::vector<Part> parts = choose_parts(map_, grids_, view, options_.parts, is_ready);
  std::set<TextureKey> missing;
  for (const Part& part : parts) {
    for (const TextureKey& key : part.textures) {
      const auto at = textures_.find(key);
      if (at == textures_.end()) {
        missing.insert(key);
      } else {
        at->second.used = views_;
      }
    }
  }
  read({missing.begin(), missing.end()});
  upload(parts, view);

  const glm::ivec2 size = core::drawn_size(view);
  if (!target_ || target_->width() != size.x || target_->height() != size.y) target_.emplace(size.x, size.y, 1);
  target_->bind();
  const auto share = [](std::uint8_t value) { return static_cast<GLfloat>(value) / 255.0F; };
  glClearColor(share(options_.outside.r), share(options_.outside.g), share(options_.outside.b), 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  for (const GLenum state : {GL_DEPTH_TEST, GL_CULL_FACE, GL_BLEND, GL_SCISSOR_TEST}) glDisable(state);
  glBindVertexArray(array_.name());
  for (std::size_t n = 0; n < parts.size(); ++n)
    draw_part(parts[n], first_index_[n], first_index_[n + 1] - first_index_[n]);
  gl::check_gl("draw a panorama");
  drawn.image.width = size.x;
  drawn.image.height = size.y;
  target_->read_colour(drawn.image.pixels);
  evict();
  return drawn;
}

}  // namespace vpe::overlook
