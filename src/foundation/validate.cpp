// SPDX-License-Identifier: MIT
#include "foundation/validate.h"

#include <cstdio>
#include <cstdlib>

namespace embody {

void report_broken_state(const char* what, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: broken state: %s\n", file, line, what);
    std::abort();
}

}  // namespace embody
