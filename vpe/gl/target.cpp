#include "vpe/gl/target.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

#include "vpe/gl/shader_texts.h"

namespace vpe::gl {

namespace {

void check_complete(const Framebuffer& framebuffer) {
  const GLenum status = glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE) {
    throw std::runtime_error("OpenGL: framebuffer is not complete (" + std::to_string(status) + ")");
  }
}

constexpr std::size_t kRgbaBytes = 4;

// Each pixel is written with the alpha that follows it, which the next one covers.
void drop_alpha(const std::uint8_t* rgba, std::size_t count, base::Rgb* out) {
  static_assert(sizeof(base::Rgb) == 3);
  auto* to = reinterpret_cast<std::uint8_t*>(out);
  for (std::size_t x = 0; x + 1 < count; ++x) std::memcpy(to + 3 * x, rgba + kRgbaBytes * x, kRgbaBytes);
  std::memcpy(to + 3 * (count - 1), rgba + kRgbaBytes * (count - 1), 3);
}

template <typename T>
void flip_rows(std::vector<T>& pixels, int width, int height) {
  const auto row = static_cast<std::ptrdiff_t>(width);
  for (int y = 0; y < height / 2; ++y) {
    const auto top = pixels.begin() + row * y;
    std::swap_ranges(top, top + row, pixels.begin() + row * (height - 1 - y));
  }
}

}  // namespace

Target::Target(int width, int height, int samples) : width_(width), height_(height), samples_(samples) {
  GLint max_size = 0;
  GLint max_samples = 0;
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &max_size);
  glGetIntegerv(GL_MAX_SAMPLES, &max_samples);
  if (width < 1 || height < 1 || width > max_size || height > max_size) {
    throw std::runtime_error("OpenGL: an image of " + std::to_string(width) + "x" + std::to_string(height) +
                             " is too large here (at most " + std::to_string(max_size) + " a side)");
  }
  if (samples > max_samples) {
    throw std::runtime_error("OpenGL: " + std::to_string(samples) +
                             " samples a pixel are not available here (at most " + std::to_string(max_samples) +
                             "); lower 'samples'");
  }
  draw_ = Framebuffer::make();
  colour_ = Renderbuffer::make();
  depth_ = Renderbuffer::make();
  const GLsizei many = samples > 1 ? samples : 0;
  glNamedRenderbufferStorageMultisample(colour_.name(), many, GL_RGBA8, width, height);
  glNamedRenderbufferStorageMultisample(depth_.name(), many, GL_DEPTH_COMPONENT32F, width, height);
  glNamedFramebufferRenderbuffer(draw_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
  glNamedFramebufferRenderbuffer(draw_.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
  check_gl("make a framebuffer");
  check_complete(draw_);
  if (samples <= 1) return;
  resolve_ = Framebuffer::make();
  resolved_colour_ = Renderbuffer::make();
  glNamedRenderbufferStorage(resolved_colour_.name(), GL_RGBA8, width, height);
  glNamedFramebufferRenderbuffer(resolve_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                 resolved_colour_.name());
  check_complete(resolve_);
}

void Target::bind() {
  glBindFramebuffer(GL_FRAMEBUFFER, draw_.name());
  glViewport(0, 0, width_, height_);
}

void Target::read_colour(std::vector<base::Rgb>& out) const {
  if (samples_ > 1) {
    glBlitNamedFramebuffer(draw_.name(), resolve_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_ > 1 ? resolve_.name() : draw_.name());
  out.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  // As they are stored: a driver without a GPU takes three times as long to leave out alpha.
  read_.resize(kRgbaBytes * out.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, read_.data());
  check_gl("read the image");
  const auto width = static_cast<std::size_t>(width_);
  const auto height = static_cast<std::size_t>(height_);
  for (std::size_t y = 0; y < height; ++y)
    drop_alpha(&read_[kRgbaBytes * width * (height - 1 - y)], width, &out[y * width]);
}

double Target::mean_alpha() const {
  std::int64_t sum = 0;
  for (std::size_t k = kRgbaBytes - 1; k < read_.size(); k += kRgbaBytes) sum += read_[k];
  return static_cast<double>(sum) / (255.0 * static_cast<double>(read_.size() / kRgbaBytes));
}

void Target::read_depth(std::vector<float>& out) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, draw_.name());
  out.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, width_, height_, GL_DEPTH_COMPONENT, GL_FLOAT, out.data());
  check_gl("read the depth");
  flip_rows(out, width_, height_);
}

