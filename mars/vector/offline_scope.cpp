#include "mars/vector/offline_scope.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_http.h>

#include <array>
#include <utility>

namespace mars {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 8> kSettings{{
    {"CPL_VSIL_CURL_ALLOWED_EXTENSIONS", ".vpe-allows-no-file-of-a-server"},
    {"LIBKML_EXTERNAL_STYLE", "NO"},
    {"LIBKML_RESOLVE_STYLE", "YES"},
    {"OGR_GEOCODE_SERVICE", "none"},
    {"OGR_SQLITE_ALLOW_EXTERNAL_ACCESS", "NO"},
    {"OGR_SQLITE_LOAD_EXTENSIONS", ""},
    {"OGR_SQLITE_PRAGMA", "trusted_schema=OFF"},
    {"SHAPE_RESTORE_SHX", "NO"},
}};

// GDAL asks the server all the same if there is no result.
CPLHTTPResult* refuse_fetch(const char* url, CSLConstList, GDALProgressFunc, void*, CPLHTTPFetchWriteFunc,
                            void*, void*) {
  CPLError(CE_Failure, CPLE_NotSupported, "the web address %s is not followed", url);
  auto* result = static_cast<CPLHTTPResult*>(CPLCalloc(1, sizeof(CPLHTTPResult)));
  result->nStatus = 1;
  result->pszErrBuf = CPLStrdup("web addresses are not followed");
  return result;
}

}  // namespace

OfflineScope::OfflineScope() {
  for (const auto& [key, value] : kSettings) {
    const char* former = CPLGetThreadLocalConfigOption(key, nullptr);
    former_.emplace_back(former == nullptr ? std::nullopt : std::optional<std::string>(former));
    CPLSetThreadLocalConfigOption(key, value);
  }
  is_pushed_ = CPLHTTPPushFetchCallback(refuse_fetch, nullptr) != 0;
}

OfflineScope::~OfflineScope() {
  if (is_pushed_) CPLHTTPPopFetchCallback();
  for (std::size_t i = 0; i < kSettings.size(); ++i) {
    CPLSetThreadLocalConfigOption(kSettings[i].first, former_[i] ? former_[i]->c_str() : nullptr);
  }
}

}  // namespace mars
