// SPDX-License-Identifier: MIT
#include "catalog/import/file_fingerprint.h"

#include <system_error>
#include <vector>

#include "foundation/state_hash.h"
#include "interchange/regular_file.h"

namespace embody::catalog {

namespace fs = std::filesystem;

Result<std::string> stamp_file(const fs::path& file) {
    std::error_code failure;
    const auto size = fs::file_size(file, failure);
    if (failure) return Error{file.string(), "cannot be read: " + failure.message(), {}};
    const auto time = fs::last_write_time(file, failure);
    if (failure) return Error{file.string(), "cannot be read: " + failure.message(), {}};
    return std::to_string(size) + " bytes, " + std::to_string(time.time_since_epoch().count());
}

Result<std::optional<std::uint64_t>> hash_file(const fs::path& file, std::uint64_t limit,
                                               const HashProgress& progress) {
    auto opened = interchange::RegularFile::open(file, limit);
    if (!opened) return opened.error();
    StateHash hash;
    std::vector<std::uint8_t> block(4 << 20);
    for (std::uint64_t done = 0; progress(done, opened->size());) {
        const auto got = opened->read(block);
        if (!got) return got.error();
        if (*got == 0) return std::optional(hash.value());
        hash.add_bytes(block.data(), *got);
        done += *got;
        if (done > opened->size()) return Error{file.string(), "grows while it is read", "import it when it is whole"};
    }
    return std::optional<std::uint64_t>();
}

}  // namespace embody::catalog
