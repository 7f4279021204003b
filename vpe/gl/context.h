// An OpenGL 4.5 core context without a window.
#pragma once

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

namespace vpe::gl {

// Reports that there is no usable OpenGL. what() lists the attempts and the reason why each failed.
class ContextError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ContextInfo {
  std::string vendor;
  std::string renderer;
  std::string version;
  std::string platform;   // "EGL device", "EGL surfaceless", "OSMesa" or "window"
  bool software = false;  // no GPU: llvmpipe, softpipe, ...
};

// Returns true if there is a device for OpenGL other than a program on the CPU. Takes a millisecond. Makes no
// context, so that the device may turn out not to be usable. Always false with OSMesa.
bool has_gpu();

// Owns an OpenGL context. It is current on the thread that made it for as long as it lives; a thread may have
// one at a time. Needs no display server and no root.
//
// Typical usage:
//
//   const std::shared_ptr<Context> context = Context::create();
//   const auto renderer = make_polygon_renderer(context, planet);
class Context {
 public:
  // Makes a context. Prefers hardware EGL devices, then Mesa's surfaceless platform, then software devices;
  // $VPE_EGL = device | surfaceless restricts the choice. Throws ContextError.
  static std::unique_ptr<Context> create();
  // Takes over the context of a window, which is current on this thread. `release` ends that: it is called on this thread
  // when the context is destroyed, and before an error. Throws ContextError where it has no OpenGL 4.5, and always in
  // builds with OSMesa.
  static std::unique_ptr<Context> adopt(std::function<void()> release);
  virtual ~Context() = default;

  const ContextInfo& info() const { return info_; }

 protected:
  // Fills in info() from the current context.
  void read_info(std::string platform);

 private:
  ContextInfo info_;
};

}  // namespace vpe::gl
