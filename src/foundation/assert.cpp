// SPDX-License-Identifier: MIT
#include "foundation/assert.h"

#include <cstdio>
#include <cstdlib>

namespace embody {

void report_broken_assertion(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken assertion: %s\n", file, line, condition);
    std::abort();
}

}  // namespace embody
