#include "vpe/app/planet/planet_argument.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <functional>

#include "mars/embedded/embedded.h"
#include "vpe/app/cli/parsing.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/base/user_folders.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

// The first is raised whenever the builder or the embedded planet changes the content of a cached file, the
// second whenever rasters are interpreted differently.
constexpr int kCacheGeneration = 3;
constexpr int kRasterGeneration = 3;

class FileLock {
 public:
  explicit FileLock(const fs::path& path) : fd_(::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (fd_ < 0) throw std::runtime_error(path.string() + ": cannot open: " + std::strerror(errno));
    while (::flock(fd_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  ~FileLock() { ::close(fd_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_;
};

std::string hex(std::uint64_t x) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(x));
  return text;
}

void build_into(const fs::path& target, const std::string& what,
                std::shared_ptr<const mars::ElevationSource> elevation, const mars::ImageSource* image,
                const Common& common) {
  paging::BuildOptions options;
  const mars::Combined combined = combine_sources({std::move(elevation)}, {}, options);
  if (!common.quiet) {
    std::fprintf(stderr, "Building %s once, into %s\n", what.c_str(), target.c_str());
    print_findings(combined);
  }
  options.output = target.string();
  options.threads = common.threads;
  run_build(options, *combined.source, image, common);
}

std::shared_ptr<const paging::PlanetFile> cached(const std::string& name, const std::string& what,
                                                 const std::function<void(const fs::path&)>& build) {
  const fs::path folder = cache_folder();
  const fs::path target = folder / (name + ".vpe");
  const FileLock lock(folder / (name + ".lock"));
  if (fs::exists(target)) {
    try {
      return paging::PlanetFile::open(target.string());
    } catch (const paging::PlanetError& e) {
      std::fprintf(stderr, "vpe: %s; building %s again\n", e.what(), what.c_str());
    }
  }
  build(target);
  return paging::PlanetFile::open(target.string());
}

}  // namespace

fs::path cache_folder() {
  const fs::path folder = base::user_folder(base::UserFolder::kCache);
  if (folder.empty())
    throw std::runtime_error("no cache folder: set HOME or XDG_CACHE_HOME to an absolute path");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder.string() + ": cannot make the cache folder: " + error.message());
  return folder;
}

fs::path embedded_planet_path() {
  return cache_folder() / ("embedded-mars-" + std::to_string(kCacheGeneration) + ".vpe");
}

std::shared_ptr<const paging::PlanetFile> open_planet(const std::string& argument, const Common& common) {
  if (argument.empty()) {
    return cached(embedded_planet_path().stem().string(), "the embedded Mars (an illustration)",
                  [&](const fs::path& target) {
                    build_into(target, "the embedded Mars (an illustration)", mars::embedded_elevation(),
                               mars::embedded_image().get(), common);
                  });
  }
  if (argument.ends_with(".vpe") || is_sqlite(argument)) return paging::PlanetFile::open(argument);
  const auto source = mars::open_elevation(argument);
  const mars::SourceInfo info = source->infos().front();
  const std::string path = fs::weakly_canonical(argument).string();
  const std::string identity = path + '\n' + std::to_string(info.size_bytes) + '\n' +
                               std::to_string(info.mtime_s) + '\n' + std::to_string(kCacheGeneration) + '\n' +
                               std::to_string(kRasterGeneration);
  const std::int64_t sum =
      paging::checksum(0, std::span(reinterpret_cast<const std::uint8_t*>(identity.data()), identity.size()));
  const std::string name = fs::path(argument).stem().string() + "-" + hex(static_cast<std::uint64_t>(sum));
  return cached(name, argument,
                [&](const fs::path& target) { build_into(target, argument, source, nullptr, common); });
}

void note_illustration(const paging::PlanetMeta& meta, bool quiet) {
  if (!meta.illustration || quiet) return;
  std::fprintf(stderr, "Note: this planet is an illustration; its numbers are not data about Mars.\n");
}

}  // namespace vpe::app
