// SPDX-License-Identifier: MIT
// Behaviour of the sanitizers in fuzz targets that are built with them: every report ends the process by SIGABRT, and
// exhausted memory throws std::bad_alloc, as in the program. (The address sanitizer's own `new` ends the process.)
#include <cstdlib>
#include <new>

extern "C" const char* __asan_default_options() {
    return "abort_on_error=1:handle_segv=0:handle_sigbus=0:handle_sigfpe=0:handle_sigill=0:handle_abort=0:use_"
           "sigaltstack=0:"
           "allocator_may_return_null=1:max_allocation_size_mb=2048:soft_rss_limit_mb=3072:detect_leaks=0:"
           "detect_stack_use_after_return=0";
}
extern "C" const char* __ubsan_default_options() { return "abort_on_error=1:print_stacktrace=1:handle_abort=0"; }

#ifdef __SANITIZE_ADDRESS__

void* operator new(std::size_t size) {
    if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
    throw std::bad_alloc();
}
void* operator new[](std::size_t size) { return operator new(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size == 0 ? 1 : size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return std::malloc(size == 0 ? 1 : size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { std::free(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { std::free(memory); }

#endif
