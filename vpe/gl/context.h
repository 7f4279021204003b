// An OpenGL 4.5 core context without a window.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

namespace vpe::gl {

// No usable OpenGL. what() lists what was tried and what each attempt said.
class ContextError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ContextInfo {
  std::string vendor;
  std::string renderer;
  std::string version;
  std::string platform;   // "EGL device", "EGL surfaceless" or "OSMesa"
  bool software = false;  // no GPU: llvmpipe, softpipe, ...
};

// Whether there is a device for OpenGL that is not a program on the CPU. A millisecond: no context is made, so
// that it may turn out not to be usable. False for OSMesa.
bool has_gpu();

// Current on the thread that made it, for as long as it lives; one at a time a thread. Hardware EGL devices
// are preferred, then Mesa's surfaceless platform, then software devices. $VPE_EGL = device | surfaceless
// restricts the choice. Needs no display server and no root.
class Context {
 public:
  static std::unique_ptr<Context> create();
  virtual ~Context() = default;
  const ContextInfo& info() const { return info_; }

 protected:
  void read_info(std::string platform);

 private:
  ContextInfo info_;
};

}  // namespace vpe::gl
