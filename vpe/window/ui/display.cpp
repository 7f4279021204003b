#include "vpe/window/ui/display.h"

#include <dlfcn.h>
#include <epoxy/gl.h>
// After epoxy, which replaces OpenGL's own headers.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "vpe/window/ui/driver_lock.h"
#include "vpe/window/ui/hand_cursor.h"

namespace vpe::window {

struct Display::State {
  std::function<double()> clock;
  std::vector<Event> events;
  double to_pixels = 1;  // from screen coordinates
  double x = 0;
  double y = 0;
  std::vector<int> pressed;  // keys since the last frame
  std::vector<int> held;     // keys that are down for one frame more than they were

  double now_s() const { return clock ? clock() : glfwGetTime(); }
};

namespace {

const char* const kFonts[] = {"/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
                              "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
                              "/usr/share/fonts/TTF/DejaVuSans.ttf"};
constexpr float kLetters_px = 14;

Display::State& state_of(GLFWwindow* window) {
  return *static_cast<Display::State*>(glfwGetWindowUserPointer(window));
}

void add(GLFWwindow* window, Event event) {
  Display::State& state = state_of(window);
  event.x = state.x;
  event.y = state.y;
  event.time_s = state.now_s();
  state.events.push_back(std::move(event));
}

void on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
  Event event;
  event.kind = action == GLFW_PRESS    ? Event::Kind::kKeyPress
               : action == GLFW_REPEAT ? Event::Kind::kKeyRepeat
                                       : Event::Kind::kKeyRelease;
  event.code = key;
  event.modifiers = modifiers;
  if (action == GLFW_PRESS) state_of(window).pressed.push_back(key);
  add(window, event);
}

void on_button(GLFWwindow* window, int button, int action, int modifiers) {
  Event event;
  event.kind = action == GLFW_PRESS ? Event::Kind::kPress : Event::Kind::kRelease;
  event.code = button;
  event.modifiers = modifiers;
  add(window, event);
}

void on_move(GLFWwindow* window, double x, double y) {
  Display::State& state = state_of(window);
  Event event;
  event.kind = Event::Kind::kMove;
  event.dx = x * state.to_pixels - state.x;
  event.dy = y * state.to_pixels - state.y;
  state.x = x * state.to_pixels;
  state.y = y * state.to_pixels;
  add(window, event);
}

void on_scroll(GLFWwindow* window, double, double y) {
  Event event;
  event.kind = Event::Kind::kScroll;
  event.scroll = y;
  add(window, event);
}

void on_drop(GLFWwindow* window, int count, const char** paths) {
  Event event;
  event.kind = Event::Kind::kDrop;
  for (int n = 0; n < count; ++n) event.files.emplace_back(paths[n]);
  add(window, event);
}

void on_focus(GLFWwindow* window, int has_focus) {
  if (has_focus == GLFW_TRUE) return;
  Event event;
  event.kind = Event::Kind::kFocusLost;
  add(window, event);
}

std::string last_error() {
  const char* message = nullptr;
  glfwGetError(&message);
  return message == nullptr ? "no reason given" : message;
}

void set_colours() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = 3;
  style.GrabRounding = 3;
  style.WindowBorderSize = 0;
  style.ItemSpacing = {6, 5};
  style.WindowPadding = {8, 8};
  style.ScrollbarSize = 12;
  style.Colors[ImGuiCol_WindowBg] = {0.09F, 0.095F, 0.105F, 1};
  style.Colors[ImGuiCol_PopupBg] = {0.11F, 0.115F, 0.125F, 0.98F};
  const ImVec4 accent{0.80F, 0.42F, 0.22F, 1};
  for (const int what : {ImGuiCol_CheckMark, ImGuiCol_SliderGrabActive}) style.Colors[what] = accent;
  style.Colors[ImGuiCol_SliderGrab] = {0.66F, 0.36F, 0.20F, 1};
  style.Colors[ImGuiCol_FrameBg] = {0.18F, 0.19F, 0.21F, 1};
  style.Colors[ImGuiCol_FrameBgHovered] = {0.24F, 0.25F, 0.28F, 1};
  style.Colors[ImGuiCol_FrameBgActive] = {0.30F, 0.31F, 0.34F, 1};
  style.Colors[ImGuiCol_Button] = {0.24F, 0.25F, 0.28F, 1};
  style.Colors[ImGuiCol_ButtonHovered] = {0.40F, 0.27F, 0.20F, 1};
  style.Colors[ImGuiCol_ButtonActive] = {0.60F, 0.34F, 0.20F, 1};
  style.Colors[ImGuiCol_Header] = {0.30F, 0.22F, 0.18F, 1};
  style.Colors[ImGuiCol_HeaderHovered] = {0.40F, 0.27F, 0.20F, 1};
  style.Colors[ImGuiCol_HeaderActive] = {0.50F, 0.31F, 0.20F, 1};
  style.Colors[ImGuiCol_Tab] = {0.15F, 0.155F, 0.17F, 1};
  style.Colors[ImGuiCol_TabHovered] = {0.40F, 0.27F, 0.20F, 1};
  style.Colors[ImGuiCol_TabActive] = {0.34F, 0.24F, 0.19F, 1};
}

