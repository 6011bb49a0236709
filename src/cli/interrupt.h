// SPDX-License-Identifier: MIT
#pragma once

namespace embody::cli {

/// After this call Ctrl+C and SIGTERM do not end the program but make interrupted() true, so that a long command can
/// complete its files; a second signal ends the program at once.
void watch_interrupts();
bool interrupted();

}  // namespace embody::cli
