// Folders of unfinished work that several processes may want at once.
#pragma once

#include <cstdint>
#include <filesystem>

namespace vpe::app {

// Holds a folder for one process, or for all that share it, as long as it lives. The lock ends with the process.
// Holds nothing where the file system knows no locks.
//
// Typical usage:
//   const FolderLock lock("film.mp4.parts", FolderLock::Use::kAlone, "film.mp4");
class FolderLock {
 public:
  enum class Use : std::uint8_t {
    kAlone,   // no other process may hold the folder
    kShared,  // others may, but not alone
  };

  // Makes the folder unless it exists. Throws std::runtime_error that names `output` if another process holds
  // the folder.
  FolderLock(const std::filesystem::path& folder, Use use, const std::filesystem::path& output);
  // Removes the folder if it is held alone and empty.
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path folder_;
  Use use_;
  int file_ = -1;
};

}  // namespace vpe::app
