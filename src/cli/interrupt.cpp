// SPDX-License-Identifier: MIT
#include "cli/interrupt.h"

#include <csignal>

namespace embody::cli {
namespace {

volatile std::sig_atomic_t signalled = 0;

void note_interrupt(int signal) {
    signalled = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_interrupts() {
    std::signal(SIGINT, note_interrupt);
    std::signal(SIGTERM, note_interrupt);
}

bool interrupted() { return signalled != 0; }

}  // namespace embody::cli
