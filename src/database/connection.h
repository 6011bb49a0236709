// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "database/statement.h"
#include "foundation/result.h"

namespace embody::database {

struct ConnectionOptions {
    std::uint32_t application_id = 0;  ///< marks our files; a file with another mark is refused, never written to
    std::string content = {};          ///< what such a file is, for errors: "a model database of Embody"
    int wait_milliseconds = 20000;     ///< how long to wait for another process that writes
};

/// An open database file. One instance a thread; any number of threads and processes may have the same file open: one
/// of them writes at a time, the others wait, and readers never wait (write-ahead log).
class Connection {
public:
    /// Opens the file or creates it (with its folder). A file that cannot be written is opened for reading, also in a
    /// folder or on a disk that cannot be written; commands that write then fail. Errors: not a database, another
    /// program's database, a folder, no space, locked for too long, or read-only with changes still in its log.
    static Result<std::unique_ptr<Connection>> open(const std::filesystem::path& file,
                                                    const ConnectionOptions& options);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] bool is_read_only() const { return read_only_; }
    /// The error that a command which writes would return; call it before long work for such a command.
    [[nodiscard]] Result<void> need_writable() const;

    /// Runs one or more commands that take no values and give no rows.
    Result<void> execute(const std::string& commands);
    /// A compiled command, kept for the next call with the same text.
    Result<Statement> prepare(std::string_view command);
    /// The first column of the first row; an error if there is none.
    Result<std::int64_t> query_integer(std::string_view command);
    /// Row id of the last insertion.
    [[nodiscard]] std::int64_t last_row_id() const;

    /// Reads the whole file and checks pages, indices and references; the error names the first thing that is wrong.
    Result<void> check_integrity();

private:
    friend class Statement;
    struct Handles;
    Connection(std::filesystem::path file, std::unique_ptr<Handles> handles);
    static Result<std::unique_ptr<Connection>> open_handle(const std::filesystem::path& file, const std::string& name,
                                                           int flags);
    static Result<std::unique_ptr<Connection>> open_for_reading(const std::filesystem::path& file);
    [[nodiscard]] Error last_error() const;
    Result<void> check_ownership(const ConnectionOptions& options);
    Result<void> compare_marks(const ConnectionOptions& options);
    Result<void> set_mark(std::uint32_t application_id);
    Result<void> configure(const ConnectionOptions& options);
    Result<void> switch_to_write_ahead_log(int wait_milliseconds);
    void recycle(std::string command, void* compiled);

    std::filesystem::path file_;
    std::unique_ptr<Handles> handles_;
    bool read_only_ = false;
};

}  // namespace embody::database