[[noreturn]] void fail(const DisplayOptions& options) {
  const std::string why = last_error();
  glfwTerminate();
  throw DisplayError("no window can be opened: " + why + (options.instead.empty() ? "" : "; ") +
                     options.instead);
}

// Ends the program when the X server is gone. Xlib's own handler calls exit(), which destroys what the threads that draw
// still use. Nothing is lost: work that is not saved has a copy by then.
[[noreturn]] int end_without_display(void*) {
  std::fputs("vpe: the connection to the display was lost\n", stderr);
  std::_Exit(1);
}

// Xlib is not part of GLFW's interface, and absent under Wayland.
void handle_lost_display() {
  using Handler = int (*)(void*);
  using SetHandler = Handler (*)(Handler);
  const auto set_handler = reinterpret_cast<SetHandler>(dlsym(RTLD_DEFAULT, "XSetIOErrorHandler"));
  if (set_handler != nullptr) set_handler(end_without_display);
}

}  // namespace

void check_display(const DisplayOptions& options) {
  if (glfwInit() != GLFW_TRUE) fail(options);
}

Display::Display(const DisplayOptions& options) : state_(std::make_unique<State>()) {
  state_->clock = options.clock;
  if (glfwInit() != GLFW_TRUE) fail(options);
  handle_lost_display();
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, options.scales_size ? GLFW_TRUE : GLFW_FALSE);
  window_ = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
  if (window_ == nullptr) fail(options);
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, state_.get());
  glfwSetKeyCallback(window_, on_key);
  glfwSetMouseButtonCallback(window_, on_button);
  glfwSetCursorPosCallback(window_, on_move);
  glfwSetScrollCallback(window_, on_scroll);
  glfwSetDropCallback(window_, on_drop);
  glfwSetWindowFocusCallback(window_, on_focus);

  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  float x = 1;
  float y = 1;
  glfwGetWindowContentScale(window_, &x, &y);
  const double wanted = options.scale > 0 ? options.scale : static_cast<double>(std::max(x, y));
  scale_ = usual_scale_ = std::clamp(wanted, kSmallestScale, kLargestScale);
  make_fonts();
  ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the callbacks above too
  ImGui_ImplOpenGL3_Init("#version 150");
}

