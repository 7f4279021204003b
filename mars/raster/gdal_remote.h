// Rasters on web servers, read through GDAL's /vsicurl/.
#pragma once

#include <functional>
#include <string>

namespace mars {

// "http://...", "https://..." and "ftp://..." as GDAL names them ("/vsicurl/http://..."); any other name as it
// is.
std::string raster_name(const std::string& path);

// Whether reading it goes over the network ("/vsicurl/", also inside "/vsizip/" and the like).
bool is_remote(const std::string& path);

// What to do about a raster that cannot be opened or read.
std::string advice_for(const std::string& path, const std::string& advice_for_files);

// While it lives, GDAL opens a remote raster on this thread without listing the server's folder, and waits no
// longer than a minute for a server that sends nothing. Settings of the user (GDAL_HTTP_TIMEOUT, ...) come
// first. Nothing is changed for local files.
class RemoteScope {
 public:
  explicit RemoteScope(const std::string& path);
  ~RemoteScope();
  RemoteScope(const RemoteScope&) = delete;
  RemoteScope& operator=(const RemoteScope&) = delete;

 private:
  bool remote_;
};

// Calls attempt() until it returns true, for a remote raster up to kRemoteTries times: after a failure that may
// pass (anything but an answer such as 403 or 404) it waits, twice as long each time, and drops what GDAL
// remembers of the file. The first wait is GDAL_HTTP_RETRY_DELAY seconds, half a second when that is not set.
// Must be called inside a GdalScope, whose message() then says what went wrong the last time.
inline constexpr int kRemoteTries = 7;
bool attempt_with_retries(const std::string& path, const std::function<bool()>& attempt);

}  // namespace mars
