#include "mars/raster/gdal_remote.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_vsi.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

namespace mars {

namespace {

struct Setting {
  const char* name;
  const char* value;
};
constexpr std::array kSettings{
    Setting{"GDAL_DISABLE_READDIR_ON_OPEN", "TRUE"}, Setting{"GDAL_HTTP_CONNECTTIMEOUT", "20"},
    Setting{"GDAL_HTTP_LOW_SPEED_TIME", "60"}, Setting{"GDAL_HTTP_LOW_SPEED_LIMIT", "1"}};

// Returns true for answers that another attempt cannot change: 4xx except "timeout" and "too many requests".
bool is_final(const std::string& message) {
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
  for (const char* scheme : {"http://", "https://", "ftp://"}) {
    if (path.starts_with(scheme)) return "/vsicurl/" + path;
  }
  return path;
}

bool is_remote(const std::string& path) { return path.find("/vsicurl/") != std::string::npos; }

std::string advice_for(const std::string& path, const std::string& advice_for_files) {
  return is_remote(path) ? "check the address and the network, then run it again; or fetch the file first"
                         : advice_for_files;
}

RemoteScope::RemoteScope(const std::string& path) : remote_(is_remote(path)) {
  if (!remote_) return;
  for (const Setting& s : kSettings) {
    if (CPLGetConfigOption(s.name, nullptr) == nullptr) CPLSetThreadLocalConfigOption(s.name, s.value);
  }
}

RemoteScope::~RemoteScope() {
  if (!remote_) return;
  for (const Setting& s : kSettings) {
    const char* now = CPLGetThreadLocalConfigOption(s.name, nullptr);
    if (now != nullptr && std::string(now) == s.value) CPLSetThreadLocalConfigOption(s.name, nullptr);
  }
}

bool attempt_with_retries(const std::string& path, const std::function<bool()>& attempt) {
  const RemoteScope scope(path);
  const bool remote = is_remote(path);
  const double first_s = std::clamp(CPLAtof(CPLGetConfigOption("GDAL_HTTP_RETRY_DELAY", "0.5")), 0.0, 60.0);
  std::chrono::duration<double> wait(first_s);
  for (int tries = 1;; ++tries, wait *= 2) {
    CPLErrorReset();
    if (attempt()) return true;
    if (!remote || tries >= kRemoteTries || is_final(CPLGetLastErrorMsg())) return false;
    std::this_thread::sleep_for(wait);
    VSICurlPartialClearCache(path.substr(path.find("/vsicurl/")).c_str());
  }
}

}  // namespace mars