Display::~Display() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Display::set_scale(double scale) {
  const double next = std::clamp(scale, kSmallestScale, kLargestScale);
  if (next == scale_) return;
  scale_ = next;
  make_fonts();
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Display::make_fonts() {
  ImGui::GetStyle() = ImGuiStyle();
  set_colours();
  ImGui::GetStyle().ScaleAllSizes(static_cast<float>(scale_));
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  fonts.Clear();
  // Latin with extensions, Greek, punctuation, arrows and symbols of the panels.
  static const ImWchar kRanges[] = {0x20,   0x24f,  0x370,  0x3ff,  0x2010, 0x2044, 0x2190,
                                    0x21ff, 0x2200, 0x2265, 0x25a0, 0x25ff, 0};
  const float letters = std::round(kLetters_px * static_cast<float>(scale_));
  for (const char* file : kFonts) {
    if (std::filesystem::exists(file)) {
      fonts.AddFontFromFileTTF(file, letters, nullptr, kRanges);
      return;
    }
  }
  ImFontConfig plain;
  plain.SizePixels = letters;
  fonts.AddFontDefault(&plain);
}

void Display::framebuffer(int& width, int& height) const { glfwGetFramebufferSize(window_, &width, &height); }

std::pair<int, int> Display::size() const {
  if (is_fullscreen_) return {windowed_[2], windowed_[3]};
  int width = 0;
  int height = 0;
  glfwGetWindowSize(window_, &width, &height);
  return {width, height};
}

double Display::now_s() const { return state_->now_s(); }

bool Display::should_close() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }
void Display::close() { glfwSetWindowShouldClose(window_, GLFW_TRUE); }
void Display::set_title(const std::string& title) { glfwSetWindowTitle(window_, title.c_str()); }

