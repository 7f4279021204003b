#include "tests/window/robot.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
// After the system's: X names many things.
#include <X11/Xlib.h>
#include <X11/extensions/XTest.h>
#include <X11/extensions/Xfixes.h>
#include <X11/keysym.h>

#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace vpe::window {

Screen::Screen(int width, int height) {
  int ends[2];
  if (pipe(ends) != 0) {
    why_not_ = "no pipe";
    return;
  }
  const std::string size = std::to_string(width) + "x" + std::to_string(height) + "x24";
  const std::string number = std::to_string(ends[1]);
  process_ = fork();
  if (process_ == 0) {
    close(ends[0]);
    prctl(PR_SET_PDEATHSIG, SIGTERM);  // a test that is aborted must leave no server
    const int nowhere = open("/dev/null", O_WRONLY);
    dup2(nowhere, 2);
    execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", size.c_str(), "-nolisten", "tcp",
           static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  std::string display;
  char c = 0;
  while (read(ends[0], &c, 1) == 1 && c != '\n') display += c;
  close(ends[0]);
  if (display.empty()) {
    why_not_ = "Xvfb did not start; it is in the package xvfb";
    return;
  }
  setenv("DISPLAY", (":" + display).c_str(), 1);
}

Screen::~Screen() {
  if (process_ > 0) {
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
  }
  unsetenv("DISPLAY");
}

struct Robot::Connection {
  Display* display = nullptr;
};

Robot::Robot() : connection_(std::make_unique<Connection>()) {
  connection_->display = XOpenDisplay(nullptr);
  if (connection_->display == nullptr) throw std::runtime_error("no X server to move a mouse on");
}

Robot::~Robot() { XCloseDisplay(connection_->display); }

void Robot::move(double x, double y) {
  XTestFakeMotionEvent(connection_->display, -1, static_cast<int>(std::lround(x)),
                       static_cast<int>(std::lround(y)), 0);
  XSync(connection_->display, False);
}

void Robot::move_by(int dx, int dy) {
  XTestFakeRelativeMotionEvent(connection_->display, dx, dy, 0);
  XSync(connection_->display, False);
}

void Robot::press(int button) {
  XTestFakeButtonEvent(connection_->display, static_cast<unsigned>(button), True, 0);
  XSync(connection_->display, False);
}

void Robot::release(int button) {
  XTestFakeButtonEvent(connection_->display, static_cast<unsigned>(button), False, 0);
  XSync(connection_->display, False);
}

void Robot::wheel(int notches) {
  constexpr int kAway = 4;
  constexpr int kBack = 5;
  for (int n = 0; n < std::abs(notches); ++n) {
    press(notches > 0 ? kAway : kBack);
    release(notches > 0 ? kAway : kBack);
  }
}

void Robot::key_down(const std::string& name) {
  const KeyCode code = XKeysymToKeycode(connection_->display, XStringToKeysym(name.c_str()));
  if (code == 0) throw std::runtime_error("no key is called " + name);
  XTestFakeKeyEvent(connection_->display, code, True, 0);
  XSync(connection_->display, False);
}

void Robot::key_up(const std::string& name) {
  XTestFakeKeyEvent(connection_->display, XKeysymToKeycode(connection_->display, XStringToKeysym(name.c_str())),
                    False, 0);
  XSync(connection_->display, False);
}

void Robot::key(const std::string& name) {
  key_down(name);
  key_up(name);
}

void Robot::take_focus() {
  XSetInputFocus(connection_->display, DefaultRootWindow(connection_->display), RevertToNone, CurrentTime);
  XSync(connection_->display, False);
}

std::vector<std::uint32_t> Robot::cursor() const {
  XFixesCursorImage* image = XFixesGetCursorImage(connection_->display);
  if (image == nullptr) throw std::runtime_error("the X server does not tell its cursor");
  const std::size_t count = std::size_t{image->width} * image->height;
  std::vector<std::uint32_t> pixels;
  for (std::size_t n = 0; n < count; ++n) pixels.push_back(static_cast<std::uint32_t>(image->pixels[n]));
  XFree(image);
  return pixels;
}

}  // namespace vpe::window
