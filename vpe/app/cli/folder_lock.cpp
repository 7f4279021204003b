#include "vpe/app/cli/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>

#include "vpe/app/cli/output.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

// Returns true if the path still names the open folder: who held it before may have removed it.
bool is_still(const fs::path& folder, int file) {
  struct stat open {};
  struct stat named {};
  return ::fstat(file, &open) == 0 && ::stat(folder.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
         open.st_dev == named.st_dev;
}

}  // namespace

FolderLock::FolderLock(const fs::path& folder, Use use, const fs::path& output) : folder_(folder), use_(use) {
  const int operation = (use == Use::kAlone ? LOCK_EX : LOCK_SH) | LOCK_NB;
  for (;;) {
    make_folder(folder_);
    file_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (file_ < 0) {
      if (errno == ENOENT) continue;
      return;  // whoever reads or writes there reports the reason
    }
    int result = 0;
    while ((result = ::flock(file_, operation)) != 0 && errno == EINTR) {
    }
    if (result != 0 && errno == EWOULDBLOCK) {
      ::close(file_);
      throw std::runtime_error(output.string() + ": another vpe is making it, in '" + folder_.string() +
                               "'; wait for it, or give another output name");
    }
    if (is_still(folder_, file_)) return;
    ::close(file_);
  }
}

FolderLock::~FolderLock() {
  if (file_ < 0) return;
  std::error_code error;
  if (use_ == Use::kAlone && is_still(folder_, file_)) fs::remove(folder_, error);  // fails when it holds files
  ::close(file_);
}

}  // namespace vpe::app
