#ifndef VPE_OSMESA

#include <epoxy/egl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "vpe/gl/context.h"

namespace vpe::gl {

namespace {

// Not in the eglext.h of Debian 12.
constexpr const char* kSoftwareDevice = "EGL_MESA_device_software";

template <typename Function>
Function load(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

std::string egl_error() {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", static_cast<unsigned>(eglGetError()));
  return text;
}

bool has_extension(const char* list, const char* name) {
  return list != nullptr && std::strstr(list, name) != nullptr;
}

class EglContext : public Context {
 public:
  // Throws ContextError with the failed call.
  EglContext(EGLDisplay display, const std::string& platform) : display_(display) {
    if (display == EGL_NO_DISPLAY) throw ContextError("no display");
    EGLint major = 0;
    EGLint minor = 0;
    if (eglInitialize(display, &major, &minor) != EGL_TRUE) throw ContextError("eglInitialize " + egl_error());
    initialized_ = true;
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) fail("no desktop OpenGL");
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                       EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0)
      fail("no configuration");
    const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                           4,
                                           EGL_CONTEXT_MINOR_VERSION,
                                           5,
                                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                           EGL_NONE};
    context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    if (context_ == EGL_NO_CONTEXT) fail("no OpenGL 4.5 context: " + egl_error());
    if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      fail("eglMakeCurrent " + egl_error());
    }
    read_info(platform);
  }

  ~EglContext() override { release(); }

 private:
  [[noreturn]] void fail(const std::string& why) {
    release();
    throw ContextError(why);
  }

  void release() {
    if (!initialized_) return;
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
    eglTerminate(display_);
    initialized_ = false;
  }

  EGLDisplay display_;
  EGLContext context_ = EGL_NO_CONTEXT;
  bool initialized_ = false;
};

struct Attempt {
  std::string name;
  EGLenum platform;
  void* native;
};

struct Device {
  int number = 0;
  EGLDeviceEXT handle = nullptr;
  bool is_software = false;
};

std::vector<Device> devices(const char* client) {
  std::vector<Device> found;
  if (!has_extension(client, "EGL_EXT_platform_device")) return found;
  const auto query_devices = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  const auto query_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
  std::array<EGLDeviceEXT, 32> handles{};
  EGLint count = 0;
  if (query_devices == nullptr || query_string == nullptr ||
      query_devices(static_cast<EGLint>(handles.size()), handles.data(), &count) != EGL_TRUE)
    return found;
  for (EGLint d = 0; d < count; ++d) {
    EGLDeviceEXT handle = handles[static_cast<std::size_t>(d)];
    found.push_back({d, handle, has_extension(query_string(handle, EGL_EXTENSIONS), kSoftwareDevice)});
  }
  return found;
}

std::vector<Attempt> attempts() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const char* choice = std::getenv("VPE_EGL");
  const bool want_device = choice == nullptr || std::strcmp(choice, "device") == 0;
  const bool want_surfaceless = choice == nullptr || std::strcmp(choice, "surfaceless") == 0;

  std::vector<Attempt> hardware;
  std::vector<Attempt> software;
  if (want_device) {
    for (const Device& device : devices(client)) {
      (device.is_software ? software : hardware)
          .push_back({"EGL device " + std::to_string(device.number), EGL_PLATFORM_DEVICE_EXT, device.handle});
    }
  }
  std::vector<Attempt> all = std::move(hardware);
  if (want_surfaceless && has_extension(client, "EGL_MESA_platform_surfaceless")) {
    all.push_back(
        {"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY)});
  }
  all.insert(all.end(), software.begin(), software.end());
  return all;
}

}  // namespace

bool has_gpu() {
  const std::vector<Device> all = devices(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS));
  return std::any_of(all.begin(), all.end(), [](const Device& device) { return !device.is_software; });
}

std::unique_ptr<Context> Context::create() {
  const auto platform_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  std::string tried;
  if (platform_display != nullptr) {
    for (const Attempt& attempt : attempts()) {
      try {
        return std::make_unique<EglContext>(platform_display(attempt.platform, attempt.native, nullptr),
                                            attempt.name);
      } catch (const ContextError& e) {
        tried += "; " + attempt.name + ": " + e.what();
      }
    }
  }
  throw ContextError("cannot make an OpenGL 4.5 context through EGL" +
                     (tried.empty() ? "; no EGL platform found" : tried) +
                     "; install libegl1 and libgl1-mesa-dri (software) or the GPU's driver");
}

}  // namespace vpe::gl

#endif
