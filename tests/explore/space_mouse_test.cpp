#include "vpe/explore/input/space_mouse.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

#include "tests/support/support.h"

namespace vpe::explore {
namespace {

constexpr SpaceMouseOptions kStraight{.dead_zone = 0, .curve = 1};

TEST(SpaceMouse, TheCapIsTheCamera) {
  const auto c = [](std::array<int, 3> move, std::array<int, 3> turn) {
    return space_mouse_controls({move, turn}, kStraight);
  };
  EXPECT_EQ(c({0, 0, 0}, {0, 0, 0}), Controls{});
  EXPECT_EQ(c({350, 175, -350}, {0, 0, 0}), (Controls{.right = 1, .up = 0.5, .forward = -1}));
  EXPECT_EQ(c({0, 0, 0}, {350, 175, -350}), (Controls{.yaw_right = -0.5, .pitch_up = 1, .roll_right = -1}));
}

TEST(SpaceMouse, Options) {
  SpaceMouseOptions options = kStraight;
  options.holds_ground = true;
  options.roll = false;
  EXPECT_EQ(space_mouse_controls({{350, 0, 0}, {350, 0, 350}}, options),
            (Controls{.right = -1, .pitch_up = -1}));
  const SpaceMouseOptions usual;
  EXPECT_EQ(space_mouse_controls({{10, -10, 10}, {-10, 10, 10}}, usual), Controls{});  // nearly at rest
  EXPECT_EQ(space_mouse_controls({{350, 0, 0}, {}}, usual), (Controls{.right = 1}));
  EXPECT_LT(space_mouse_controls({{175, 0, 0}, {}}, usual).right, 0.5);  // finer near rest
}

TEST(SpaceMouse, AnyEventsAreWithinLimits) {
  rc::check("rates within -1..1", [](std::array<int, 6> v) {
    const Controls c = space_mouse_controls({{v[0], v[1], v[2]}, {v[3], v[4], v[5]}}, {});
    for (const double rate : {c.right, c.up, c.forward, c.yaw_right, c.pitch_up, c.roll_right}) {
      RC_ASSERT(std::abs(rate) <= 1);
    }
  });
}

TEST(SpaceMouse, MotionLastsUntilTheNextEventOrTheTimeOut) {
  SpaceMouse mouse;
  const auto read = [&mouse](std::vector<SpaceMouseEvent> events, double time_s) {
    return mouse.read(events, kStraight, time_s).controls;
  };
  EXPECT_EQ(read({}, 0), Controls{});
  const SpaceMouseMotion right{{350, 0, 0}, {}};
  EXPECT_EQ(read({SpaceMouseMotion{{-350, 0, 0}, {}}, right}, 10), (Controls{.right = 1}));
  EXPECT_EQ(read({}, 11), (Controls{.right = 1}));
  EXPECT_EQ(read({}, 10 + SpaceMouse::kTimeout_s + 0.01), Controls{});
  EXPECT_EQ(read({right}, 20), (Controls{.right = 1}));
  EXPECT_EQ(read({SpaceMouseMotion{}}, 20.1), Controls{});
  EXPECT_EQ(read({right}, 30), (Controls{.right = 1}));
  EXPECT_EQ(read({SpaceMouseGone{}}, 30.1), Controls{});
}

TEST(SpaceMouse, ButtonsActWhenTheyGoDown) {
  SpaceMouse mouse;
  const auto read = [&mouse](std::vector<SpaceMouseEvent> events) { return mouse.read(events, {}, 0).actions; };
  using Actions = std::vector<Action>;
  EXPECT_EQ(read({SpaceMouseButton{0, true}, SpaceMouseButton{1, true}}),
            (Actions{{ActionKind::kLevel}, {ActionKind::kReset}}));
  EXPECT_EQ(read({SpaceMouseButton{0, true}}), Actions{});  // is down already
  EXPECT_EQ(read({SpaceMouseButton{0, false}, SpaceMouseButton{0, true}}), (Actions{{ActionKind::kLevel}}));
  EXPECT_EQ(read({SpaceMouseButton{-5, true}, SpaceMouseButton{30, true}, SpaceMouseButton{7, false}}),
            Actions{});
}

#ifdef VPE_SPNAV

// Imitates a daemon of protocol 0 or 1 on a socket of its own.
class FakeDaemon {
 public:
  using Packet = std::array<std::int32_t, 8>;

  FakeDaemon() {
    listener_ = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path().c_str(), sizeof address.sun_path - 1);
    if (::bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
        ::listen(listener_, 1) != 0) {
      ADD_FAILURE() << "no socket " << path() << ": " << std::strerror(errno);
    }
    ::setenv("SPNAV_SOCKET", path().c_str(), 1);
    std::signal(SIGPIPE, SIG_IGN);
  }
  ~FakeDaemon() {
    hang_up();
    ::close(listener_);
    ::unsetenv("SPNAV_SOCKET");
  }
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;

  std::string path() const { return (folder_ / "spnav.sock").string(); }

