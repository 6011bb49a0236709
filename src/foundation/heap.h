// SPDX-License-Identifier: MIT
#pragma once

namespace embody {

/// For a program that steps worlds: memory that was freed stays with the process for what is asked for next. Without,
/// the C library may give it back to the system several times a step, and each page that is touched again costs a
/// fault: about an eighth of a step of soft solids or of a liquid (docs/performance.md, "Memory that is freed"). Only
/// where the C library is glibc; nothing happens elsewhere.
void keep_freed_memory();

}  // namespace embody
