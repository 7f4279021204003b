#include "vpe/window/shared_images.h"

#include <epoxy/gl.h>
// After epoxy, which replaces OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <stdexcept>

#include "vpe/overlay/overlay.h"
#include "vpe/window/ui/driver_lock.h"

namespace vpe::window {

std::string why_pixels(const ImageRequest& drawn, bool is_recording) {
  const core::SettingsValues& settings = drawn.draw.settings;
  if (drawn.backend != core::Backend::kPolygon) return "rays draw on the CPU";
  if (drawn.stereo) return "two eyes are put together on the CPU";
  if (drawn.with_earlier) return "two planets are drawn";
  if (drawn.keeps_ranges) return "pixels are carried";
  if (drawn.draw.want_range) return "ranges are wanted";
  if (!settings.scene.empty()) return "objects are drawn on the CPU";
  if (overlay::any(settings)) return "overlays are drawn on the CPU";
  if (is_recording) return "the session is recorded";
  return "";
}

// GLFW has no contexts without a window.
class SharedImages::HiddenWindow : public DrawContext {
 public:
  // Throws std::runtime_error.
  explicit HiddenWindow(const Display& display) {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    window_ = glfwCreateWindow(1, 1, "vpe", nullptr, display.handle());
    glfwDefaultWindowHints();
    if (window_ != nullptr) return;
    const char* message = nullptr;
    glfwGetError(&message);
    throw std::runtime_error(message == nullptr ? "no reason given" : message);
  }
  ~HiddenWindow() override { glfwDestroyWindow(window_); }

  void make_current() override {
    glfwMakeContextCurrent(window_);
    if (glfwGetCurrentContext() != window_) throw std::runtime_error("the window's context cannot be used");
  }
  void release() override { glfwMakeContextCurrent(nullptr); }

 private:
  GLFWwindow* window_ = nullptr;
};

SharedImages::SharedImages(const Display& display, explore::DrawContextChoice choice, bool has_gpu)
    : needs_gpu_(choice == explore::DrawContextChoice::kAuto) {
  if (choice == explore::DrawContextChoice::kOwn) {
    why_not_ = "draw.context=own";
  } else if (needs_gpu_ && !has_gpu) {
    why_not_ = "there is no GPU";
  } else {
    try {
      context_ = std::make_unique<HiddenWindow>(display);
      DriverLock::keep_apart(!has_gpu);
    } catch (const std::runtime_error& e) {
      why_not_ = e.what();
    }
  }
}

SharedImages::~SharedImages() {
  DriverLock::keep_apart(false);
  if (unused_ != nullptr) glDeleteSync(static_cast<GLsync>(unused_));
}

void SharedImages::place(ImageRequest& request, const ImageRequest& drawn, bool is_recording) {
  request.place = {};
  if (!context_) return;
  request.place.context = context_.get();
  request.place.needs_gpu = needs_gpu_;
  if (!why_pixels(drawn, is_recording).empty()) return;
  request.place.texture = textures_[next_].name();
  const DriverLock lock;
  // The painter has passed the former one, since no request is under way.
  if (unused_ != nullptr) glDeleteSync(static_cast<GLsync>(unused_));
  unused_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  glFlush();
  request.place.unused = unused_;
}

bool SharedImages::take(const DrawnImage& drawn) {
  is_shown_ = drawn.is_in_texture;
  if (!is_shown_) return false;
  if (drawn.drawn != nullptr) {
    const DriverLock lock;
    glWaitSync(static_cast<GLsync>(drawn.drawn), 0, GL_TIMEOUT_IGNORED);
  }
  textures_[next_].set_stored(drawn.image.width, drawn.image.height);
  next_ = 1 - next_;
  ++count_;
  return true;
}

const Texture* SharedImages::shown() const { return is_shown_ ? &textures_[1 - next_] : nullptr; }

std::size_t SharedImages::bytes() const {
  constexpr std::size_t kRgbaBytes = 4;
  std::size_t sum = 0;
  for (const Texture& t : textures_)
    sum += kRgbaBytes * static_cast<std::size_t>(t.width()) * static_cast<std::size_t>(t.height());
  return sum;
}

}  // namespace vpe::window
