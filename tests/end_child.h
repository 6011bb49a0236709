// SPDX-License-Identifier: MIT
#pragma once

#include <unistd.h>

#if defined(EMBODY_COVERAGE)
extern "C" void __gcov_dump();
#endif

namespace embody::test {

/// Ends a process that a test has forked, without the cleanup of the test's own end. Its coverage is recorded.
[[noreturn]] inline void end_child(int code) {
#if defined(EMBODY_COVERAGE)
    __gcov_dump();
#endif
    _exit(code);
}

}  // namespace embody::test
