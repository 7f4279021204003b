// A small HTTP server on loopback for tests: serves one folder, with ranges, and fails on request.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
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

  struct Request {
    int n = 0;  // from 0
    std::string method;
    std::string path;                            // without the first slash
    std::map<std::string, std::string> headers;  // names in small letters
  };
  // Describes an answer. Without changes the file of the request's path is served, with ranges.
  struct Answer {
    int status = 200;                      // other ones have no body, unless `body` is given
    std::optional<std::string> body = {};  // in place of the file
    // Besides the server's own, or in place of them; empty ones are left out.
    std::map<std::string, std::string> headers = {};
    bool obeys_if_range = true;
    bool knows_ranges = true;
    std::optional<std::size_t> cut_after = {};  // bytes of the body after which the connection ends
    bool hangs = false;                         // it stays open instead of ending
  };
  // Returns the answer to a request. Called from the server's thread.
  using Answers = std::function<Answer(const Request&)>;

  // `states_times`: answers say when a file was changed (always the same time).
  explicit HttpServer(std::filesystem::path folder, Decide decide = {}, bool states_times = true);
  HttpServer(std::filesystem::path folder, Answers answers);
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  std::string url(const std::string& file) const;  // http://127.0.0.1:PORT/file
  int requests() const { return requests_; }
  int failed() const { return failed_; }
  std::int64_t bytes() const { return bytes_; }  // of all files sent, without headers
  std::vector<Request> log() const;              // of a server with Answers

 private:
  void serve();
  // Returns true if the connection stays open.
  bool answer(int connection);
  bool answer_as_told(int connection, const std::string& request);
  void open_socket();

  std::filesystem::path folder_;
  Decide decide_;
  Answers answers_;
  bool states_times_ = true;
  mutable std::mutex mutex_;
  std::vector<Request> log_;
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
