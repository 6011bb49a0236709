// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// Prints the broken condition with its place and aborts. Called by EMBODY_ASSERT only.
[[noreturn]] void report_broken_assertion(const char* condition, const char* file, int line);

}  // namespace embody

/// A programmer's error, never bad input (that is a Result). Checked in Debug and RelWithDebInfo builds.
#if defined(EMBODY_ASSERTIONS)
#define EMBODY_ASSERT(condition) \
    ((condition) ? void(0) : ::embody::report_broken_assertion(#condition, __FILE__, __LINE__))
#else
#define EMBODY_ASSERT(condition) void(sizeof(condition))
#endif
