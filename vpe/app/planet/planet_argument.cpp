#include "vpe/app/planet/planet_argument.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <span>
#include <thread>

#include "mars/embedded/data_files.h"
#include "mars/embedded/embedded.h"
#include "mars/remote/gdal_remote.h"
#include "mars/sources/source.h"
#include "paging/planet/planet_database.h"
#include "vpe/app/planet/build_sources.h"
#include "vpe/app/planet/planet_build.h"
#include "vpe/app/planet/remote_wait.h"
#include "vpe/base/parallel.h"
#include "vpe/base/user_folders.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

// The first is raised whenever the builder or the embedded planet changes the content of a cached file, the
// second whenever rasters are interpreted differently.
constexpr int kCacheGeneration = 6;
constexpr int kRasterGeneration = 3;

const std::vector<std::string> kEmbeddedArguments{"embedded", "--image=embedded"};

constexpr std::chrono::milliseconds kLockRetry{50};

// Ends a build that was asked to stop.
struct Stopped {};

class FileLock {
 public:
  // Waits for the lock; calls `waits` once if another process has it. Throws Stopped once a stop is requested.
  FileLock(const fs::path& path, const std::stop_token& stop, const std::function<void()>& waits)
      : fd_(::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (fd_ < 0) fail("open", path);
    const bool may_stop = stop.stop_possible();
    bool is_first = true;
    int failed = 0;
    while ((failed = ::flock(fd_, may_stop || is_first ? LOCK_EX | LOCK_NB : LOCK_EX)) != 0) {
      if (errno == EWOULDBLOCK && std::exchange(is_first, false)) {
        waits();
      } else if (may_stop && errno == EWOULDBLOCK) {
        std::this_thread::sleep_for(kLockRetry);
      } else if (errno != EINTR) {
        break;
      }
      if (!stop.stop_requested()) continue;
      ::close(fd_);
      throw Stopped();
    }
    if (failed == 0) return;
    const int error = errno;
    ::close(fd_);
    errno = error;
    fail("lock", path);
  }
  ~FileLock() { ::close(fd_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  [[noreturn]] static void fail(const std::string& operation, const fs::path& path) {
    throw std::runtime_error(path.string() + ": cannot " + operation + ": " + std::strerror(errno) +
                             "; set XDG_CACHE_HOME to a folder that can be written to, or make a planet file "
                             "with 'vpe build' and give that");
  }

  int fd_;
};

std::string hex(std::uint64_t x) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(x));
  return text;
}

void build_into(const fs::path& target, const std::string& what, const std::vector<std::string>& arguments,
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
  options.arguments = arguments;
  run_build(options, *combined.source, image, common);
}

// Builds the embedded Mars without messages.
void build_embedded(const fs::path& target, paging::BuildOptions options,
                    const paging::ProgressFunction& progress) {
  const mars::Combined combined = combine_sources({mars::embedded_elevation()}, {}, options);
  options.output = target.string();
  options.arguments = kEmbeddedArguments;
  paging::build_planet(options, *combined.source, mars::embedded_image().get(), progress);
}

// Opens a planet of the cache. Returns null if it is not there, or, after a note, if it is damaged.
std::shared_ptr<const paging::PlanetFile> find_cached(const fs::path& target, const std::string& what) {
  std::error_code none;
  if (!fs::exists(target, none)) return nullptr;
  try {
    return paging::PlanetFile::open(target.string());
  } catch (const paging::PlanetError& e) {
    std::fprintf(stderr, "vpe: %s; building %s again\n", e.what(), what.c_str());
    return nullptr;
  }
}

// Opens the planet of this name in the cache; builds it first if it is not there, or unless it may be reused.
std::shared_ptr<const paging::PlanetFile> cached(const std::string& name, const std::string& what,
                                                 bool may_reuse, bool quiet,
                                                 const std::function<void(const fs::path&)>& build,
                                                 const std::stop_token& stop = {}) {
  const fs::path folder = cache_folder();
  const fs::path target = folder / (name + ".vpe");
  // Without the lock: a cache that may not be written to can be read. Planets appear in it when complete.
  if (may_reuse) {
    if (auto planet = find_cached(target, what)) return planet;
  }
  const FileLock lock(folder / (name + ".lock"), stop, [&] {
    if (!quiet) std::fprintf(stderr, "vpe: note: another vpe is building %s; waiting for it\n", what.c_str());
  });
  if (may_reuse) {
    if (auto planet = find_cached(target, what)) return planet;  // of a process that built it meanwhile
  }
  build(target);
  return paging::PlanetFile::open(target.string());
}

