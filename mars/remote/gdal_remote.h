// Rasters on web servers and in object stores, read through GDAL's /vsicurl/, /vsis3/, /vsigs/, /vsiaz/ and the
// like.
#pragma once

#include <bitset>
#include <functional>
#include <string>

namespace mars {

// Returns GDAL's name of a URL: "/vsicurl/http://..." for "http://...", likewise for "https://" and "ftp://";
// "/vsis3/..." for "s3://...", "/vsigs/..." for "gs://...", "/vsiaz/..." for "az://...". Returns any other path
// unchanged.
std::string raster_name(const std::string& path);

// Returns true if reading the raster uses the network (a name of raster_name(), also inside "/vsizip/" and the
// like).
bool is_remote(const std::string& path);

// Returns advice for a raster that cannot be opened or read with GDAL's `message`: about the network for remote
// rasters that could not be reached, else `advice_for_files`.
std::string advice_for(const std::string& path, const std::string& message,
                       const std::string& advice_for_files);

// Changes how GDAL opens a remote raster on this thread, during its lifetime: without listing the server's
// folder, and with a limit of half a minute for a server that sends nothing. The user's own settings
// (GDAL_HTTP_LOW_SPEED_TIME, ...) take precedence. The read is watched, see remote_watch.h. Changes nothing for
// local files. Scopes may nest.
class RemoteScope {
 public:
  explicit RemoteScope(const std::string& path);
  ~RemoteScope();
  RemoteScope(const RemoteScope&) = delete;
  RemoteScope& operator=(const RemoteScope&) = delete;

 private:
  std::bitset<8> set_;  // settings that this scope made
  int wait_ = 0;        // number of the watched read; 0: none
};

// Largest number of attempts for a remote raster, and the time after which no further one is begun.
inline constexpr int kRemoteTries = 7;
inline constexpr double kRemotePatience_s = 120;

// Calls attempt() until it returns true; a local raster gets one attempt. After a transient failure (anything
// but an answer such as 403 or 404) it waits, twice as long each time, and drops what GDAL has cached of the
// file. The first wait is GDAL_HTTP_RETRY_DELAY seconds, half a second by default. Must be called inside a
// GdalScope, whose message() then describes the last failure. Returns false if all attempts failed.
bool attempt_with_retries(const std::string& path, const std::function<bool()>& attempt);

}  // namespace mars
