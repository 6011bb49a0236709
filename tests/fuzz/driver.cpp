// SPDX-License-Identifier: MIT
// Runs one fuzz target on the files of its corpus, then on damaged ones, in a child process that is started again when
// it ends.
//
// Usage: fuzz_TARGET [--runs N] [--seconds S] [--seed K] [--keep FOLDER] [--outside-too] CORPUS …
//
// Without --seconds the same build and seed run the same inputs. An input that crashes the project's own code, breaks a
// promise or takes more than 60 s is written to FOLDER, and the exit code is 1. Crashes inside other libraries are
// counted; they are the reason for which models are read in confined processes. --outside-too keeps those, too. Built
// with -fsanitize-coverage=trace-pc, damaged inputs that reach something new become part of the corpus of this run.
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "coverage.h"
#include "crash.h"
#include "mutation.h"
#include "scratch_file.h"
#include "target.h"

extern "C" __attribute__((weak)) std::size_t embody_fuzz_repair(std::uint8_t* data, std::size_t size,
                                                                std::size_t capacity);

namespace embody::fuzz {
namespace {

constexpr unsigned longest_run = 60;  // s, of one input
constexpr std::size_t most_found = 4096, room_for_found = std::size_t{64} << 20;

struct Settings {
    std::uint64_t runs = 1000, seed = 1;
    double seconds = 0;  // 0: no limit
    bool outside_too = false;
    std::filesystem::path keep = ".";
    std::vector<std::filesystem::path> corpus;
};

/// Memory that parent and children share.
struct Shared {
    LastWords last_words;
    std::uint64_t run;         // number of the current input
    std::uint64_t pairs;       // pairs of branches that were seen
    std::size_t size;          // size of the current input
    double longest;            // longest time of an input, s
    std::uint64_t longest_at;  // number of that input
    std::size_t found, room;   // inputs that reached something new, and their total size
    std::size_t found_ends[most_found];
    std::uint8_t seen[coverage_size];
    std::uint8_t input[largest_input * 2];
    std::uint8_t found_bytes[room_for_found];
};

Shared& shared_memory() {
    void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    require(memory != MAP_FAILED, "there is memory for the driver");
    return *static_cast<Shared*>(memory);
}

std::vector<Bytes> read_corpus(const std::vector<std::filesystem::path>& places) {
    std::vector<std::filesystem::path> files;
    for (const auto& place : places) {
        if (!std::filesystem::is_directory(place)) {
            files.push_back(place);
            continue;
        }
        for (const auto& entry : std::filesystem::directory_iterator(place)) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    std::vector<Bytes> corpus;
    for (const auto& file : files) {
        std::ifstream in(file, std::ios::binary);
        corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
    }
    return corpus;
}

/// The inputs of one target: first the corpus, then damaged ones.
class Inputs {
public:
    Inputs(const Settings& settings, Shared& shared)
        : corpus_(read_corpus(settings.corpus)), shared_(shared), seed_(settings.seed) {}

    [[nodiscard]] std::size_t corpus_size() const { return corpus_.size(); }

    Bytes input(std::uint64_t run) const {
        if (run < corpus_.size()) return corpus_[run];
        Random random(seed_ * 0x100000001ull + run);
        const Bytes chosen = any(random), other = any(random);
        Bytes bytes = damaged(chosen, other, random);
        if (embody_fuzz_repair != nullptr && random.below(2) == 0) {
            const std::size_t size = bytes.size();
            bytes.resize(size + 64);
            bytes.resize(embody_fuzz_repair(bytes.data(), size, bytes.size()));
        }
        return bytes;
    }

private:
    Bytes any(Random& random) const {
        const std::size_t place = static_cast<std::size_t>(random.below(corpus_.size() + shared_.found));
        if (place < corpus_.size()) return corpus_[place];
        const std::size_t found = place - corpus_.size();
        const std::size_t begin = found == 0 ? 0 : shared_.found_ends[found - 1];
        return {shared_.found_bytes + begin, shared_.found_bytes + shared_.found_ends[found]};
    }

    std::vector<Bytes> corpus_;
    Shared& shared_;
    std::uint64_t seed_;
};

void keep_found(Shared& shared, const Bytes& bytes) {
    if (shared.found == most_found || bytes.size() > room_for_found - shared.room) return;
    std::copy(bytes.begin(), bytes.end(), shared.found_bytes + shared.room);
    shared.room += bytes.size();
    shared.found_ends[shared.found++] = shared.room;
}

using Clock = std::chrono::steady_clock;

/// In the child: runs one input after the other, beginning with shared.run.
[[noreturn]] void run_inputs(const Settings& settings, const Inputs& inputs, Shared& shared, Clock::time_point until) {
#ifndef __SANITIZE_ADDRESS__
    // The memory limit of a worker.
    const rlimit memory{std::size_t{3} << 30, std::size_t{3} << 30};
    setrlimit(RLIMIT_AS, &memory);
#endif
    const rlimit no_cores{0, 0};
    setrlimit(RLIMIT_CORE, &no_cores);
    watch_crashes(&shared.last_words);
    for (; shared.run < inputs.corpus_size() + settings.runs; ++shared.run) {
        if (shared.run >= inputs.corpus_size() && Clock::now() > until) break;
        const Bytes bytes = inputs.input(shared.run);
        shared.size = bytes.size();
        std::copy(bytes.begin(), bytes.end(), shared.input);
        alarm(longest_run);
        forget_coverage();
        const auto began = Clock::now();
        LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
        const std::size_t pairs = add_coverage(shared.seen);
        alarm(0);
        const double took = std::chrono::duration<double>(Clock::now() - began).count();
        if (took > shared.longest) shared.longest = took, shared.longest_at = shared.run;
        shared.pairs += pairs;
        if (pairs > 0 && shared.run >= inputs.corpus_size()) keep_found(shared, bytes);
        // The sanitizer's quarantine and leaks of libraries take memory, so a new child is started from time to time.
        if (shared.run % 20'000 == 19'999) {
            ++shared.run;
            _exit(98);
        }
    }
    _exit(coverage_is_known() ? 97 : 0);
}

std::string write_input(const Settings& settings, const Shared& shared, const std::string& target) {
    std::filesystem::create_directories(settings.keep);
    const auto file =
        settings.keep / (target + "-seed" + std::to_string(settings.seed) + "-run" + std::to_string(shared.run));
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(shared.input), static_cast<std::streamsize>(shared.size));
    return file.string();
}

/// Exit code: 0, or 1 where code of our own failed.
int run(const Settings& settings, const std::string& target) {
    Shared& shared = shared_memory();
    const Inputs inputs(settings, shared);
    if (inputs.corpus_size() == 0) {
        std::fprintf(stderr, "%s: the corpus is empty\n", target.c_str());
        return 2;
    }
    const auto began = Clock::now();
    const auto until =
        settings.seconds == 0
            ? Clock::time_point::max()
            : began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(settings.seconds));
    std::map<std::string, int> outside;
    int own = 0;
    while (true) {
        shared.last_words = {};
        const pid_t child = fork();
        if (child == 0) run_inputs(settings, inputs, shared, until);
        int status = 0;
        waitpid(child, &status, 0);
        const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        if (code == 0 || code == 97) break;
        if (code == 98) continue;
        const std::string module = shared.last_words.module.data(), signal = shared.last_words.signal.data();
        const bool is_own = module.empty() || module.find(target) != std::string::npos;
        if (is_own || settings.outside_too) {
            std::fprintf(stderr, "%s: run %llu fails by %s in %s: %s\n", target.c_str(),
                         static_cast<unsigned long long>(shared.run), signal.empty() ? "a signal" : signal.c_str(),
                         module.empty() ? "an unknown place" : module.c_str(),
                         write_input(settings, shared, target).c_str());
        }
        if (is_own && ++own == 20) break;
        if (!is_own) ++outside[signal + " in " + module];
        ++shared.run;
    }
    std::error_code ignored;
    std::filesystem::remove_all(scratch_folder(getpid()), ignored);
    std::printf("%s: %zu files of the corpus, %llu runs in %.1f s", target.c_str(), inputs.corpus_size(),
                static_cast<unsigned long long>(shared.run - std::min<std::uint64_t>(shared.run, inputs.corpus_size())),
                std::chrono::duration<double>(Clock::now() - began).count());
    if (shared.found > 0)
        std::printf(", %zu inputs reached something new, %llu pairs of branches", shared.found,
                    static_cast<unsigned long long>(shared.pairs));
    std::printf(", the longest %.2f s (run %llu), %d failures\n", shared.longest,
                static_cast<unsigned long long>(shared.longest_at), own);
    for (const auto& [what, times] : outside) std::printf("  outside: %d times %s\n", times, what.c_str());
    return own == 0 ? 0 : 1;
}

int main_of(int count, char** words) {
    Settings settings;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        const bool has_value = i + 1 < count;
        if (word == "--outside-too") {
            settings.outside_too = true;
        } else if (!word.starts_with("--")) {
            settings.corpus.emplace_back(word);
        } else if (word == "--runs" && has_value) {
            settings.runs = std::stoull(words[++i]);
        } else if (word == "--seconds" && has_value) {
            settings.seconds = std::stod(words[++i]);
        } else if (word == "--seed" && has_value) {
            settings.seed = std::stoull(words[++i]);
        } else if (word == "--keep" && has_value) {
            settings.keep = words[++i];
        } else {
            std::fprintf(stderr,
                         "usage: %s [--runs N] [--seconds S] [--seed K] [--keep FOLDER] [--outside-too] CORPUS …\n",
                         words[0]);
            return 2;
        }
    }
    return run(settings, std::filesystem::path(words[0]).filename().string());
}

}  // namespace
}  // namespace embody::fuzz

int main(int count, char** words) { return embody::fuzz::main_of(count, words); }
