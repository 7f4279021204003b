// Keeps GDAL from following what a file points to.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mars/raster/gdal/gdal_scope.h"

namespace mars {

// Keeps GDAL on this thread from reading anything but the file that it is given: no web address, no style of another
// document, no extension of SQLite, no function in the schema of a database. A request to a web server fails at once.
// It is a GdalScope too. Scopes may nest.
class OfflineScope {
 public:
  OfflineScope();
  ~OfflineScope();
  OfflineScope(const OfflineScope&) = delete;
  OfflineScope& operator=(const OfflineScope&) = delete;

  // Returns the last message of the libraries, on one line, or "".
  std::string message() const { return scope_.message(); }

 private:
  GdalScope scope_;
  std::vector<std::optional<std::string>> former_;  // values of the settings before this scope
  bool is_pushed_ = false;
};

}  // namespace mars
