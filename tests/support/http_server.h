// A small HTTP server on loopback for tests: serves one folder, with ranges, and fails on request.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace test_support {

// Serves until it is destroyed.
class HttpServer {
 public:
  enum class Fate {
    kServe,
    kUnavailable,  // 503
    kForbidden,    // 403
    kCut,          // the connection ends in the middle of the body
    kHangUp,       // it ends before any answer
    kHang,         // it stays open, and nothing is sent
  };
  // Returns the fate of the n-th request (from 0). Called from the server's thread.
  using Decide = std::function<Fate(int n, const std::string& method)>;

  // `states_times`: answers say when a file was changed (always the same time).
  explicit HttpServer(std::filesystem::path folder, Decide decide = {}, bool states_times = true);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::string url(const std::string& file) const;  // http://127.0.0.1:PORT/file
  int requests() const { return requests_; }
  int failed() const { return failed_; }
  std::int64_t bytes() const { return bytes_; }  // of all files sent, without headers

 private:
  void serve();
  // Returns true if the connection stays open.
  bool answer(int connection);

  std::filesystem::path folder_;
  Decide decide_;
  bool states_times_;
  int socket_ = -1;
  int port_ = 0;
  std::atomic<int> requests_{0};
  std::atomic<int> failed_{0};
  std::atomic<std::int64_t> bytes_{0};
  std::vector<int> open_;  // connections that hang
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace test_support