void Display::set_fullscreen(bool on) {
  if (on == is_fullscreen_) return;
  is_fullscreen_ = on;
  if (!on) {
    glfwSetWindowMonitor(window_, nullptr, windowed_[0], windowed_[1], windowed_[2], windowed_[3], 0);
    return;
  }
  glfwGetWindowPos(window_, &windowed_[0], &windowed_[1]);
  glfwGetWindowSize(window_, &windowed_[2], &windowed_[3]);
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
  if (mode == nullptr) {
    is_fullscreen_ = false;
    return;
  }
  glfwSetWindowMonitor(window_, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
}

void Display::catch_cursor(bool on) {
  if (on == has_caught_cursor_) return;
  has_caught_cursor_ = on;
  double x = 0;
  double y = 0;
  int width = 1;
  int height = 1;
  glfwGetCursorPos(window_, &x, &y);
  glfwGetWindowSize(window_, &width, &height);
  // GLFW brings a cursor from beside the window into it, and tells that way as a motion.
  const bool is_beside = x < 0 || y < 0 || x >= width || y >= height;
  if (on && is_beside) glfwSetCursorPos(window_, width / 2.0, height / 2.0);
  if (glfwRawMouseMotionSupported() == GLFW_TRUE)
    glfwSetInputMode(window_, GLFW_RAW_MOUSE_MOTION, on ? GLFW_TRUE : GLFW_FALSE);
  glfwSetInputMode(window_, GLFW_CURSOR, on ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
  int& flags = ImGui::GetIO().ConfigFlags;
  flags = on ? flags | ImGuiConfigFlags_NoMouse : flags & ~ImGuiConfigFlags_NoMouse;
  glfwGetCursorPos(window_, &x, &y);
  state_->x = x * state_->to_pixels;
  state_->y = y * state_->to_pixels;
}

void Display::show_hand(bool on) {
  if (on == shows_hand_) return;
  shows_hand_ = on;
  int& flags = ImGui::GetIO().ConfigFlags;
  flags = on ? flags | ImGuiConfigFlags_NoMouseCursorChange : flags & ~ImGuiConfigFlags_NoMouseCursorChange;
  const int factor = static_cast<int>(std::lround(scale_));
  if (on && factor != hand_factor_) {
    if (hand_ != nullptr) glfwDestroyCursor(hand_);
    CursorImage hand = closed_hand(factor);
    const GLFWimage image{hand.side_px, hand.side_px, hand.rgba.data()};
    hand_ = glfwCreateCursor(&image, hand.hot_px, hand.hot_px);
    hand_factor_ = factor;
  }
  glfwSetCursor(window_, on ? hand_ : nullptr);
}

std::vector<Event> Display::events(double wait_s) {
  int window_width = 1;
  int window_height = 1;
  int width = 1;
  int height = 1;
  glfwGetWindowSize(window_, &window_width, &window_height);
  glfwGetFramebufferSize(window_, &width, &height);
  state_->to_pixels = window_width > 0 ? static_cast<double>(width) / window_width : 1.0;
  if (wait_s > 0)
    glfwWaitEventsTimeout(wait_s);
  else
    glfwPollEvents();
  return std::exchange(state_->events, {});
}

void Display::wake() { glfwPostEmptyEvent(); }

void Display::begin_frame() {
  {
    const DriverLock lock;
    ImGui_ImplOpenGL3_NewFrame();
  }
  ImGui_ImplGlfw_NewFrame();
#if IMGUI_VERSION_NUM < 18700
  // ImGui would not see a key that is pressed and released between two frames.
  bool(&down)[512] = ImGui::GetIO().KeysDown;
  for (const int key : std::exchange(state_->pressed, {})) {
    if (key < 0 || key >= 512 || down[key]) continue;
    down[key] = true;
    state_->held.push_back(key);
  }
#else
  state_->pressed.clear();
#endif
  ImGui::NewFrame();
  // Tab leads from one text to the next; elsewhere it is a key of the window.
  const ImGuiIO& io = ImGui::GetIO();
  ImGui::PushAllowKeyboardFocus(io.WantTextInput || (io.ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0);
}

bool Display::has_input_left() {
#if IMGUI_VERSION_NUM < 18700
  return false;
#else
  return ImGui::GetCurrentContext()->InputEventsQueue.Size > 0;
#endif
}

core::RgbImage Display::read_back() const {
  core::RgbImage image;
  framebuffer(image.width, image.height);
  const auto row = static_cast<std::ptrdiff_t>(image.width);
  image.pixels.resize(static_cast<std::size_t>(row) * static_cast<std::size_t>(image.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
  for (std::ptrdiff_t y = 0; y < image.height / 2; ++y) {
    const auto upper = image.pixels.begin() + y * row;
    std::swap_ranges(upper, upper + row, image.pixels.begin() + (image.height - 1 - y) * row);
  }
  return image;
}

void Display::end_frame(core::RgbImage* shown) {
  ImGui::PopAllowKeyboardFocus();
  ImGui::Render();
#if IMGUI_VERSION_NUM < 18700
  for (const int key : std::exchange(state_->held, {})) ImGui::GetIO().KeysDown[key] = false;
#endif
  int width = 0;
  int height = 0;
  framebuffer(width, height);
  const DriverLock lock;
  glViewport(0, 0, width, height);
  glClearColor(0.05F, 0.05F, 0.06F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (shown != nullptr) *shown = read_back();
  glfwSwapBuffers(window_);
}

Texture::Texture() {
  const DriverLock lock;
  glGenTextures(1, &name_);
  glBindTexture(GL_TEXTURE_2D, name_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Texture::~Texture() {
  const DriverLock lock;
  glDeleteTextures(1, &name_);
}

void Texture::upload(const core::RgbImage& image) {
  static_assert(sizeof(base::Rgb) == 3);
  upload(GL_RGB, &image.pixels.data()->r, image.width, image.height);
}

void Texture::upload_rgba(std::span<const std::uint8_t> pixels, int width, int height) {
  upload(GL_RGBA, pixels.data(), width, height);
}

void Texture::upload(unsigned format, const std::uint8_t* pixels, int width, int height) {
  const DriverLock lock;
  glBindTexture(GL_TEXTURE_2D, name_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (width == width_ && height == height_ && format == format_) {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, format, GL_UNSIGNED_BYTE, pixels);
    return;
  }
  glTexImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(format), width, height, 0, format, GL_UNSIGNED_BYTE,
               pixels);
  width_ = width;
  height_ = height;
  format_ = format;
}

void Texture::set_stored(int width, int height) {
  width_ = width;
  height_ = height;
  format_ = 0;  // an upload makes storage of its own
}

core::RgbImage Texture::read_back() const {
  core::RgbImage image;
  image.width = width_;
  image.height = height_;
  image.pixels.resize(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  if (image.pixels.empty()) return image;
  glBindTexture(GL_TEXTURE_2D, name_);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RGB, GL_UNSIGNED_BYTE, &image.pixels.data()->r);
  return image;
}

void* Texture::id() const { return reinterpret_cast<void*>(static_cast<std::uintptr_t>(name_)); }

}  // namespace vpe::window
