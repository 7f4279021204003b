#include "vpe/app/get/http_request.h"

#include <curl/curl.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>

#include "vpe/app/cli/program.h"

namespace vpe::app {

namespace {

// A request under way. Exceptions must not pass through libcurl.
struct Exchange {
  const HttpHandlers& handlers;
  ResponseHead head;
  bool is_judged = false;  // on_head() was called
  bool is_wanted = false;
  std::exception_ptr thrown;

  // Calls a function; returns false if it threw.
  template <class Function>
  bool guard(Function&& function) {
    try {
      function();
      return true;
    } catch (...) {
      thrown = std::current_exception();
      return false;
    }
  }

  void judge() {
    if (is_judged) return;
    is_judged = true;
    is_wanted = handlers.on_head(head);
  }
};

std::size_t on_header(char* data, std::size_t size, std::size_t count, void* user) {
  auto& exchange = *static_cast<Exchange*>(user);
  const bool is_fine = exchange.guard([&] { read_head_line({data, size * count}, exchange.head); });
  return is_fine ? size * count : 0;
}

std::size_t on_data(char* data, std::size_t size, std::size_t count, void* user) {
  auto& exchange = *static_cast<Exchange*>(user);
  const bool is_fine = exchange.guard([&] {
    exchange.judge();
    if (exchange.is_wanted) exchange.handlers.on_body({data, size * count});
  });
  return is_fine && exchange.is_wanted ? size * count : CURL_WRITEFUNC_ERROR;
}

int on_progress(void* user, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  auto& exchange = *static_cast<Exchange*>(user);
  return exchange.guard([&] { exchange.handlers.on_tick(); }) ? 0 : 1;
}

bool may_pass(CURLcode code) {
  constexpr std::array kPassing{CURLE_COULDNT_RESOLVE_HOST, CURLE_COULDNT_RESOLVE_PROXY,
                                CURLE_COULDNT_CONNECT,      CURLE_OPERATION_TIMEDOUT,
                                CURLE_RECV_ERROR,           CURLE_SEND_ERROR,
                                CURLE_GOT_NOTHING,          CURLE_PARTIAL_FILE,
                                CURLE_SSL_CONNECT_ERROR,    CURLE_HTTP2,
                                CURLE_HTTP2_STREAM,         CURLE_WEIRD_SERVER_REPLY};
  return std::ranges::find(kPassing, code) != kPassing.end();
}

long milliseconds(double seconds) { return static_cast<long>(1000 * seconds); }

template <class Value>
void set_option(CURL* curl, CURLoption option, Value value) {
  if (const CURLcode code = curl_easy_setopt(curl, option, value); code != CURLE_OK)
    throw std::runtime_error(std::string("libcurl: ") + curl_easy_strerror(code));
}

using Curl = std::unique_ptr<CURL, void (*)(CURL*)>;
using HeaderList = std::unique_ptr<curl_slist, void (*)(curl_slist*)>;

Curl make_handle() {
  static const CURLcode kStarted = curl_global_init(CURL_GLOBAL_DEFAULT);
  Curl curl(kStarted == CURLE_OK ? curl_easy_init() : nullptr, curl_easy_cleanup);
  if (curl == nullptr) throw std::runtime_error("libcurl cannot be started");
  return curl;
}

void set_limits(CURL* curl, const std::string& address, const HttpLimits& limits) {
  const bool is_safe = address.starts_with("https://");
  set_option(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  set_option(curl, CURLOPT_REDIR_PROTOCOLS_STR, is_safe ? "https" : "http,https");
  set_option(curl, CURLOPT_FOLLOWLOCATION, 1L);
  set_option(curl, CURLOPT_MAXREDIRS, static_cast<long>(limits.redirects));
  set_option(curl, CURLOPT_CONNECTTIMEOUT_MS, std::max(1L, milliseconds(limits.connect_s)));
  set_option(curl, CURLOPT_LOW_SPEED_LIMIT, 1L);
  set_option(curl, CURLOPT_LOW_SPEED_TIME, std::max(1L, static_cast<long>(limits.stall_s)));
  set_option(curl, CURLOPT_NOSIGNAL, 1L);
  // As the program curl does, and GDAL.
  for (const char* name : {"SSL_CERT_FILE", "CURL_CA_BUNDLE"}) {
    const char* file = std::getenv(name);
    if (file != nullptr && *file != '\0') set_option(curl, CURLOPT_CAINFO, file);
  }
}

}  // namespace

HttpOutcome http_get(const HttpRequest& request, const HttpLimits& limits, const HttpHandlers& handlers) {
  const Curl curl = make_handle();
  Exchange exchange{handlers, {}, false, false, nullptr};
  char words[CURL_ERROR_SIZE] = "";
  const std::string agent = std::string("vpe/") + version();
  const std::string range = std::to_string(request.resume.offset) + "-";
  HeaderList headers(nullptr, curl_slist_free_all);
  set_limits(curl.get(), request.address, limits);
  set_option(curl.get(), CURLOPT_URL, request.address.c_str());
  set_option(curl.get(), CURLOPT_USERAGENT, agent.c_str());
  set_option(curl.get(), CURLOPT_ERRORBUFFER, static_cast<char*>(words));
  set_option(curl.get(), CURLOPT_SUPPRESS_CONNECT_HEADERS, 1L);
  set_option(curl.get(), CURLOPT_HEADERFUNCTION, &on_header);
  set_option(curl.get(), CURLOPT_HEADERDATA, static_cast<void*>(&exchange));
  set_option(curl.get(), CURLOPT_WRITEFUNCTION, &on_data);
  set_option(curl.get(), CURLOPT_WRITEDATA, static_cast<void*>(&exchange));
  set_option(curl.get(), CURLOPT_NOPROGRESS, 0L);
  set_option(curl.get(), CURLOPT_XFERINFOFUNCTION, &on_progress);
  set_option(curl.get(), CURLOPT_XFERINFODATA, static_cast<void*>(&exchange));
  if (request.resume.offset > 0) {
    set_option(curl.get(), CURLOPT_RANGE, range.c_str());
    headers.reset(curl_slist_append(nullptr, ("If-Range: " + request.resume.validator).c_str()));
    set_option(curl.get(), CURLOPT_HTTPHEADER, headers.get());
  }
  const CURLcode code = curl_easy_perform(curl.get());
  if (exchange.thrown != nullptr) std::rethrow_exception(exchange.thrown);
  HttpOutcome outcome;
  // Answers without a body, such as most errors, are complete at their head.
  if (code == CURLE_OK) exchange.judge();
  outcome.has_answer = exchange.is_judged;
  outcome.is_complete = code == CURLE_OK || (exchange.is_judged && !exchange.is_wanted);
  outcome.may_pass = may_pass(code);
  if (!outcome.is_complete) outcome.problem = words[0] != '\0' ? words : curl_easy_strerror(code);
  if (code == CURLE_PEER_FAILED_VERIFICATION)
    outcome.problem += " (CURL_CA_BUNDLE may name a file with more certificates)";
  curl_off_t wait_s = 0;
  if (curl_easy_getinfo(curl.get(), CURLINFO_RETRY_AFTER, &wait_s) == CURLE_OK && wait_s > 0)
    outcome.retry_after_s = static_cast<double>(wait_s);
  return outcome;
}

}  // namespace vpe::app
