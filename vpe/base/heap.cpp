#include "vpe/base/heap.h"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace vpe::base {

void keep_heap_compact() {
#if defined(__GLIBC__)
  // Setting the threshold also stops the C library from raising it with the blocks that are freed.
  mallopt(M_MMAP_THRESHOLD, static_cast<int>(kOwnBlockBytes));
#endif
}

void return_freed_memory() {
#if defined(__GLIBC__)
  malloc_trim(0);
#endif
}

}  // namespace vpe::base
