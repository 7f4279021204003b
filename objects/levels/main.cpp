// vpe-model-levels MEMORY_GB TIME_S: reads the stream of a mesh (objects/files/mesh_stream.h) from standard input and writes
// that of its coarser levels (objects/files/level_stream.h) to standard output. Ends with status 1 where memory is too
// short, and 2 for a wrong use.

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include "objects/files/child_limits.h"
#include "objects/files/level_stream.h"
#include "objects/files/mesh_stream.h"
#include "objects/levels/mesh_levels.h"

namespace {

std::vector<std::uint8_t> read_input() {
  std::vector<std::uint8_t> bytes;
  std::size_t size = 0;
  for (;;) {
    if (size == bytes.size()) bytes.resize(size == 0 ? std::size_t{1} << 20 : 2 * size);
    const ssize_t count = ::read(STDIN_FILENO, bytes.data() + size, bytes.size() - size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    size += static_cast<std::size_t>(count);
  }
  bytes.resize(size);
  return bytes;
}

bool make_and_send() {
  objects::MeshStream input = objects::read_mesh_stream(read_input());
  const std::vector<objects::MeshLevel> levels = objects::make_levels(std::move(input.mesh));
  bool is_sent = true;
  objects::write_level_stream(
      levels, [&](std::span<const std::uint8_t> bytes) { is_sent = is_sent && objects::send_output(bytes); });
  return is_sent;
}

}  // namespace

int main(int count, char** words) {
  const double memory_gb = count == 3 ? objects::number_of(words[1]) : 0;
  const double time_s = count == 3 ? objects::number_of(words[2]) : 0;
  if (!(memory_gb > 0) || !(time_s >= 1 && time_s <= objects::kMostChildTime_s)) {
    std::fputs("usage: vpe-model-levels MEMORY_GB TIME_S < MESH > LEVELS\n", stderr);
    return 2;
  }
  objects::limit_this_process(memory_gb, time_s);
  try {
    return make_and_send() ? 0 : 3;
  } catch (const std::bad_alloc&) {
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vpe-model-levels: %s\n", error.what());
    return 2;
  }
}
