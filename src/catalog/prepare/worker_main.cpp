// SPDX-License-Identifier: MIT
// embody-import-worker: reads models for the importing program, which starts it; see docs/import.md.
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <exception>
#include <new>
#include <string_view>

#include "catalog/prepare/confinement.h"
#include "catalog/prepare/prepare.h"
#include "catalog/prepare/worker_protocol.h"
#include "foundation/printable.h"
#include "interchange/read_model.h"

namespace embody::catalog {
namespace {

bool read_exactly(std::span<std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t got = read(STDIN_FILENO, bytes.data(), bytes.size());
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return true;
}

bool write_all(std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t put = write(STDOUT_FILENO, bytes.data(), bytes.size());
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(put));
    }
    return true;
}

/// The next item; an error at the end of the input, too.
Result<ImportItem> read_item() {
    const Error over{"import worker", "input ended"};
    std::vector<std::uint8_t> bytes(frame_header_size);
    if (!read_exactly(bytes)) return over;
    const auto header = read_frame_header(bytes);
    if (!header) return header.error();
    bytes.resize(frame_header_size + header->payload_size + frame_hash_size);
    if (!read_exactly(std::span(bytes).subspan(frame_header_size))) return over;
    const auto payload = payload_of(bytes);
    if (!payload) return payload.error();
    return item_from_bytes(*payload);
}

/// Libraries throw; from here on only results go.
Result<PreparedModel> prepare_safely(Preparation& preparation, const ImportItem& item) {
    try {
        return preparation.prepare(item);
    } catch (const std::bad_alloc&) {
        return interchange::out_of_memory(item.path);
    } catch (const std::exception& problem) {
        return Error{item.path, problem.what()};
    }
}

bool answer(const ImportItem& item, const Result<PreparedModel>& prepared) {
    if (!prepared) {
        const bool out_of_memory = interchange::is_out_of_memory(prepared.error());
        return write_all(
            frame(out_of_memory ? FrameKind::out_of_memory : FrameKind::failed, to_bytes(prepared.error())));
    }
    const std::vector<std::uint8_t> payload = to_bytes(*prepared);
    if (payload.size() <= max_payload_bytes) return write_all(frame(FrameKind::prepared, payload));
    return write_all(frame(FrameKind::failed, to_bytes(Error{item.path, "is larger than 256 MiB when packed"})));
}

int serve(const ConfinementOptions& options) {
    if (const auto confined = confine_this_process(options); !confined) {
        std::fprintf(stderr, "%s\n", printable(confined.error().message()).c_str());
        return 3;
    }
    if (!write_all(frame(FrameKind::ready, {}))) return 1;
    Preparation preparation;
    while (true) {
        const auto item = read_item();
        if (!item) return 0;
        const auto prepared = prepare_safely(preparation, *item);
        if (!answer(*item, prepared)) return 1;
    }
}

template <class T>
bool parse(std::string_view text, T& number) {
    return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
}

}  // namespace
}  // namespace embody::catalog

int main(int count, char** arguments) {
    embody::catalog::ConfinementOptions options;
    if (count < 3 || !embody::catalog::parse(arguments[1], options.parent) ||
        !embody::catalog::parse(arguments[2], options.address_space)) {
        std::fprintf(stderr, "embody-import-worker is started by `embody import`, not by hand.\n");
        return 2;
    }
    options.readable.assign(arguments + 3, arguments + count);
    return embody::catalog::serve(options);
}
