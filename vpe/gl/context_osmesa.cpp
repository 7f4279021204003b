#ifdef VPE_OSMESA

#include <array>
#include <vector>

#include "vpe/gl/context.h"
#include "vpe/gl/opengl.h"

namespace vpe::gl {

namespace {

class MesaContext : public Context {
 public:
  MesaContext() {
    const std::array<int, 11> attributes{OSMESA_FORMAT,
                                         OSMESA_RGBA,
                                         OSMESA_DEPTH_BITS,
                                         24,
                                         OSMESA_PROFILE,
                                         OSMESA_CORE_PROFILE,
                                         OSMESA_CONTEXT_MAJOR_VERSION,
                                         4,
                                         OSMESA_CONTEXT_MINOR_VERSION,
                                         5,
                                         0};
    context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    if (context_ == nullptr) throw ContextError("OSMesa: cannot make an OpenGL 4.5 context");
    // Everything is drawn into framebuffer objects, but OSMesa needs some memory of its own.
    if (OSMesaMakeCurrent(context_, dummy_.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) {
      OSMesaDestroyContext(context_);
      throw ContextError("OSMesa: OSMesaMakeCurrent failed");
    }
    read_info("OSMesa");
  }
  ~MesaContext() override { OSMesaDestroyContext(context_); }

 private:
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4> dummy_{};
};

}  // namespace

bool has_gpu() { return false; }

std::unique_ptr<Context> Context::create() { return std::make_unique<MesaContext>(); }

}  // namespace vpe::gl

#endif
