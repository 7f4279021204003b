// vpe-model-reader FILE UNIT_M UP [MEMORY_GB TIME_S]: writes the stream of a model (objects/files/mesh_stream.h) to standard
// output. Ends with status 1 where the stream has an error in place of a mesh, and 2 for a wrong use. For an OpenVDB file it
// becomes vpe-vdb-reader, with its limits (objects/reader/vdb).

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <optional>
#include <string>

#include "objects/reader/assimp_reader.h"
#include "objects/reader/refusal.h"

namespace {

constexpr double kMostTime_s = 1e6;
constexpr unsigned kWaitingPerTime = 5;  // for slow disks

// Returns NaN for anything but a number.
double number_of(const char* text) {
  double value = 0;
  const char* end = text + std::strlen(text);
  const auto parsed = std::from_chars(text, end, value);
  return parsed.ec == std::errc() && parsed.ptr == end ? value : std::numeric_limits<double>::quiet_NaN();
}

std::optional<objects::UpAxis> up_of(const std::string& word) {
  if (word == "auto") return objects::UpAxis::kAuto;
  if (word == "y") return objects::UpAxis::kY;
  if (word == "z") return objects::UpAxis::kZ;
  return {};
}

void limit(decltype(RLIMIT_AS) what, rlim_t soft, rlim_t hard) {
  rlimit former{};
  if (::getrlimit(what, &former) == 0) {
    hard = std::min(hard, former.rlim_max);
    soft = std::min(soft, hard);
  }
  const rlimit limits{soft, hard};
  ::setrlimit(what, &limits);
}

bool send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

objects::MeshStream refused(const std::string& reason, const std::string& advice) {
  objects::MeshStream stream;
  stream.error = reason;
  stream.advice = advice;
  return stream;
}

bool is_vdb(std::string_view file) { return file.ends_with(".vdb") || file.ends_with(".VDB"); }

// Returns only where there is no such program.
void become_vdb_reader(char** words) {
  std::error_code none;
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe", none).replace_filename("vpe-vdb-reader").string();
  ::execv(program.c_str(), words);
}

objects::MeshStream read(const char* file, const objects::ModelFileOptions& options) {
  try {
    return objects::read_with_assimp(file, options);
  } catch (const objects::Refusal& refusal) {
    return refused(refusal.what(), refusal.advice());
  } catch (const std::bad_alloc&) {
    return refused("reading it takes too much memory, or it claims more than it has",
                   "allow more memory, simplify the model, or export it again");
  } catch (const std::exception& error) {
    return refused(error.what(), "the file may be damaged; export it again");
  }
}

}  // namespace

int main(int count, char** words) {
  objects::ModelFileOptions options;
  const auto up = count >= 4 ? up_of(words[3]) : std::nullopt;
  if (count >= 4) options.unit_m = number_of(words[2]);
  if (count == 6) {
    options.memory_gb = number_of(words[4]);
    options.time_s = number_of(words[5]);
  }
  if ((count != 4 && count != 6) || !up || !(options.unit_m > 0) || !(options.memory_gb > 0) ||
      !(options.time_s >= 1 && options.time_s <= kMostTime_s)) {
    std::fputs("usage: vpe-model-reader FILE UNIT_M auto|y|z [MEMORY_GB TIME_S]\n", stderr);
    return 2;
  }
  options.up = *up;
  limit(RLIMIT_CORE, 0, 0);
#ifndef VPE_READER_WITHOUT_MEMORY_LIMIT  // sanitizers reserve more than any limit
  const auto memory_bytes = static_cast<rlim_t>(options.memory_gb * 1e9);
  limit(RLIMIT_AS, memory_bytes, memory_bytes);
#endif
  const auto most_time_s = static_cast<unsigned>(options.time_s);
  limit(RLIMIT_CPU, most_time_s, most_time_s + 5);
  ::alarm(kWaitingPerTime * most_time_s);

  if (is_vdb(words[1])) become_vdb_reader(words);
  const objects::MeshStream stream = is_vdb(words[1]) ? refused("this program was built without OpenVDB",
                                                                "install libopenvdb-dev and build it again")
                                                      : read(words[1], options);
  bool is_sent = true;
  objects::write_mesh_stream(stream,
                             [&](std::span<const std::uint8_t> bytes) { is_sent = is_sent && send(bytes); });
  return stream.error.empty() && is_sent ? 0 : 1;
}
