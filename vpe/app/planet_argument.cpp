#include "vpe/app/planet_argument.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "mars/embedded.h"
#include "vpe/app/build_sources.h"
#include "vpe/app/planet_build.h"
#include "vpe/core/number.h"
#include "vpe/core/user_folders.h"

namespace vpe::app {

namespace fs = std::filesystem;

namespace {

// Raised whenever the builder or the embedded planet changes what a cached file would hold; the second whenever
// rasters are understood in another way.
constexpr int kCacheGeneration = 3;
constexpr int kRasterGeneration = 2;

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

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

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
    say_findings(combined);
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

bool is_sqlite(const std::string& path) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  char head[16] = {};
  return file && std::fread(head, 1, sizeof head, file.get()) == sizeof head &&
         std::memcmp(head, "SQLite format 3", 16) == 0;
}

fs::path cache_folder() {
  const fs::path folder = core::user_folder(core::UserFolder::kCache);
  if (folder.empty()) throw std::runtime_error("no cache folder: set HOME or XDG_CACHE_HOME to an absolute path");
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
  if (ends_with(argument, ".vpe") || is_sqlite(argument)) return paging::PlanetFile::open(argument);
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

std::optional<std::vector<double>> parse_numbers(const std::string& text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = core::parse_number(std::string_view(text).substr(begin, end - begin));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

std::optional<mars::LonLat> parse_place(const std::string& text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 2) return std::nullopt;
  return mars::LonLat{(*numbers)[0], (*numbers)[1]};
}

}  // namespace vpe::app
