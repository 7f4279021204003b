#include "vpe/gl/target.h"

#include <algorithm>
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
    throw std::runtime_error("OpenGL: a picture of " + std::to_string(width) + "x" + std::to_string(height) +
                             " is too large here (at most " + std::to_string(max_size) + " a side)");
  }
  if (samples > max_samples) {
    throw std::runtime_error("OpenGL: " + std::to_string(samples) + " samples a pixel are not available here (at most " +
                             std::to_string(max_samples) + "); lower 'samples'");
  }
  draw_ = Framebuffer::make();
  if (samples > 1) {
    many_colour_ = Renderbuffer::make();
    many_depth_ = Renderbuffer::make();
    glNamedRenderbufferStorageMultisample(many_colour_.name(), samples, GL_RGBA8, width, height);
    glNamedRenderbufferStorageMultisample(many_depth_.name(), samples, GL_DEPTH_COMPONENT32F, width, height);
    glNamedFramebufferRenderbuffer(draw_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, many_colour_.name());
    glNamedFramebufferRenderbuffer(draw_.name(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, many_depth_.name());
  } else {
    colour_ = Texture2D::make();
    depth_ = Texture2D::make();
    glTextureStorage2D(colour_.name(), 1, GL_RGBA8, width, height);
    glTextureStorage2D(depth_.name(), 1, GL_DEPTH_COMPONENT32F, width, height);
    glTextureParameteri(colour_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(colour_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(colour_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(depth_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(depth_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glNamedFramebufferTexture(draw_.name(), GL_COLOR_ATTACHMENT0, colour_.name(), 0);
    glNamedFramebufferTexture(draw_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
  }
  check_gl("make a framebuffer");
  check_complete(draw_);
  resolve_ = Framebuffer::make();
  resolved_colour_ = Renderbuffer::make();
  glNamedRenderbufferStorage(resolved_colour_.name(), GL_RGBA8, width, height);
  glNamedFramebufferRenderbuffer(resolve_.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_colour_.name());
  check_complete(resolve_);
}

void Target::bind() {
  filtered_ = false;
  glBindFramebuffer(GL_FRAMEBUFFER, draw_.name());
  glViewport(0, 0, width_, height_);
}

void Target::filter(const Program& program, const VertexArray& empty) {
  glBindFramebuffer(GL_FRAMEBUFFER, resolve_.name());
  glUseProgram(program.name());
  glBindVertexArray(empty.name());
  glBindTextureUnit(0, colour_.name());
  glBindTextureUnit(1, depth_.name());
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  filtered_ = true;
}

void Target::read_colour(std::vector<mars::Rgb>& out) const {
  if (samples_ > 1) {
    glBlitNamedFramebuffer(draw_.name(), resolve_.name(), 0, 0, width_, height_, 0, 0, width_, height_,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, samples_ > 1 || filtered_ ? resolve_.name() : draw_.name());
  out.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  static_assert(sizeof(mars::Rgb) == 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width_, height_, GL_RGB, GL_UNSIGNED_BYTE, out.data());
  check_gl("read the picture");
  flip_rows(out, width_, height_);
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
