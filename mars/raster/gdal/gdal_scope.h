// Helpers for every use of GDAL: silence on stderr, the library's messages, pools of handles.
#pragma once

#include <functional>
#include <string>

#include "mars/sources/source.h"
#include "vpe/base/object_pool.h"

namespace mars {

// Keeps GDAL and PROJ from writing to stderr on this thread during its lifetime, and registers GDAL's drivers.
class GdalScope {
 public:
  GdalScope();
  ~GdalScope();
  GdalScope(const GdalScope&) = delete;
  GdalScope& operator=(const GdalScope&) = delete;

  // Returns the last message of the libraries, on one line, or "".
  std::string message() const { return last_message(); }

  // Does the same on a thread that has a scope elsewhere.
  static std::string last_message();
};

// Returns an error that says "PATH: OPERATION: WORDS; ADVICE". Empty words are left out.
SourceError source_error(const std::string& path, const std::string& operation, const std::string& words,
                         const std::string& advice);

// Holds GDAL's objects that only one thread at a time may use: datasets, coordinate transformations.
template <class T>
using GdalPool = vpe::base::ObjectPool<T, std::function<void(T*)>>;

}  // namespace mars
