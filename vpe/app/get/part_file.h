// An unfinished download, NAME.part, with what it is the beginning of in NAME.part.json.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "vpe/app/get/resume.h"

namespace vpe::app {

// Holds NAME.part, alone: throws std::runtime_error if another process holds it. An unfinished file stays for
// the next time, unless it is empty. All members throw base::FileError.
class PartFile {
 public:
  explicit PartFile(const std::filesystem::path& final_path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  const std::filesystem::path& path() const { return part_; }
  std::int64_t size() const { return size_; }

  // Returns what the file is the beginning of, or nullopt if that is not known.
  std::optional<PartState> state() const;
  // Stores it. Must be called before bytes of another version are written.
  void set_state(const PartState& state);

  // Drops the bytes from here on; the next ones follow there.
  void cut(std::int64_t bytes);
  void write(std::string_view bytes);

  // Gives the file its final name and removes the state. What had the name before is replaced.
  void publish();

 private:
  std::filesystem::path final_;
  std::filesystem::path part_;
  std::filesystem::path state_;
  int file_ = -1;
  std::int64_t size_ = 0;
};

}  // namespace vpe::app
