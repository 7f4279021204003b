#include "mars/raster/gdal/gdal_scope.h"

#include <cpl_error.h>
#include <gdal.h>

#include <algorithm>
#include <mutex>

namespace mars {

GdalScope::GdalScope() {
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLPushErrorHandler(CPLQuietErrorHandler);
  CPLErrorReset();
}

GdalScope::~GdalScope() {
  CPLErrorReset();
  CPLPopErrorHandler();
}

std::string GdalScope::last_message() {
  std::string text = CPLGetLastErrorMsg();
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text;
}

SourceError source_error(const std::string& path, const std::string& operation, const std::string& words,
                         const std::string& advice) {
  return SourceError(path + ": " + operation + (words.empty() ? "" : ": " + words) + "; " + advice);
}

}  // namespace mars
