#include "vpe/gl/target.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>

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

}  // namespace vpe::gl
