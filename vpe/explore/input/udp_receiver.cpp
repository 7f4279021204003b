#include "vpe/explore/input/udp_receiver.h"

#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <memory>
#include <system_error>

namespace vpe::explore {

namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)>;

// Names are not resolved, since that could block.
Addresses resolve(const std::string& address, int port, int& failure) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  addrinfo* found = nullptr;
  failure = ::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found);
  return {failure == 0 ? found : nullptr, &::freeaddrinfo};
}

DeviceError listen_error(const UdpOptions& options, const std::string& reason, const std::string& advice) {
  return DeviceError("cannot listen for datagrams at " + options.address + " port " +
                     std::to_string(options.port) + ": " + reason + "; " + advice);
}

std::string advice_for(int error) {
  if (error == EADDRINUSE) return "end the other program that listens there, or choose another port";
  if (error == EACCES) return "choose a port of 1024 or more";
  if (error == EADDRNOTAVAIL) return "give an address of this machine, or 0.0.0.0 for all of them";
  return "choose another address or port";
}

}  // namespace

std::string address_problem(const std::string& address) {
  int failure = 0;
  if (!address.empty() && resolve(address, 0, failure)) return "";
  return "'" + address + "' is not a numeric address such as 127.0.0.1, 0.0.0.0 or ::1";
}

UdpReceiver::UdpReceiver(const UdpOptions& options) {
  if (options.port < 0 || options.port > 65535)
    throw listen_error(options, "no such port", "choose 1 to 65535");
  const std::string problem = address_problem(options.address);
  if (!problem.empty()) throw listen_error(options, problem, "give an address of this machine");
  int failure = 0;
  const Addresses address = resolve(options.address, options.port, failure);
  if (!address) throw listen_error(options, ::gai_strerror(failure), "choose another address");
  socket_ = ::socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_storage bound{};
  socklen_t size = sizeof bound;
  if (socket_ < 0 || ::bind(socket_, address->ai_addr, address->ai_addrlen) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    const int error = errno;
    if (socket_ >= 0) ::close(socket_);
    throw listen_error(options, std::generic_category().message(error), advice_for(error));
  }
  port_ = ntohs(bound.ss_family == AF_INET6 ? reinterpret_cast<const sockaddr_in6*>(&bound)->sin6_port
                                            : reinterpret_cast<const sockaddr_in*>(&bound)->sin_port);
}

UdpReceiver::~UdpReceiver() { ::close(socket_); }

std::size_t UdpReceiver::poll(const Sink& sink) {
  std::array<std::uint8_t, kMaxBytes> buffer{};
  std::size_t count = 0;
  for (std::size_t tries = 0; tries < kMaxPerPoll; ++tries) {
    const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), 0);
    if (size < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) break;
      continue;  // interrupted, or a pending error of the socket, which this call has cleared
    }
    ++count;
    sink(std::span(buffer).first(static_cast<std::size_t>(size)));
  }
  return count;
}

}  // namespace vpe::explore
