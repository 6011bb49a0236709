// SPDX-License-Identifier: MIT
// seccomp filters: Linux, Documentation/userspace-api/seccomp_filter.rst. Landlock: landlock.rst beside it.
#include "catalog/prepare/confinement.h"

#include <fcntl.h>
#include <linux/landlock.h>
#include <sched.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>

namespace embody::catalog {
namespace {

Error failure(const std::string& what, int code) { return {"import worker", what + ": " + std::strerror(code)}; }

Result<void> limit(int resource, rlim_t value, const char* name) {
    // Never above what the user already has.
    rlimit now{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &now) == 0 && now.rlim_max < value) value = now.rlim_max;
    const rlimit wanted{value, value};
    if (setrlimit(static_cast<__rlimit_resource>(resource), &wanted) != 0) return failure(name, errno);
    return {};
}

Result<void> set_limits(const ConfinementOptions& options) {
    for (const Result<void>& done :
         {limit(RLIMIT_AS, options.address_space, "RLIMIT_AS"),
          limit(RLIMIT_CPU, options.processor_seconds, "RLIMIT_CPU"), limit(RLIMIT_CORE, 0, "RLIMIT_CORE"),
          limit(RLIMIT_FSIZE, 0, "RLIMIT_FSIZE"), limit(RLIMIT_NOFILE, 64, "RLIMIT_NOFILE")}) {
        if (!done) return done.error();
    }
    return {};
}

/// Where the system runs out of memory nonetheless, it ends workers before anything else of the user's.
void be_ended_first() { std::ofstream("/proc/self/oom_score_adj") << 1000; }

Result<void> end_with(long parent) {
    if (prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return failure("PR_SET_PDEATHSIG", errno);
    // It may have died before that line.
    if (getppid() != parent) return Error{"import worker", "its parent is gone"};
    return {};
}

// All that Landlock's first version knows; later ones add what the system call filter forbids already.
constexpr std::uint64_t reading = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t all_access = (LANDLOCK_ACCESS_FS_MAKE_SYM << 1) - 1;

/// From now on only these files and what lies in these folders can be opened. What does not exist cannot be allowed.
Result<void> limit_reading(const std::vector<std::string>& readable) {
    if (readable.empty()) return {};
    const landlock_ruleset_attr attributes{.handled_access_fs = all_access};
    const long ruleset = syscall(SYS_landlock_create_ruleset, &attributes, sizeof attributes, 0);
    // An older kernel, or one that was started without.
    if (ruleset < 0) return {};
    for (const std::string& path : readable) {
        const int place = open(path.c_str(), O_PATH | O_CLOEXEC);
        if (place < 0) continue;
        landlock_path_beneath_attr rule{.allowed_access = reading, .parent_fd = place};
        // A file has no entries to list.
        if (syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0) {
            rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
            syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
        }
        close(place);
    }
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return failure("PR_SET_NO_NEW_PRIVS", errno);
    if (syscall(SYS_landlock_restrict_self, ruleset, 0) != 0) return failure("landlock_restrict_self", errno);
    close(static_cast<int>(ruleset));
    return {};
}

struct FilterRelease {
    void operator()(void* filter) const { seccomp_release(filter); }
};

// Memory, threads of the own process, time, and what a file that is open allows.
constexpr int allowed_calls[] = {SCMP_SYS(read),
                                 SCMP_SYS(readv),
                                 SCMP_SYS(pread64),
                                 SCMP_SYS(write),
                                 SCMP_SYS(writev),
                                 SCMP_SYS(close),
                                 SCMP_SYS(lseek),
                                 SCMP_SYS(fstat),
                                 SCMP_SYS(newfstatat),
                                 SCMP_SYS(stat),
                                 SCMP_SYS(lstat),
                                 SCMP_SYS(statx),
                                 SCMP_SYS(access),
                                 SCMP_SYS(faccessat),
                                 SCMP_SYS(faccessat2),
                                 SCMP_SYS(readlink),
                                 SCMP_SYS(readlinkat),
                                 SCMP_SYS(getcwd),
                                 SCMP_SYS(getdents64),
                                 SCMP_SYS(fcntl),
                                 SCMP_SYS(fadvise64),
                                 SCMP_SYS(poll),
                                 SCMP_SYS(ppoll),
                                 SCMP_SYS(munmap),
                                 SCMP_SYS(mremap),
                                 SCMP_SYS(brk),
                                 SCMP_SYS(madvise),
                                 SCMP_SYS(futex),
                                 SCMP_SYS(set_robust_list),
                                 SCMP_SYS(rseq),
                                 SCMP_SYS(sched_yield),
                                 SCMP_SYS(sched_getaffinity),
                                 SCMP_SYS(rt_sigaction),
                                 SCMP_SYS(rt_sigprocmask),
                                 SCMP_SYS(rt_sigreturn),
                                 SCMP_SYS(sigaltstack),
                                 SCMP_SYS(restart_syscall),
                                 SCMP_SYS(clock_gettime),
                                 SCMP_SYS(clock_nanosleep),
                                 SCMP_SYS(nanosleep),
                                 SCMP_SYS(gettimeofday),
                                 SCMP_SYS(getrandom),
                                 SCMP_SYS(getpid),
                                 SCMP_SYS(gettid),
                                 SCMP_SYS(sysinfo),
                                 SCMP_SYS(exit),
                                 SCMP_SYS(exit_group)};

/// A condition on an argument of a system call, counted from 0. The library's macros for it are C, not C++.
scmp_arg_cmp argument(unsigned int place, scmp_compare comparison, scmp_datum_t a, scmp_datum_t b = 0) {
    return {place, comparison, a, b};
}

/// Adds the calls that are allowed for some arguments only; the first error code, or 0.
int allow_in_part(scmp_filter_ctx filter) {
    constexpr scmp_datum_t writing = O_ACCMODE | O_CREAT | O_TRUNC | O_APPEND | (O_TMPFILE & ~O_DIRECTORY);
    const auto without_exec = argument(2, SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    int code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(openat), 1,
                                argument(2, SCMP_CMP_MASKED_EQ, writing, O_RDONLY));
    if (code == 0)
        code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(open), 1,
                                argument(1, SCMP_CMP_MASKED_EQ, writing, O_RDONLY));
    if (code == 0) code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mmap), 1, without_exec);
    if (code == 0) code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(mprotect), 1, without_exec);
    // Threads, not processes; clone3 hides its flags from filters, and the C library falls back to clone without it.
    if (code == 0)
        code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(clone), 1,
                                argument(0, SCMP_CMP_MASKED_EQ, CLONE_THREAD, CLONE_THREAD));
    if (code == 0) code = seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
    // Signals to itself: how abort() ends it.
    const auto itself = argument(0, SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid()));
    if (code == 0) code = seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1, itself);
    return code;
}

Result<void> filter_system_calls() {
    const std::unique_ptr<void, FilterRelease> filter(seccomp_init(SCMP_ACT_ERRNO(EPERM)));
    if (filter == nullptr) return Error{"import worker", "cannot make a system call filter"};
    int code = 0;
    for (const int call : allowed_calls) {
        if (code == 0) code = seccomp_rule_add(filter.get(), SCMP_ACT_ALLOW, call, 0);
    }
    if (code == 0) code = allow_in_part(filter.get());
    if (code == 0) code = seccomp_load(filter.get());
    if (code != 0) return failure("cannot filter system calls", -code);
    return {};
}

}  // namespace

Result<void> confine_this_process(const ConfinementOptions& options) {
    if (const auto bound = end_with(options.parent); !bound) return bound.error();
    // Whatever the parent had open and forgot to close: sockets, databases.
    if (close_range(3, ~0u, 0) != 0) return failure("close_range", errno);
    be_ended_first();
    if (const auto limited = limit_reading(options.readable); !limited) return limited.error();
    if (const auto limited = set_limits(options); !limited) return limited.error();
    return filter_system_calls();
}

}  // namespace embody::catalog
