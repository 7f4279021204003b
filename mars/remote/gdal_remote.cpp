#include "mars/remote/gdal_remote.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include "mars/remote/remote_watch.h"

namespace mars {

namespace {

struct Setting {
  const char* name;
  const char* value;
};
constexpr std::array kSettings{
    Setting{"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE"}, Setting{"GDAL_HTTP_CONNECTTIMEOUT", "20"},
    Setting{"GDAL_HTTP_LOW_SPEED_TIME", "30"}, Setting{"GDAL_HTTP_LOW_SPEED_LIMIT", "1"}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kSchemes{
    {{"http://", "/vsicurl/http://"},
     {"https://", "/vsicurl/https://"},
     {"ftp://", "/vsicurl/ftp://"},
     {"s3://", "/vsis3/"},
     {"gs://", "/vsigs/"},
     {"az://", "/vsiaz/"}}};

// File systems of GDAL that use the network.
constexpr std::array<std::string_view, 10> kFileSystems{
    "/vsicurl/", "/vsicurl?", "/vsis3/",    "/vsigs/",      "/vsiaz/",
    "/vsiadls/", "/vsioss/",  "/vsiswift/", "/vsiwebhdfs/", "/vsicurl_streaming/"};

// Returns where the name of a remote file begins, npos for local ones.
std::size_t remote_begin(const std::string& path) {
  for (const std::string_view system : kFileSystems) {
    if (const std::size_t at = path.find(system); at != std::string::npos) return at;
  }
  return std::string::npos;
}

// Returns true if no driver reads the file. GDAL also says so where a server failed on the way.
bool is_wrong_format(const std::string& message) {
  return message.find("not recognized as a supported file format") != std::string::npos;
}

bool lacks_credentials(const std::string& message) {
  return message.find("redentials") != std::string::npos ||
         message.find("_NO_SIGN_REQUEST") != std::string::npos;
}

// Returns true for answers that another attempt cannot change: 4xx except "timeout" and "too many requests", and
// what object stores say of credentials, rights and names.
bool is_final(const std::string& message) {
  if (lacks_credentials(message) || message.find("AccessDenied") != std::string::npos ||
      message.find("NoSuch") != std::string::npos)
    return true;
  for (const char* words : {"response code: ", "error code : ", "HTTP error code: "}) {
    const std::size_t at = message.find(words);
    if (at == std::string::npos) continue;
    const std::string code = message.substr(at + std::string(words).size(), 3);
    if (code[0] == '4' && code != "408" && code != "429") return true;
  }
  return false;
}

}  // namespace

std::string raster_name(const std::string& path) {
  for (const auto& [scheme, name] : kSchemes) {
    if (path.starts_with(scheme)) return std::string(name) + path.substr(scheme.size());
  }
  return path;
}

bool is_remote(const std::string& path) { return remote_begin(path) != std::string::npos; }

std::string advice_for(const std::string& path, const std::string& message,
                       const std::string& advice_for_files) {
  if (!is_remote(path)) return advice_for_files;
  if (is_wrong_format(message)) return advice_for_files + ", and check what the server sends";
  if (lacks_credentials(message))
    return "give credentials in the variables that GDAL names, or AWS_NO_SIGN_REQUEST=YES "
           "(GS_NO_SIGN_REQUEST, AZURE_NO_SIGN_REQUEST) for public data";
  return "check the address and the network, then run it again; or fetch the file first";
}

RemoteScope::RemoteScope(const std::string& path) {
  if (!is_remote(path)) return;
  wait_ = begin_remote_wait(path.substr(remote_begin(path)));
  for (std::size_t n = 0; n < kSettings.size(); ++n) {
    if (CPLGetConfigOption(kSettings[n].name, nullptr) != nullptr) continue;
    CPLSetThreadLocalConfigOption(kSettings[n].name, kSettings[n].value);
    set_.set(n);
  }
}

RemoteScope::~RemoteScope() {
  if (wait_ == 0) return;
  for (std::size_t n = 0; n < kSettings.size(); ++n) {
    if (set_.test(n)) CPLSetThreadLocalConfigOption(kSettings[n].name, nullptr);
  }
  end_remote_wait(wait_);
}

bool attempt_with_retries(const std::string& path, const std::function<bool()>& attempt) {
  const RemoteScope scope(path);
  const bool remote = is_remote(path);
  const double first_s = std::clamp(CPLAtof(CPLGetConfigOption("GDAL_HTTP_RETRY_DELAY", "0.5")), 0.0, 60.0);
  std::chrono::duration<double> wait(first_s);
  const auto begin = std::chrono::steady_clock::now();
  const auto is_tired = [&] {
    return std::chrono::steady_clock::now() - begin > std::chrono::duration<double>(kRemotePatience_s);
  };
  for (int tries = 1;; ++tries, wait *= 2) {
    CPLErrorReset();
    if (attempt()) return true;
    if (!remote || tries >= kRemoteTries || is_tired() || is_final(CPLGetLastErrorMsg())) return false;
    std::this_thread::sleep_for(wait);
    VSICurlPartialClearCache(path.substr(remote_begin(path)).c_str());
  }
}

}  // namespace mars
