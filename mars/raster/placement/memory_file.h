// A file of GDAL's file system in memory.
#pragma once

#include <string>

namespace mars {

// Has a name that no other file has, and removes what was written under it.
class MemoryFile {
 public:
  explicit MemoryFile(const std::string& extension);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace mars
