// SPDX-License-Identifier: MIT
#include "foundation/heap.h"

#include <cstdlib>  // tells whether it is glibc

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace embody {

void keep_freed_memory() {
#if defined(__GLIBC__)
    constexpr int max_unused = 1 << 30;   // bytes at the end of a heap
    constexpr int min_mapped = 32 << 20;  // bytes of a piece that the system maps alone: glibc takes no larger limit
    mallopt(M_TRIM_THRESHOLD, max_unused);
    mallopt(M_MMAP_THRESHOLD, min_mapped);
#endif
}

}  // namespace embody
