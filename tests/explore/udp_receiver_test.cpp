#include "vpe/explore/input/udp_receiver.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <vector>

#include "vpe/explore/input/head_tracker.h"

namespace vpe::explore {
namespace {

using Bytes = std::vector<std::uint8_t>;

// Sends to a port of this machine, as opentrack does.
class Sender {
 public:
  explicit Sender(int port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(static_cast<std::uint16_t>(port));
    to_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~Sender() { ::close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(const Bytes& bytes) {
    ASSERT_EQ(
        ::sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
        static_cast<ssize_t>(bytes.size()));
  }

 private:
  int socket_;
  sockaddr_in to_{};
};

std::string why(const UdpOptions& options) {
  try {
    const UdpReceiver receiver(options);
    return "";
  } catch (const DeviceError& e) {
    return e.what();
  }
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(UdpReceiver, PassesAllDatagramsInTheirOrder) {
  UdpReceiver receiver({.port = 0});
  ASSERT_GT(receiver.port(), 0);
  std::vector<Bytes> all;
  const auto keep = [&all](std::span<const std::uint8_t> bytes) {
    all.emplace_back(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(receiver.poll(keep), 0U);  // does not wait
  Sender sender(receiver.port());
  const std::vector<Bytes> sent{{1, 2, 3}, {}, Bytes(48, 7), {4}};
  for (const Bytes& bytes : sent) sender.send(bytes);
  EXPECT_EQ(receiver.poll(keep), sent.size());
  EXPECT_EQ(all, sent);
  EXPECT_EQ(receiver.poll(keep), 0U);
}

TEST(UdpReceiver, LongDatagramsAreTruncatedAndNoneIsLost) {
  UdpReceiver receiver({.port = 0});
  Sender sender(receiver.port());
  sender.send(Bytes(20'000, 1));
  sender.send(Bytes(48, 2));
  std::vector<std::size_t> sizes;
  receiver.poll([&sizes](std::span<const std::uint8_t> bytes) { sizes.push_back(bytes.size()); });
  EXPECT_EQ(sizes, (std::vector<std::size_t>{UdpReceiver::kMaxBytes, 48}));
}

TEST(UdpReceiver, OpentracksDatagramsRotateTheHead) {
  UdpReceiver receiver({.port = 0});
  Sender sender(receiver.port());
  const double numbers[6] = {0, 0, 0, 25, -5, 2};  // this machine's bytes: the test says so on no other
  if (const std::uint16_t one = 1; *reinterpret_cast<const std::uint8_t*>(&one) != 1) GTEST_SKIP();
  Bytes bytes(sizeof numbers);
  std::memcpy(bytes.data(), numbers, sizeof numbers);
  HeadTracker tracker;
  double time_s = 0;
  for (int frame = 0; frame < 60; ++frame) {
    time_s += 1.0 / 60;
    for (int n = 0; n < 4; ++n) sender.send(bytes);
    sender.send({9, 9, 9});
    receiver.poll([&](std::span<const std::uint8_t> got) { tracker.receive(got, time_s); });
  }
  EXPECT_EQ(tracker.received(), 240U);
  EXPECT_EQ(tracker.ignored(), 60U);
  EXPECT_NEAR(tracker.look(time_s).yaw_deg, 25, 1e-3);
  EXPECT_NEAR(tracker.look(time_s).pitch_deg, -5, 1e-3);
  EXPECT_NEAR(tracker.look(time_s).roll_deg, 2, 1e-3);
}

TEST(UdpReceiver, ErrorsNameThePortTheReasonAndWhatToDo) {
  const UdpReceiver first({.port = 0});
  const std::string taken = why({.port = first.port()});
  EXPECT_TRUE(holds(taken, "127.0.0.1 port " + std::to_string(first.port()))) << taken;
  EXPECT_TRUE(holds(taken, "Address already in use") && holds(taken, "choose another port")) << taken;
  EXPECT_TRUE(holds(why({.address = "203.0.113.7", .port = 0}), "0.0.0.0")) << why({.address = "203.0.113.7"});
  for (const char* address : {"", "localhost", "1.2.3.4.5", "127.0.0.1:4242", "x"}) {
    EXPECT_NE(address_problem(address), "") << address;
    EXPECT_TRUE(holds(why({.address = address, .port = 0}), "numeric address")) << address;
  }
  for (const int port : {-1, 65536}) EXPECT_TRUE(holds(why({.port = port}), "1 to 65535")) << port;
}

TEST(UdpReceiver, OtherAddressesOfThisMachine) {
  EXPECT_EQ(why({.address = "0.0.0.0", .port = 0}), "");
  EXPECT_EQ(address_problem("::1"), "");
  UdpReceiver everywhere({.address = "0.0.0.0", .port = 0});
  Sender sender(everywhere.port());
  sender.send({1});
  EXPECT_EQ(everywhere.poll([](std::span<const std::uint8_t>) {}), 1U);
}

}  // namespace
}  // namespace vpe::explore
