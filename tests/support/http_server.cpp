#include "tests/support/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace test_support {

HttpServer::HttpServer(std::filesystem::path folder, Decide decide, bool states_times)
    : folder_(std::move(folder)), decide_(std::move(decide)), states_times_(states_times) {
  socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  if (socket_ < 0 || ::bind(socket_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      ::listen(socket_, 64) != 0 || ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    throw std::runtime_error("no server on loopback");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

HttpServer::~HttpServer() {
  stop_ = true;
  thread_.join();
  for (const int connection : open_) ::close(connection);
  ::close(socket_);
}

std::string HttpServer::url(const std::string& file) const {
  return "http://127.0.0.1:" + std::to_string(port_) + "/" + file;
}

void HttpServer::serve() {
  while (!stop_) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, 20) <= 0) continue;
    const int connection = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
    if (connection < 0) continue;
    if (answer(connection)) {
      open_.push_back(connection);
    } else {
      ::close(connection);
    }
  }
}

bool HttpServer::answer(int connection) {
  std::string request;
  char buffer[4096];
  while (request.find("\r\n\r\n") == std::string::npos) {
    const ssize_t got = ::recv(connection, buffer, sizeof buffer, 0);
    if (got <= 0) return false;
    request.append(buffer, static_cast<std::size_t>(got));
  }
  const auto send = [&](const std::string& text) {
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t sent = ::send(connection, text.data() + at, text.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;
      at += static_cast<std::size_t>(sent);
    }
  };
  const std::string method = request.substr(0, request.find(' '));
  const std::size_t path_at = request.find('/');
  const std::string path = request.substr(path_at + 1, request.find(' ', path_at) - path_at - 1);
  const Fate fate = decide_ ? decide_(requests_++, method) : (++requests_, Fate::kServe);
  failed_ += fate == Fate::kServe ? 0 : 1;
  if (fate == Fate::kHangUp || fate == Fate::kHang) return fate == Fate::kHang;
  const auto status = [&](const char* text) {
    send(std::string("HTTP/1.1 ") + text + "\r\nContent-Length: 0\r\nConnection: close\r\n\r\n");
    return false;
  };
  if (fate == Fate::kUnavailable) return status("503 Service Unavailable");
  if (fate == Fate::kForbidden) return status("403 Forbidden");
  std::ifstream file(folder_ / path, std::ios::binary);
  if (!file || path.empty()) return status("404 Not Found");
  const std::string all{std::istreambuf_iterator<char>(file), {}};
  std::size_t first = 0;
  std::size_t last = all.size() - 1;
  std::string head = "HTTP/1.1 200 OK\r\n";
  if (const std::size_t range = request.find("Range: bytes="); range != std::string::npos) {
    std::size_t used = 0;
    const std::string text = request.substr(range + 13, 60);
    first = std::stoul(text, &used);
    if (text[used + 1] >= '0' && text[used + 1] <= '9')
      last = std::min<std::size_t>(last, std::stoul(text.substr(used + 1)));
    if (first > last) return status("416 Range Not Satisfiable");
    head = "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes " + std::to_string(first) + "-" +
           std::to_string(last) + "/" + std::to_string(all.size()) + "\r\n";
  }
  if (states_times_) head += "Last-Modified: Sat, 21 Nov 2026 08:00:00 GMT\r\n";
  head += "Accept-Ranges: bytes\r\nConnection: close\r\nContent-Length: " + std::to_string(last - first + 1) +
          "\r\n\r\n";
  const std::string body = method == "HEAD" ? "" : all.substr(first, last - first + 1);
  bytes_ += static_cast<std::int64_t>(body.size());
  send(head + (fate == Fate::kCut ? body.substr(0, body.size() / 2) : body));
  return false;
}

}  // namespace test_support