// Returns a name that is different for every raster and state of its files.
std::string cache_name(const std::string& raster, const mars::RasterState& state) {
  std::error_code none;
  // What is not a path of a file ("NETCDF:x.nc:z") may name one relative to the current folder; a URL does not.
  const bool is_url = mars::is_remote(mars::raster_name(raster));
  const std::string place = is_url                     ? raster
                            : fs::exists(raster, none) ? fs::weakly_canonical(raster).string()
                                                       : raster + '\n' + fs::current_path(none).string();
  const std::string identity =
      place + '\n' + state.text + std::to_string(kCacheGeneration) + '\n' + std::to_string(kRasterGeneration);
  const std::int64_t sum =
      paging::checksum(0, std::span(reinterpret_cast<const std::uint8_t*>(identity.data()), identity.size()));
  return fs::path(raster).stem().string() + "-" + hex(static_cast<std::uint64_t>(sum));
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
  // A planet that was built without the carried data must not stand for one with them.
  const bool is_complete = std::ranges::all_of(
      mars::kEmbeddedFiles, [](const char* name) { return !mars::find_data_file(name).empty(); });
  return cache_folder() /
         ("embedded-mars-" + std::to_string(kCacheGeneration) + (is_complete ? "" : "-without-data") + ".vpe");
}

std::shared_ptr<const paging::PlanetFile> coarse_embedded_planet(const Common& common) {
  constexpr double kCoarse_m = 21'000;
  std::error_code none;
  const fs::path complete = embedded_planet_path();
  if (fs::exists(complete, none)) return nullptr;
  if (const std::string file = mars::find_data_file("coarse-mars.vpe"); !file.empty()) {
    try {
      auto planet = paging::PlanetFile::open(file);
      if (planet->meta().program == version()) return planet;
    } catch (const paging::PlanetError&) {
      // It is made again.
    }
  }
  return cached(complete.stem().string() + "-coarse", "the coarse embedded Mars", true, common.quiet,
                [&](const fs::path& target) {
                  paging::BuildOptions options;
                  options.threads = common.threads;
                  options.base_spacing_m = kCoarse_m;
                  options.finest_spacing_m = kCoarse_m;
                  options.finest_image_m = kCoarse_m / 2;
                  options.resampling_posts = 10'000;
                  build_embedded(target, options, {});
                });
}

std::shared_ptr<const paging::PlanetFile> build_embedded_planet(const Common& common, std::stop_token stop,
                                                                const std::function<void(double)>& tell) {
  try {
    return cached(
        embedded_planet_path().stem().string(), "the embedded Mars", true, common.quiet,
        [&](const fs::path& target) {
          paging::BuildOptions options;
          options.threads = common.threads > 0 ? common.threads : std::max(1, base::default_threads() - 1);
          options.resampling_posts = kSyntheticResamplingPosts;
          build_embedded(target, options, [&](const paging::BuildProgress& progress) {
            if (stop.stop_requested()) throw Stopped();
            if (tell) tell(progress.fraction);
          });
        },
        stop);
  } catch (const Stopped&) {
    return nullptr;
  }
}

std::shared_ptr<const paging::PlanetFile> open_planet(const std::string& argument, const Common& common) {
  if (argument.empty()) {
    return cached(embedded_planet_path().stem().string(), "the embedded Mars", true, common.quiet,
                  [&](const fs::path& target) {
                    build_into(target, "the embedded Mars", kEmbeddedArguments, mars::embedded_elevation(),
                               mars::embedded_image().get(), common);
                  });
  }
  if (!is_raster_argument(argument)) {
    require_local_planet(argument);
    return paging::PlanetFile::open(argument);
  }
  watch_remote_reads(common.quiet);
  // Before the raster is opened: what is read is then never older than the state.
  const mars::RasterState state = mars::raster_state(argument);
  if (!state.is_certain && !common.quiet) {
    std::fprintf(
        stderr,
        "vpe: note: %s does not state when it was changed, so its planet is built by every command; 'vpe "
        "build' makes a planet file to keep\n",
        argument.c_str());
  }
  return cached(cache_name(argument, state), argument, state.is_certain, common.quiet,
                [&](const fs::path& target) {
                  limit_rasters(common);
                  build_into(target, argument, {argument}, mars::open_elevation(argument), nullptr, common);
                });
}

bool is_raster_argument(const std::string& argument) {
  return !argument.empty() && !argument.ends_with(".vpe") && !paging::is_planet_database(argument);
}

void note_illustration(const paging::PlanetMeta& meta, bool quiet) {
  if (!meta.illustration || quiet) return;
  const auto is_data = [](const mars::SourceInfo& source) { return !source.illustration; };
  const auto data = std::find_if(meta.sources.begin(), meta.sources.end(), is_data);
  if (data == meta.sources.end()) {
    std::fprintf(stderr, "vpe: note: this planet is an illustration; its numbers are not data about Mars\n");
    return;
  }
  std::fprintf(
      stderr,
      "vpe: note: this planet is %s; ground smaller than its posts, %.0f m apart, is synthetic where 'vpe query' "
      "names another source\n",
      data->name.c_str(), data->resolution_m);
}

}  // namespace vpe::app
