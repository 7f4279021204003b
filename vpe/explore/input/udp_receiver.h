// Receives datagrams from the network without waiting.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "vpe/explore/input/controls.h"

namespace vpe::explore {

struct UdpOptions {
  static constexpr int kDefaultPort = 4242;  // opentrack's

  std::string address = "127.0.0.1";  // of this machine: numeric, IPv4 or IPv6; 0.0.0.0 or :: = all addresses
  int port = kDefaultPort;            // 0 = any free port

  bool operator==(const UdpOptions&) const = default;
};

// Returns what is wrong with an address, or "" if it is a numeric one.
std::string address_problem(const std::string& address);

// Listens on a UDP port. Never waits. For one thread at a time.
//
// Typical usage:
//   UdpReceiver receiver({.port = 4242});
//   receiver.poll([&](std::span<const std::uint8_t> bytes) { tracker.receive(bytes, time_s); });
class UdpReceiver {
 public:
  // Limit of datagrams in one poll(), so that a flood of them does not delay a frame.
  static constexpr std::size_t kMaxPerPoll = 1024;
  // Longer datagrams are truncated to this size.
  static constexpr std::size_t kMaxBytes = 512;

  using Sink = std::function<void(std::span<const std::uint8_t> bytes)>;

  // Throws DeviceError, for example if another program listens on the port.
  explicit UdpReceiver(const UdpOptions& options);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  int port() const { return port_; }

  // Passes the datagrams since the last call to `sink`, oldest first. Returns their number.
  std::size_t poll(const Sink& sink);

 private:
  int socket_ = -1;
  int port_ = 0;
};

}  // namespace vpe::explore
