// SPDX-License-Identifier: MIT
#include "catalog/prepare/confinement.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "interchange/scratch_files.h"

namespace embody::catalog {
namespace {

/// Confines a child process and runs `attempt` in it; returns its result, or -signal.
template <class Attempt>
int confined(Attempt attempt, ConfinementOptions options = {.address_space = std::size_t{1} << 40}) {
    options.parent = getpid();
    const pid_t child = fork();
    if (child == 0) {
        if (!confine_this_process(options)) _exit(99);
        _exit(attempt());
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

TEST(Confinement, RefusesToStartWithoutItsParent) {
    const pid_t child = fork();
    if (child == 0) _exit(confine_this_process({.parent = 1}).ok() ? 1 : 0);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(Confinement, TakesAwayTheNetwork) {
    EXPECT_EQ(
        confined([] { return socket(AF_INET, SOCK_STREAM, 0) < 0 && socket(AF_UNIX, SOCK_STREAM, 0) < 0 ? 0 : 1; }), 0);
}

TEST(Confinement, TakesAwayNewProcessesAndPrograms) {
    EXPECT_EQ(confined([] {
                  const pid_t child = fork();
                  if (child == 0) _exit(0);
                  return child < 0 ? 0 : 1;
              }),
              0);
    EXPECT_EQ(confined([] {
                  char name[] = "/bin/true";
                  char* arguments[] = {name, nullptr};
                  execv(name, arguments);
                  return 7;
              }),
              7);
}

TEST(Confinement, TakesAwayWritingAndRemovingFiles) {
    const std::string file = testing::TempDir() + "embody-confinement-test";
    close(open(file.c_str(), O_CREAT | O_WRONLY | O_CLOEXEC, 0600));
    EXPECT_EQ(confined([&] {
                  const bool written = open((file + "-new").c_str(), O_CREAT | O_WRONLY, 0600) >= 0 ||
                                       open(file.c_str(), O_RDWR) >= 0 || open(file.c_str(), O_RDONLY | O_TRUNC) >= 0;
                  const bool removed = unlink(file.c_str()) == 0 || rename(file.c_str(), (file + "-new").c_str()) == 0;
                  return written || removed ? 1 : 0;
              }),
              0);
    EXPECT_EQ(access(file.c_str(), F_OK), 0);
    unlink(file.c_str());
}

TEST(Confinement, LeavesReadingFilesAndThreads) {
    EXPECT_EQ(confined([] {
                  char byte = 0;
                  const int file = open("/proc/self/exe", O_RDONLY);
                  return file >= 0 && read(file, &byte, 1) == 1 ? 0 : 1;
              }),
              0);
    EXPECT_EQ(confined([] {
                  int answer = 1;
                  std::thread([&] { answer = 0; }).join();
                  return answer;
              }),
              0);
}

TEST(Confinement, TakesAwaySignalsToOthersAndExecutableMemory) {
    EXPECT_EQ(confined([] { return kill(getppid(), 0) < 0 ? 0 : 1; }), 0);
    EXPECT_EQ(confined([] {
                  return mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
                                 MAP_FAILED
                             ? 0
                             : 1;
              }),
              0);
}

TEST(Confinement, ReadsOnlyWhatItIsGiven) {
    if (syscall(SYS_landlock_create_ruleset, nullptr, 0, 1 /* LANDLOCK_CREATE_RULESET_VERSION */) < 0) {
        GTEST_SKIP() << "this kernel has no Landlock";
    }
    const test::ScratchFolder scratch;
    const auto inside = scratch.write("models/in/chair.obj", "v"), archive = scratch.write("some.zip", "PK");
    const auto secret = scratch.write("secret.txt", "secret");
    std::filesystem::create_symlink(secret, scratch.path() / "models/link.txt");
    const auto opens = [](const std::filesystem::path& file) { return open(file.c_str(), O_RDONLY) >= 0; };
    const int wrong = confined(
        [&] {
            const bool reads = opens(inside) && opens(archive) && opens(scratch.path() / "models");
            const bool reaches = opens(secret) || opens(scratch.path() / "models/link.txt") || opens("/etc/passwd");
            return (reads ? 0 : 1) + (reaches ? 2 : 0);
        },
        {.readable = {(scratch.path() / "models").string(), archive.string(), "/missing"}});
    EXPECT_EQ(wrong, 0);
}

TEST(Confinement, LimitsMemory) {
    EXPECT_EQ(confined(
                  [] {
                      return mmap(nullptr, std::size_t{2} << 30, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
                                     MAP_FAILED
                                 ? 0
                                 : 1;
                  },
                  {.address_space = std::size_t{1} << 30}),
              0);
}

TEST(Confinement, EndsWithItsParent) {
    // Only the grandchild has the pipe's end as its output: once that is closed, the grandchild has ended.
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        const pid_t parent = getpid();
        if (fork() == 0) {
            dup2(ends[1], STDOUT_FILENO);
            if (!confine_this_process({.parent = parent})) _exit(1);
            if (write(STDOUT_FILENO, "r", 1) != 1) _exit(1);
            while (true) poll(nullptr, 0, 1000);
        }
        char ready = 0;
        _exit(read(ends[0], &ready, 1) == 1 ? 0 : 1);
    }
    close(ends[1]);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_EQ(WEXITSTATUS(status), 0);
    char byte = 0;
    EXPECT_EQ(read(ends[0], &byte, 1), 0);
    close(ends[0]);
}

}  // namespace
}  // namespace embody::catalog
