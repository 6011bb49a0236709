// SPDX-License-Identifier: MIT
#include "cli/bench_race.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/arguments.h"
#include "cli/output.h"

namespace embody::cli {
namespace {

namespace fs = std::filesystem;

/// Path of embody-race; empty where this program's own path is unknown.
fs::path race_program() {
    std::error_code problem;
    const fs::path own = fs::read_symlink("/proc/self/exe", problem);
    return problem ? fs::path() : own.parent_path() / "embody-race";
}

}  // namespace

int run_race(const std::vector<std::string>& words) {
    const fs::path program = race_program();
    std::error_code problem;
    if (!fs::exists(program, problem)) {
        return report({program.string(), "the race was not built: it needs other engines to run against",
                       "install libbullet-dev or libode-dev, then configure and build embody-race"});
    }

    // The arguments unchanged, after the program's own name.
    std::vector<std::string> kept{program.string()};
    kept.insert(kept.end(), words.begin(), words.end());
    std::vector<char*> arguments;
    for (std::string& word : kept) arguments.push_back(word.data());
    arguments.push_back(nullptr);

    pid_t process = -1;
    const int code = posix_spawn(&process, program.c_str(), nullptr, nullptr, arguments.data(), environ);
    if (code != 0) return report({program.string(), std::string("cannot be started: ") + std::strerror(code)});
    int status = 0;
    while (waitpid(process, &status, 0) < 0) {
        if (errno != EINTR) return report({program.string(), std::string("was lost: ") + std::strerror(errno)});
    }
    if (WIFSIGNALED(status))
        return report({program.string(), std::string("stopped by a signal: ") + strsignal(WTERMSIG(status))});
    return WEXITSTATUS(status);
}

}  // namespace embody::cli
