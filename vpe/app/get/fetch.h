// Fetching of files: with retries, continued where it was interrupted, and verified.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "vpe/app/get/http_request.h"
#include "vpe/app/get/product_files.h"

namespace vpe::app {

// Holds how files are fetched. Each default is that of the option of `vpe get` that sets it, if there is one.
struct FetchOptions {
  HttpLimits http;
  int retries = 5;                     // in a row without progress, 0 .. 1000
  double retry_wait_s = 1;             // before the first of them; doubles each time
  double longest_wait_s = 60;          // to which it grows
  double longest_retry_after_s = 300;  // for which a server may ask; longer: it is given up
  bool is_forced = false;              // finished files are fetched anew
  bool checks_kept = false;            // checksums of files that are kept are verified too
  bool uses_checksums = true;
  bool quiet = false;  // nothing is said on stderr
};

// Says what became of a file.
struct FetchedFile {
  std::filesystem::path path;
  std::int64_t bytes = 0;
  bool is_kept = false;  // it was there
  std::string checksum;  // "MD5 ..." or "SHA-256 ..." if it was verified, else empty
};

// Called with the bytes of the file that are there, while it is fetched or verified.
using FetchProgress = std::function<void(const std::string& what, std::int64_t bytes)>;

// Fetches a file into a folder, which must exist. It gets its name when it is complete and its size and
// checksum are right; before that it is NAME.part, from which a later call continues. A finished file of the
// right size is kept. Throws std::runtime_error that names the file and says what to do, base::FileError, and
// Interrupted; NAME.part stays.
FetchedFile fetch_file(const RemoteFile& file, const std::filesystem::path& folder, const FetchOptions& options,
                       const FetchProgress& progress);

// Returns the bytes that are still to be fetched, as far as the catalogue knows.
std::int64_t bytes_to_fetch(const RemoteFile& file, const std::filesystem::path& folder,
                            const FetchOptions& options);

}  // namespace vpe::app
