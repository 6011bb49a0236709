// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// Prints what is broken with its place and aborts. Called by EMBODY_VALIDATE only.
[[noreturn]] void report_broken_state(const char* what, const char* file, int line);

}  // namespace embody

/// Consistency that is costly to check: `check` is a Result that says what is broken. Checked in Debug builds, and
/// where fuzz targets count branches.
#if defined(EMBODY_VALIDATION)
#define EMBODY_VALIDATE(check)                                                                              \
    do {                                                                                                    \
        const auto checked = (check);                                                                       \
        if (!checked) ::embody::report_broken_state(checked.error().message().c_str(), __FILE__, __LINE__); \
    } while (false)
#else
#define EMBODY_VALIDATE(check) void(sizeof(check))
#endif
