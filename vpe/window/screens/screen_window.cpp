#include "vpe/window/screens/screen_window.h"

#include <epoxy/gl.h>
// After epoxy, which replaces OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <span>
#include <variant>

#include "vpe/base/quote.h"
#include "vpe/window/ui/display.h"

namespace vpe::window {

namespace {

// Makes a context current during its life.
class CurrentContext {
 public:
  explicit CurrentContext(GLFWwindow* window) : former_(glfwGetCurrentContext()) {
    glfwMakeContextCurrent(window);
  }
  ~CurrentContext() { glfwMakeContextCurrent(former_); }
  CurrentContext(const CurrentContext&) = delete;
  CurrentContext& operator=(const CurrentContext&) = delete;

 private:
  GLFWwindow* former_;
};

std::string name_of(GLFWmonitor* monitor) {
  const char* name = glfwGetMonitorName(monitor);
  return name == nullptr ? "" : name;
}

std::string monitors_text(std::span<GLFWmonitor* const> monitors) {
  std::string all;
  for (std::size_t n = 0; n < monitors.size(); ++n) {
    const GLFWvidmode* mode = glfwGetVideoMode(monitors[n]);
    all += (n == 0 ? "" : ", ") + std::to_string(n + 1) + " " + base::quote_text(name_of(monitors[n]));
    if (mode != nullptr) all += " " + std::to_string(mode->width) + "x" + std::to_string(mode->height);
  }
  return all.empty() ? "none" : all;
}

// Returns null for a window at a position.
GLFWmonitor* monitor_of(const explore::PlacedScreen& screen) {
  if (std::holds_alternative<glm::ivec2>(screen.window)) return nullptr;
  int count = 0;
  GLFWmonitor** all = glfwGetMonitors(&count);
  const std::span<GLFWmonitor* const> monitors(all, static_cast<std::size_t>(count));
  std::string wanted;
  if (const auto* number = std::get_if<explore::MonitorNumber>(&screen.window)) {
    if (number->number <= count) return monitors[static_cast<std::size_t>(number->number - 1)];
    wanted = std::to_string(number->number);
  } else {
    const std::string& name = std::get<explore::MonitorName>(screen.window).name;
    const auto found =
        std::ranges::find_if(monitors, [&name](GLFWmonitor* one) { return name_of(one) == name; });
    if (found != monitors.end()) return *found;
    wanted = base::quote_text(name);
  }
  throw DisplayError("cannot open the window of screen " + base::quote_text(screen.name) +
                     ": there is no monitor " + wanted + "; monitors are: " + monitors_text(monitors) +
                     "; change `monitor` in the file of screens, or take window = [x, y]");
}

GLFWwindow* open_window(const explore::ScreenSet::Entry& entry, GLFWmonitor* monitor, bool pairs) {
  glfwDefaultWindowHints();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_DECORATED, GLFW_FALSE);
  glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUSED, GLFW_FALSE);
  glfwWindowHint(GLFW_FOCUS_ON_SHOW, GLFW_FALSE);
  glfwWindowHint(GLFW_AUTO_ICONIFY, GLFW_FALSE);
  glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
  glfwWindowHint(GLFW_STEREO, pairs ? GLFW_TRUE : GLFW_FALSE);
  glm::ivec2 size = entry.window_px;
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode != nullptr) {
    size = {mode->width, mode->height};
    glfwWindowHint(GLFW_REFRESH_RATE, mode->refreshRate);
  }
  GLFWwindow* window =
      glfwCreateWindow(size.x, size.y, ("vpe - " + entry.screen.name).c_str(), monitor, nullptr);
  glfwDefaultWindowHints();
  return window;
}

}  // namespace

ScreenWindow::ScreenWindow(const explore::ScreenSet::Entry& entry, bool waits_for_display) {
  GLFWmonitor* monitor = monitor_of(entry.screen);
  if (entry.screen.eye == explore::ScreenEye::kBoth) {
    window_ = open_window(entry, monitor, true);
    has_pairs_ = window_ != nullptr;
  }
  if (window_ == nullptr) window_ = open_window(entry, monitor, false);
  if (window_ == nullptr) {
    const char* words = nullptr;
    glfwGetError(&words);
    throw DisplayError("cannot open the window of screen " + base::quote_text(entry.screen.name) + ": " +
                       (words == nullptr ? "GLFW says nothing" : words) +
                       "; it needs OpenGL 3.3, as the window of the session does");
  }
  if (const auto* place = std::get_if<glm::ivec2>(&entry.screen.window))
    glfwSetWindowPos(window_, place->x, place->y);
  glfwSetWindowUserPointer(window_, &is_damaged_);
  glfwSetWindowRefreshCallback(
      window_, [](GLFWwindow* window) { *static_cast<bool*>(glfwGetWindowUserPointer(window)) = true; });
  const CurrentContext current(window_);
  glfwSwapInterval(waits_for_display ? 1 : 0);
  layers_.resize(has_pairs_ ? 2 : 1);
  for (Layer& one : layers_) {
    glGenTextures(1, &one.texture);
    glGenFramebuffers(1, &one.framebuffer);
  }
  glfwShowWindow(window_);
  if (const auto* place = std::get_if<glm::ivec2>(&entry.screen.window))
    glfwSetWindowPos(window_, place->x, place->y);
}

// The context goes with the window, and what is in it.
ScreenWindow::~ScreenWindow() { glfwDestroyWindow(window_); }

void ScreenWindow::upload(int side, const core::RgbImage& image) {
  const CurrentContext current(window_);
  Layer& one = layer(side);
  if (image.pixels.empty()) {
    one.width = one.height = 0;
    return;
  }
  glBindTexture(GL_TEXTURE_2D, one.texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  const void* pixels = &image.pixels.data()->r;
  if (one.width == image.width && one.height == image.height) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, pixels);
    return;
  }
  one.width = image.width;
  one.height = image.height;
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGB, GL_UNSIGNED_BYTE, pixels);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, one.framebuffer);
  glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, one.texture, 0);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

void ScreenWindow::draw() {
  const CurrentContext current(window_);
  is_damaged_ = false;
  int width = 0;
  int height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  for (std::size_t n = 0; n < layers_.size(); ++n) {
    const Layer& one = layers_[n];
    if (has_pairs_) glDrawBuffer(n == 0 ? GL_BACK_LEFT : GL_BACK_RIGHT);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (one.width == 0) continue;
    // Row 0 of an image is its top, that of a window its bottom.
    glBindFramebuffer(GL_READ_FRAMEBUFFER, one.framebuffer);
    glBlitFramebuffer(0, 0, one.width, one.height, 0, height, width, 0, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  }
}

void ScreenWindow::swap() { glfwSwapBuffers(window_); }

void ScreenWindow::follow_close() {
  if (glfwWindowShouldClose(window_) != GLFW_TRUE) return;
  glfwHideWindow(window_);
  glfwSetWindowShouldClose(window_, GLFW_FALSE);
}

core::RgbImage ScreenWindow::read_back() {
  const CurrentContext current(window_);
  core::RgbImage image;
  glfwGetFramebufferSize(window_, &image.width, &image.height);
  const auto row = static_cast<std::ptrdiff_t>(image.width);
  image.pixels.resize(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  draw();
  glfwMakeContextCurrent(window_);
  glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  for (std::ptrdiff_t y = 0; y < image.height / 2; ++y) {
    const auto upper = image.pixels.begin() + y * row;
    std::swap_ranges(upper, upper + row, image.pixels.begin() + (image.height - 1 - y) * row);
  }
  return image;
}

}  // namespace vpe::window
