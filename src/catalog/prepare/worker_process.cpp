// SPDX-License-Identifier: MIT
#include "catalog/prepare/worker_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <utility>

namespace embody::catalog {
namespace {

constexpr int pipe_size = 1 << 20;  // bytes, so that a result rarely makes the worker wait

/// A descriptor that is closed at the end unless released.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return number_; }
    int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

/// posix_spawn's list of what to do with descriptors in the child.
class SpawnActions {
public:
    SpawnActions() { posix_spawn_file_actions_init(&actions_); }
    ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
    SpawnActions(const SpawnActions&) = delete;
    SpawnActions& operator=(const SpawnActions&) = delete;
    posix_spawn_file_actions_t* get() { return &actions_; }

private:
    posix_spawn_file_actions_t actions_{};
};

/// Default signal handling and nothing blocked, whatever the parent has.
class SpawnAttributes {
public:
    SpawnAttributes() {
        posix_spawnattr_init(&attributes_);
        sigset_t all, none;
        sigfillset(&all);
        sigemptyset(&none);
        posix_spawnattr_setsigdefault(&attributes_, &all);
        posix_spawnattr_setsigmask(&attributes_, &none);
        posix_spawnattr_setflags(&attributes_, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK);
    }
    ~SpawnAttributes() { posix_spawnattr_destroy(&attributes_); }
    SpawnAttributes(const SpawnAttributes&) = delete;
    SpawnAttributes& operator=(const SpawnAttributes&) = delete;
    posix_spawnattr_t* get() { return &attributes_; }

private:
    posix_spawnattr_t attributes_{};
};

}  // namespace

Result<WorkerProcess> WorkerProcess::start(const std::filesystem::path& program, std::size_t address_space,
                                           const std::vector<std::string>& readable) {
    // Sockets instead of a pipe towards the worker: writing to one whose reader died must be an error, not SIGPIPE.
    std::array<int, 2> in{}, out{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in.data()) != 0)
        return Error{"import worker", std::strerror(errno)};
    Descriptor in_parent(in[0]), in_child(in[1]);
    if (pipe2(out.data(), O_CLOEXEC) != 0) return Error{"import worker", std::strerror(errno)};
    Descriptor out_parent(out[0]), out_child(out[1]);
    for (const int ours : {in_parent.get(), out_parent.get()}) fcntl(ours, F_SETFL, fcntl(ours, F_GETFL) | O_NONBLOCK);
    fcntl(out_parent.get(), F_SETPIPE_SZ, pipe_size);

    SpawnActions actions;
    posix_spawn_file_actions_adddup2(actions.get(), in_child.get(), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(actions.get(), out_child.get(), STDOUT_FILENO);
    // Libraries in the worker chatter there.
    posix_spawn_file_actions_addopen(actions.get(), STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    SpawnAttributes attributes;

    const std::string path = program.string();
    std::vector<std::string> words{path, std::to_string(getpid()), std::to_string(address_space)};
    words.insert(words.end(), readable.begin(), readable.end());
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    // An empty environment: the worker needs none, and libraries take orders from there.
    std::array<char*, 1> environment{nullptr};
    pid_t process = -1;
    const int code =
        posix_spawn(&process, path.c_str(), actions.get(), attributes.get(), arguments.data(), environment.data());
    if (code != 0) {
        return Error{path, std::string("cannot be started: ") + std::strerror(code), "is Embody installed completely?"};
    }
    return WorkerProcess(process, in_parent.release(), out_parent.release());
}

WorkerProcess::WorkerProcess(WorkerProcess&& other) noexcept
    : process_(std::exchange(other.process_, -1)),
      to_worker_(std::exchange(other.to_worker_, -1)),
      from_worker_(std::exchange(other.from_worker_, -1)),
      outgoing_(std::move(other.outgoing_)),
      incoming_(std::move(other.incoming_)),
      sent_(other.sent_) {}

WorkerProcess::~WorkerProcess() {
    finish();
    if (to_worker_ >= 0) close(to_worker_);
    if (from_worker_ >= 0) close(from_worker_);
}

void WorkerProcess::lower_priority() const {
    constexpr int niceness = 10;  // a tenth of what a process of the usual niceness gets
    (void)setpriority(PRIO_PROCESS, static_cast<id_t>(process_), niceness);
}

double WorkerProcess::processor_seconds() const {
    clockid_t clock{};
    timespec used{};
    // A process that is gone has no clock; its end is seen at its output.
    if (clock_getcpuclockid(process_, &clock) != 0 || clock_gettime(clock, &used) != 0) return 0;
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

void WorkerProcess::queue(std::vector<std::uint8_t> frame) {
    outgoing_.erase(outgoing_.begin(), outgoing_.begin() + static_cast<std::ptrdiff_t>(sent_));
    sent_ = 0;
    outgoing_.insert(outgoing_.end(), frame.begin(), frame.end());
}

void WorkerProcess::send_some() {
    while (has_unsent()) {
        const ssize_t put = send(to_worker_, outgoing_.data() + sent_, outgoing_.size() - sent_, MSG_NOSIGNAL);
        if (put < 0 && errno == EINTR) continue;
        // Full: later. Broken: its output ends too, and that is where its end is seen.
        if (put <= 0) return;
        sent_ += static_cast<std::size_t>(put);
    }
}

bool WorkerProcess::receive_some() {
    std::array<std::uint8_t, 64 << 10> block;
    // No more than one frame ahead, so that a worker cannot fill the parent's memory.
    while (incoming_.size() <= frame_header_size + max_payload_bytes + frame_hash_size) {
        const ssize_t got = read(from_worker_, block.data(), block.size());
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
        if (got == 0) return false;
        incoming_.insert(incoming_.end(), block.begin(), block.begin() + got);
    }
    return true;
}

Result<std::optional<WorkerProcess::Message>> WorkerProcess::take_message() {
    if (incoming_.size() < frame_header_size) return std::optional<Message>();
    const auto header = read_frame_header(incoming_);
    if (!header) return header.error();
    const std::size_t whole = frame_header_size + header->payload_size + frame_hash_size;
    if (incoming_.size() < whole) return std::optional<Message>();
    const auto payload = payload_of(std::span(incoming_).first(whole));
    if (!payload) return payload.error();
    Message message{header->kind, {payload->begin(), payload->end()}};
    incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(whole));
    return std::optional(std::move(message));
}

std::string WorkerProcess::finish() {
    if (process_ < 0) return "was ended";
    // What ended by itself keeps its reason; only what still runs is killed.
    int status = 0;
    pid_t ended = waitpid(process_, &status, WNOHANG);
    if (ended == 0) {
        kill(process_, SIGKILL);
        do ended = waitpid(process_, &status, 0);
        while (ended < 0 && errno == EINTR);
    }
    process_ = -1;
    if (ended > 0 && WIFSIGNALED(status)) {
        const int number = WTERMSIG(status);
        return "was ended by signal " + std::to_string(number) + " (" + strsignal(number) + ")";
    }
    if (ended > 0 && WIFEXITED(status)) return "ended with code " + std::to_string(WEXITSTATUS(status));
    return "is gone";
}

}  // namespace embody::catalog
