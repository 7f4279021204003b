#include "vpe/gl/context.h"

#include "vpe/gl/opengl.h"

namespace vpe::gl {

namespace {

std::string gl_text(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

}  // namespace

void Context::read_info(std::string platform) {
  info_.vendor = gl_text(GL_VENDOR);
  info_.renderer = gl_text(GL_RENDERER);
  info_.version = gl_text(GL_VERSION);
  info_.platform = std::move(platform);
  for (const char* name : {"llvmpipe", "softpipe", "swrast", "SWR"}) {
    if (info_.renderer.find(name) != std::string::npos) info_.software = true;
  }
}

}  // namespace vpe::gl
