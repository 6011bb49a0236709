// SPDX-License-Identifier: MIT
#include "crash.h"

#include <dlfcn.h>
#include <execinfo.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

// Defined by the address sanitizer where the program is built with it.
extern "C" __attribute__((weak)) const char* __asan_get_report_description();
extern "C" __attribute__((weak)) int __asan_report_present();

namespace embody::fuzz {
namespace {

LastWords* words = nullptr;

/// Whether a failure in the module is the fault of its caller.
bool serves_others(std::string_view module) {
    for (const char* name :
         {"libc.so", "libm.so", "libpthread", "ld-linux", "libstdc++", "libgcc_s", "libasan", "libubsan", "vdso"}) {
        if (module.starts_with(name) || module.find("vdso") != std::string_view::npos) return true;
    }
    return false;
}

/// The operators new and delete are defined in this program (sanitizer.cpp), whoever calls them.
bool is_allocation(const char* symbol) {
    return symbol != nullptr &&
           (std::string_view(symbol).starts_with("_Zn") || std::string_view(symbol).starts_with("_Zd"));
}

template <std::size_t size>
void copy(std::array<char, size>& to, const char* text) {
    std::strncpy(to.data(), text, size - 1);
    to.back() = '\0';
}

void tell(int signal) {
    // A signal handler should not do so much, but the process ends in any case; where it hangs, the parent ends it.
    copy(words->signal, sigabbrev_np(signal) == nullptr ? "?" : sigabbrev_np(signal));
    if (__asan_report_present != nullptr && __asan_report_present() != 0)
        copy(words->signal, __asan_get_report_description());
    std::array<void*, 256> frames{};
    const int count = backtrace(frames.data(), static_cast<int>(frames.size()));
    bool is_below_this = false;
    for (int i = 0; i < count; ++i) {
        Dl_info where{};
        if (dladdr(frames[static_cast<std::size_t>(i)], &where) == 0 || where.dli_fname == nullptr) continue;
        const char* slash = std::strrchr(where.dli_fname, '/');
        const char* module = slash == nullptr ? where.dli_fname : slash + 1;
        if (serves_others(module) || is_allocation(where.dli_sname)) continue;
        // The program's first frame is this function, called by the system.
        if (!std::exchange(is_below_this, true)) continue;
        copy(words->module, module);
        break;
    }
    backtrace_symbols_fd(frames.data(), std::min(count, 24), STDERR_FILENO);
    _exit(99);
}

}  // namespace

void watch_crashes(LastWords* last_words) {
    words = last_words;
    // The first call of backtrace() loads a library, which a signal handler should not do.
    std::array<void*, 1> none{};
    backtrace(none.data(), 1);
    static std::array<std::uint8_t, 1 << 18> own_stack;
    const stack_t stack{.ss_sp = own_stack.data(), .ss_flags = 0, .ss_size = own_stack.size()};
    sigaltstack(&stack, nullptr);
    struct sigaction action {};
    action.sa_handler = tell;
    action.sa_flags = SA_ONSTACK | SA_RESETHAND | SA_NODEFER;
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGALRM, SIGTRAP})
        sigaction(signal, &action, nullptr);
}

}  // namespace embody::fuzz
