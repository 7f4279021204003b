// Datagrams from the network, taken when there is time for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "vpe/explore/input/device_error.h"

namespace vpe::explore {

struct UdpOptions {
  static constexpr int kDefaultPort = 4242;  // opentrack's

  std::string address = "127.0.0.1";  // of this machine: numeric, IPv4 or IPv6; 0.0.0.0 or :: = all of them
  int port = kDefaultPort;            // 0 = any that is free

  bool operator==(const UdpOptions&) const = default;
};

// Empty when the text is a numeric address, else what is wrong with it.
std::string address_problem(const std::string& address);

// Never waits. One thread at a time.
class UdpReceiver {
 public:
  // Datagrams of one poll(): a flood of them must not hold up a frame.
  static constexpr std::size_t kMaxPerPoll = 1024;
  // Longer ones are handed on cut to this.
  static constexpr std::size_t kMaxBytes = 512;

  using Sink = std::function<void(std::span<const std::uint8_t> bytes)>;

  // Throws DeviceError, as when another program listens there.
  explicit UdpReceiver(const UdpOptions& options);
  ~UdpReceiver();
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  int port() const { return port_; }

  // Hands on what has come since the last call, oldest first; returns how many.
  std::size_t poll(const Sink& sink);

 private:
  int socket_ = -1;
  int port_ = 0;
};

}  // namespace vpe::explore
