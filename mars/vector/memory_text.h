// A text that GDAL reads like a file.
#pragma once

#include <string>

namespace mars {

// Holds a text as a file of GDAL's file system in memory, in a folder of its own: nothing lies beside it.
class MemoryText {
 public:
  // `file_name` is the last part of its name, from which some drivers take the name of a layer.
  MemoryText(std::string text, const std::string& file_name);
  ~MemoryText();
  MemoryText(const MemoryText&) = delete;
  MemoryText& operator=(const MemoryText&) = delete;

  const std::string& name() const { return name_; }

 private:
  std::string text_;
  std::string name_;
};

}  // namespace mars
