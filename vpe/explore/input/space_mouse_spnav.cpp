#include "vpe/explore/input/space_mouse.h"

#ifdef VPE_SPNAV
#include <spnav_config.h>
// Otherwise spnav.h includes the headers of X11.
#undef SPNAV_USE_X11
#include <spnav.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <system_error>
#endif

namespace vpe::explore {

#ifdef VPE_SPNAV

namespace {

constexpr std::size_t kEventBytes = 32;  // on the wire
constexpr int kMaxPerPoll = 1024;

class Spnav : public SpaceMouseSource {
 public:
  Spnav() = default;
  ~Spnav() override { close(); }
  Spnav(const Spnav&) = delete;
  Spnav& operator=(const Spnav&) = delete;

  std::vector<SpaceMouseEvent> poll() override {
    std::vector<SpaceMouseEvent> events;
    for (int n = 0; n < kMaxPerPoll && is_open_; ++n) {
      spnav_event event{};
      switch (waiting()) {
        case Waiting::kPart: return events;
        case Waiting::kEnd:
          close();
          events.emplace_back(SpaceMouseGone{});
          return events;
        case Waiting::kNothing:  // but libspnav's own queue may hold events
          if (spnav_poll_event(&event) == 0) return events;
          break;
        case Waiting::kEvent: spnav_poll_event(&event);
      }
      add(event, events);
    }
    return events;
  }

 private:
  enum class Waiting { kNothing, kPart, kEvent, kEnd };

  // Checks the socket before libspnav reads it: libspnav would take part of an event for a whole one, and a
  // closed connection for no events.
  static Waiting waiting() {
    std::array<char, kEventBytes> bytes{};
    const ssize_t size = ::recv(spnav_fd(), bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
    if (size == 0) return Waiting::kEnd;
    if (size > 0) return size < static_cast<ssize_t>(kEventBytes) ? Waiting::kPart : Waiting::kEvent;
    return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR ? Waiting::kNothing : Waiting::kEnd;
  }

  static void add(const spnav_event& event, std::vector<SpaceMouseEvent>& events) {
    if (event.type == SPNAV_EVENT_MOTION) {
      const spnav_event_motion& m = event.motion;
      events.emplace_back(SpaceMouseMotion{{m.x, m.y, m.z}, {m.rx, m.ry, m.rz}});
    } else if (event.type == SPNAV_EVENT_BUTTON) {
      events.emplace_back(SpaceMouseButton{event.button.bnum, event.button.press != 0});
    } else if (event.type == SPNAV_EVENT_DEV && event.dev.op == SPNAV_DEV_RM) {
      events.emplace_back(SpaceMouseGone{});
    }
  }

  void close() {
    if (is_open_) spnav_close();
    is_open_ = false;
  }

  bool is_open_ = true;
};

}  // namespace

std::unique_ptr<SpaceMouseSource> open_space_mouse() {
  if (spnav_fd() >= 0) throw DeviceError("the space mouse is open already in this program");
  errno = 0;
  if (spnav_open() != 0) {
    const std::string message = errno != 0 ? std::generic_category().message(errno) : "no answer";
    throw DeviceError("cannot reach the space mouse's daemon: " + message +
                      "; start spacenavd (Debian: apt install spacenavd), or set SPNAV_SOCKET to its socket");
  }
  return std::make_unique<Spnav>();
}

#else

std::unique_ptr<SpaceMouseSource> open_space_mouse() {
  throw DeviceError(
      "this program was built without libspnav, which reads space mice; install libspnav-dev and build it "
      "again");
}

#endif

}  // namespace vpe::explore
