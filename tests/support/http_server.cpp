#include "tests/support/http_server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace test_support {

namespace {

void send_all(int connection, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t sent = ::send(connection, text.data() + at, text.size() - at, MSG_NOSIGNAL);
    if (sent <= 0) return;
    at += static_cast<std::size_t>(sent);
  }
}

std::string small_letters(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

HttpServer::Request parsed(const std::string& text) {
  HttpServer::Request request;
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  std::istringstream words(line);
  words >> request.method >> request.path;
  request.path.erase(0, 1);
  while (std::getline(lines, line) && line.size() > 1) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) continue;
    request.headers[small_letters(line.substr(0, colon))] = line.substr(colon + 2, line.size() - colon - 3);
  }
  return request;
}

}  // namespace

HttpServer::HttpServer(std::filesystem::path folder, Decide decide, bool states_times)
    : folder_(std::move(folder)), decide_(std::move(decide)), states_times_(states_times) {
  open_socket();
}

HttpServer::HttpServer(std::filesystem::path folder, Answers answers)
    : folder_(std::move(folder)), answers_(std::move(answers)) {
  open_socket();
}

void HttpServer::open_socket() {
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

std::vector<HttpServer::Request> HttpServer::log() const {
  const std::lock_guard lock(mutex_);
  return log_;
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
  if (answers_) return answer_as_told(connection, request);
  const auto send = [&](const std::string& text) { send_all(connection, text); };
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

bool HttpServer::answer_as_told(int connection, const std::string& text) {
  Request request = parsed(text);
  request.n = requests_++;
  const Answer told = answers_(request);
  {
    const std::lock_guard lock(mutex_);
    log_.push_back(request);
  }
  std::map<std::string, std::string> headers{{"Connection", "close"},
                                             {"Last-Modified", "Sat, 21 Nov 2026 08:00:00 GMT"},
                                             {"Content-Type", "application/octet-stream"}};
  for (const auto& [name, value] : told.headers) headers[name] = value;
  int status = told.status;
  std::string body = told.body.value_or("");
  if (!told.body && status == 200) {
    std::ifstream file(folder_ / request.path, std::ios::binary);
    if (!file || request.path.empty()) status = 404;
    body.assign(std::istreambuf_iterator<char>(file), {});
  }
  const auto range = request.headers.find("range");
  const auto if_range = request.headers.find("if-range");
  const bool is_same = !told.obeys_if_range || if_range == request.headers.end() ||
                       if_range->second == headers["ETag"] || if_range->second == headers["Last-Modified"];
  if (status == 200 && told.knows_ranges && range != request.headers.end() && is_same) {
    const std::size_t first = std::stoul(range->second.substr(std::string("bytes=").size()));
    const std::string size = std::to_string(body.size());
    status = first < body.size() ? 206 : 416;
    headers.insert({"Content-Range", status == 416 ? "bytes */" + size
                                                   : "bytes " + std::to_string(first) + "-" +
                                                         std::to_string(body.size() - 1) + "/" + size});
    body = status == 416 ? "" : body.substr(first);
  }
  headers.insert({"Content-Length", std::to_string(body.size())});
  std::string head = "HTTP/1.1 " + std::to_string(status) + " Told\r\n";
  for (const auto& [name, value] : headers) {
    if (!value.empty()) head += name + ": " + value + "\r\n";
  }
  if (told.cut_after) body.resize(std::min(body.size(), *told.cut_after));
  bytes_ += static_cast<std::int64_t>(body.size());
  send_all(connection, head + "\r\n" + body);
  return told.hangs;
}

}  // namespace test_support
