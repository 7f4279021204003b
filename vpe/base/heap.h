// The policy by which this process returns freed memory to the system.
#pragma once

#include <cstddef>

namespace vpe::base {

// After keep_heap_compact(), blocks of this size and more are allocated from the system one by one.
inline constexpr std::size_t kOwnBlockBytes = std::size_t{64} << 10;

// Makes large blocks return to the system as soon as they are freed. By default the C library keeps them in its
// heap, which fragments when tiles come and go: on a flight of ten minutes the unused memory grew to as much as
// the tiles themselves (docs/measurements/paging.md). Affects the whole process. Any thread may call it, any
// number of times. Does nothing where the C library has no such option.
void keep_heap_compact();

// Returns memory that was freed to the system, as after motion through many tiles. May take milliseconds. Any thread may
// call it. Does nothing where the C library has no such function.
void return_freed_memory();

}  // namespace vpe::base
