// SPDX-License-Identifier: MIT
#include "foundation/heap.h"

#include <cstdlib>  // tells whether it is glibc

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace embody {

void keep_freed_memory() {
#if defined(__GLIBC__)
    constexpr int most_unused = 1 << 30;  // bytes at the end of a heap
    constexpr int least_mapped =
        32 << 20;  // bytes of one piece from which the system maps it: the most that glibc takes
    mallopt(M_TRIM_THRESHOLD, most_unused);
    mallopt(M_MMAP_THRESHOLD, least_mapped);
#endif
}

}  // namespace embody