void Target::copy_to(const Framebuffer& to, bool with_depth) const {
  const GLbitfield what = GL_COLOR_BUFFER_BIT | (with_depth ? GL_DEPTH_BUFFER_BIT : 0U);
  glBlitNamedFramebuffer(draw_.name(), to.name(), 0, 0, width_, height_, 0, 0, width_, height_, what,
                         GL_NEAREST);
  check_gl("copy the image");
}

namespace {

// Uniforms of shaders/finish_fragment.glsl and shaders/corner_fragment.glsl.
constexpr GLint kSize = 0;
constexpr GLint kGamma = 1;
constexpr GLint kSmooth = 2;
constexpr GLint kCells = 1;
// Units of textures that the programs of tiles do not use.
constexpr GLuint kColours = 8;
constexpr GLuint kDepths = 9;

Program full_image_program(const std::string& label, std::string_view fragment) {
  const std::string head = "#version 450 core\n";
  return make_program(label, (head + std::string(shader_text::kFinishVertex)).c_str(),
                      (head + std::string(fragment)).c_str());
}

// Makes storage for one level, which no filter reads beyond.
Texture2D make_texture(GLenum format, glm::ivec2 size) {
  Texture2D texture = Texture2D::make();
  glTextureStorage2D(texture.name(), 1, format, size.x, size.y);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  return texture;
}

}  // namespace

TextureFinish::TextureFinish()
    : source_(Framebuffer::make()),
      out_(Framebuffer::make()),
      corners_(Framebuffer::make()),
      finish_(full_image_program("finish", shader_text::kFinishFragment)),
      corner_(full_image_program("corner depths", shader_text::kCornerFragment)),
      empty_(VertexArray::make()) {}

std::size_t TextureFinish::bytes() const {
  const auto area = [](glm::ivec2 size) {
    return static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
  };
  return area(size_) * (kRgbaBytes + sizeof(float)) + area(corner_size_) * sizeof(float);
}

void TextureFinish::resize(glm::ivec2 size) {
  if (size == size_) return;
  colour_ = make_texture(GL_RGBA8, size);
  depth_ = make_texture(GL_DEPTH_COMPONENT32F, size);
  glNamedFramebufferTexture(source_.name(), GL_COLOR_ATTACHMENT0, colour_.name(), 0);
  glNamedFramebufferTexture(source_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  check_complete(source_);
  size_ = size;
}

std::vector<float> TextureFinish::draw(const Target& image, GLuint texture, const FinishOptions& options) {
  const glm::ivec2 size(image.width(), image.height());
  resize(size);
  const bool needs_depth = options.smooth || options.cells.x > 0;
  image.copy_to(source_, needs_depth);
  glBindTexture(GL_TEXTURE_2D, texture);
  glm::ivec2 has(0);
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_WIDTH, &has.x);
  glGetTexLevelParameteriv(GL_TEXTURE_2D, 0, GL_TEXTURE_HEIGHT, &has.y);
  if (has != size)
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size.x, size.y, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  // Attached anew each time: that is when changes by another context are seen.
  glNamedFramebufferTexture(out_.name(), GL_COLOR_ATTACHMENT0, texture, 0);
  check_complete(out_);
  glBindFramebuffer(GL_FRAMEBUFFER, out_.name());
  glViewport(0, 0, size.x, size.y);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(finish_.name());
  glBindVertexArray(empty_.name());
  glBindTextureUnit(kColours, colour_.name());
  glBindTextureUnit(kDepths, depth_.name());
  glUniform2i(kSize, size.x, size.y);
  glUniform1f(kGamma, static_cast<float>(1 / options.gamma));
  glUniform1i(kSmooth, options.smooth ? 1 : 0);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<float> depths;
  if (options.cells.x > 0) depths = read_corners(options.cells);
  glEnable(GL_DEPTH_TEST);
  check_gl("finish the image");
  return depths;
}

std::vector<float> TextureFinish::read_corners(glm::ivec2 cells) {
  const glm::ivec2 corners = cells + 1;
  if (corners != corner_size_) {
    corner_depth_ = make_texture(GL_R32F, corners);
    glNamedFramebufferTexture(corners_.name(), GL_COLOR_ATTACHMENT0, corner_depth_.name(), 0);
    check_complete(corners_);
    corner_size_ = corners;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, corners_.name());
  glViewport(0, 0, corners.x, corners.y);
  glUseProgram(corner_.name());
  glUniform2i(kSize, size_.x, size_.y);
  glUniform2i(kCells, cells.x, cells.y);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<float> depths(static_cast<std::size_t>(corners.x) * static_cast<std::size_t>(corners.y));
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, corners.x, corners.y, GL_RED, GL_FLOAT, depths.data());
  return depths;
}

}  // namespace vpe::gl