  // Opens a mouse while the daemon accepts it and says that it speaks protocol 1.
  std::unique_ptr<SpaceMouseSource> open() {
    std::thread answer([this] {
      connection_ = ::accept(listener_, nullptr, nullptr);
      std::int32_t request = 0;
      if (::recv(connection_, &request, sizeof request, MSG_WAITALL) != sizeof request) return;
      const std::int32_t reply = (request & ~0xff) | 1;
      (void)::send(connection_, &reply, sizeof reply, 0);
    });
    std::unique_ptr<SpaceMouseSource> source;
    try {
      source = open_space_mouse();
    } catch (const DeviceError& e) {
      ADD_FAILURE() << e.what();
    }
    answer.join();
    return source;
  }

  void send(const Packet& packet, std::size_t from = 0, std::size_t to = sizeof(Packet)) {
    const char* bytes = reinterpret_cast<const char*>(packet.data());
    EXPECT_EQ(::send(connection_, bytes + from, to - from, MSG_NOSIGNAL), static_cast<ssize_t>(to - from));
  }

  void hang_up() {
    if (connection_ >= 0) ::close(connection_);
    connection_ = -1;
  }

 private:
  test_support::TempDir folder_;
  int listener_ = -1;
  int connection_ = -1;
};

constexpr FakeDaemon::Packet motion(int x, int y, int z, int rx, int ry, int rz) {
  return {0, x, y, z, rx, ry, rz, 16};
}

TEST(Spnav, MotionAndButtonsOfADaemonArrive) {
  FakeDaemon daemon;
  const auto source = daemon.open();
  ASSERT_NE(source, nullptr);
  EXPECT_TRUE(source->poll().empty());  // does not wait
  daemon.send(motion(1, 2, 3, 4, 5, 6));
  daemon.send({1, 7});  // pressed
  daemon.send({2, 7});  // let go
  const std::vector<SpaceMouseEvent> events = source->poll();
  ASSERT_EQ(events.size(), 3U);
  const auto& moved = std::get<SpaceMouseMotion>(events[0]);
  EXPECT_EQ(moved.move, (std::array<int, 3>{1, 2, 3}));
  EXPECT_EQ(moved.rotate, (std::array<int, 3>{4, 5, 6}));
  EXPECT_EQ(std::get<SpaceMouseButton>(events[1]).number, 7);
  EXPECT_TRUE(std::get<SpaceMouseButton>(events[1]).is_down);
  EXPECT_FALSE(std::get<SpaceMouseButton>(events[2]).is_down);
  EXPECT_TRUE(source->poll().empty());
}

TEST(Spnav, InvalidEventsChangeNothing) {
  FakeDaemon daemon;
  const auto source = daemon.open();
  ASSERT_NE(source, nullptr);
  daemon.send({-7, 1, 2, 3, 4, 5, 6, 7});
  daemon.send({1 << 30, 1, 2, 3, 4, 5, 6, 7});
  daemon.send({4, 1, 2, 3, 4, 5, 6, 7});  // a change of the daemon's settings
  EXPECT_TRUE(source->poll().empty());
  // An event that comes in two parts is one.
  daemon.send(motion(9, 0, 0, 0, 0, 0), 0, 12);
  EXPECT_TRUE(source->poll().empty());
  daemon.send(motion(9, 0, 0, 0, 0, 0), 12);
  ASSERT_EQ(source->poll().size(), 1U);
}

TEST(Spnav, ALostDaemonAndAnUnpluggedMouseAreRest) {
  FakeDaemon daemon;
  auto source = daemon.open();
  ASSERT_NE(source, nullptr);
  SpaceMouse mouse;
  daemon.send(motion(350, 0, 0, 0, 0, 0));
  EXPECT_GT(mouse.read(source->poll(), {}, 0).controls.right, 0.9);
  daemon.send({3, 1});  // the device was removed
  EXPECT_EQ(mouse.read(source->poll(), {}, 0).controls, Controls{});
  daemon.send(motion(350, 0, 0, 0, 0, 0));
  EXPECT_GT(mouse.read(source->poll(), {}, 0).controls.right, 0.9);
  daemon.hang_up();
  EXPECT_EQ(mouse.read(source->poll(), {}, 0).controls, Controls{});
  EXPECT_TRUE(source->poll().empty());
  // When it is there again the mouse can be opened again.
  source.reset();
  source = daemon.open();
  ASSERT_NE(source, nullptr);
  daemon.send({1, 0});
  EXPECT_EQ(source->poll().size(), 1U);
}

TEST(Spnav, ErrorsSayWhatToDo) {
  const auto why = [] {
    try {
      (void)open_space_mouse();
      return std::string();
    } catch (const DeviceError& e) {
      return std::string(e.what());
    }
  };
  FakeDaemon daemon;
  {
    const auto source = daemon.open();
    EXPECT_NE(why().find("open already"), std::string::npos) << why();
  }
  if (::access("/var/run/spnav.sock", F_OK) == 0) GTEST_SKIP() << "a daemon is running";
  ::setenv("SPNAV_SOCKET", (daemon.path() + ".none").c_str(), 1);
  EXPECT_NE(why().find("No such file or directory; start spacenavd"), std::string::npos) << why();
}

#else

TEST(Spnav, AMissingLibraryIsReported) {
  try {
    (void)open_space_mouse();
    FAIL();
  } catch (const DeviceError& e) {
    EXPECT_NE(std::string(e.what()).find("libspnav-dev"), std::string::npos);
  }
}

#endif

}  // namespace
}  // namespace vpe::explore
