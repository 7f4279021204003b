// How this process gives memory back to the system.
#pragma once

#include <cstddef>

namespace vpe::base {

// Blocks of this size and more are asked of the system one by one by keep_heap_compact().
inline constexpr std::size_t kOwnBlockBytes = std::size_t{64} << 10;

// From now on large blocks go back to the system as soon as they are freed. Else the C library keeps them in
// its heap, where tiles that come and go leave holes: on a flight of ten minutes they grew to as much as the
// tiles themselves (docs/paging.md). For the whole process; any thread, any number of times. Does nothing where
// the C library has no such choice.
void keep_heap_compact();

}  // namespace vpe::base
