#include "vpe/gl/context.h"

#include <utility>

#include "vpe/gl/opengl.h"

namespace vpe::gl {

namespace {

std::string gl_text(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text == nullptr ? std::string() : std::string(reinterpret_cast<const char*>(text));
}

// Is current because a window's library made it so.
class AdoptedContext : public Context {
 public:
  explicit AdoptedContext(std::function<void()> release) : release_(std::move(release)) {
#ifdef VPE_OSMESA
    fail("this program was built with OSMesa");
#else
    constexpr int kVersion = 45;
    if (epoxy_gl_version() < kVersion) fail("the window has OpenGL " + std::to_string(epoxy_gl_version()));
    read_info("window");
#endif
  }
  ~AdoptedContext() override { release_(); }

 private:
  [[noreturn]] void fail(const std::string& why) {
    release_();
    throw ContextError("cannot draw in the window's context: " + why);
  }

  std::function<void()> release_;
};

}  // namespace

std::unique_ptr<Context> Context::adopt(std::function<void()> release) {
  return std::make_unique<AdoptedContext>(std::move(release));
}

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
