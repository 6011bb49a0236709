// SPDX-License-Identifier: MIT
#pragma once

namespace embody::cli {

/// From now on Ctrl+C and SIGTERM do not end the program but make interrupted() true, so that a long command can end
/// with whole files; a second one ends it at once.
void watch_interrupts();
bool interrupted();

}  // namespace embody::cli
