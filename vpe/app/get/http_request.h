// One request to a web server, by libcurl. Proxies are taken from the environment (https_proxy, no_proxy ...), and
// more certificates than the system's from the file that CURL_CA_BUNDLE or SSL_CERT_FILE names.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "vpe/app/get/resume.h"

namespace vpe::app {

// Limits of a request. Each default is that of the option of `vpe get` that sets it, if there is one.
struct HttpLimits {
  double connect_s = 30;  // to connect
  double stall_s = 60;    // with less than a byte a second, after which a server counts as hung
  int redirects = 10;     // that are followed; never from https to http
};

struct HttpRequest {
  std::string address;
  ResumePlan resume;
};

// Functions that a request calls, on the thread that makes it. What they throw ends the request and is passed
// on.
struct HttpHandlers {
  std::function<bool(const ResponseHead&)> on_head;  // of the last answer; false: the body is not wanted
  std::function<void(std::string_view)> on_body;     // bytes of the body, in order
  std::function<void()> on_tick;                     // at least once a second while it lasts
};

// Says how a request ended. on_head() was called if `has_answer`.
struct HttpOutcome {
  bool has_answer = false;
  bool is_complete = false;  // the whole body came, or on_head() did not want it
  bool may_pass = false;     // what prevented it may be over soon
  std::string problem;       // unless it is complete
  double retry_after_s = 0;  // time for which the server asks to wait, 0 if it does not
};

HttpOutcome http_get(const HttpRequest& request, const HttpLimits& limits, const HttpHandlers& handlers);

}  // namespace vpe::app
