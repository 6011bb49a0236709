// SPDX-License-Identifier: MIT
#include "database/connection.h"

#include <sqlite3.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <system_error>
#include <thread>

namespace embody::database {

struct Connection::Handles {
    sqlite3* database = nullptr;
    std::multimap<std::string, sqlite3_stmt*, std::less<>> idle;  ///< compiled commands nobody uses just now

    ~Handles() {
        for (auto& [command, compiled] : idle) sqlite3_finalize(compiled);
        sqlite3_close_v2(database);
    }
};

namespace {

constexpr int page_bytes = 8192;  // geometry blobs are tens of kilobytes: fewer overflow pages than with 4096

/// Why the library refused, and what a person can do about it.
Error describe(const std::filesystem::path& file, int code, const char* detail) {
    const std::string where = file.string();
    const std::string told = detail ? detail : sqlite3_errstr(code);
    switch (code & 0xff) {
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
            return {where, "another process is writing to it and did not finish in time", "try again when it is done"};
        case SQLITE_READONLY:
        case SQLITE_PERM:
            return {where, "is read-only", "make file and folder writable, or name another file with --database"};
        case SQLITE_FULL:
            return {where, "no space left on the disk", "make room, then go on: what was stored before is kept"};
        case SQLITE_NOTADB:
            return {where, "is not a database", "name another file with --database; this one was left as it is"};
        case SQLITE_CORRUPT:
            return {where, "is damaged: " + told, "move it away; the next import builds it anew from the model files"};
        case SQLITE_CANTOPEN:
            return {where, "cannot be opened", "check that the folder exists and may be written"};
        case SQLITE_IOERR:
            return {where, "reading or writing failed: " + told, "check the disk and its free space"};
        default:
            return {where, told, {}};
    }
}

/// Errors that can be found before the library is called.
Result<void> prepare_place(const std::filesystem::path& file) {
    std::error_code failure;
    if (file.empty()) return Error{"database", "no file is named", "name one with --database"};
    if (std::filesystem::is_directory(file, failure)) {
        return Error{file.string(), "is a folder, not a database file", "name a file in it"};
    }
    if (!file.has_parent_path()) return {};
    std::filesystem::create_directories(file.parent_path(), failure);
    if (failure) return Error{file.parent_path().string(), "the folder cannot be made: " + failure.message(), {}};
    return {};
}

/// Whether the file is there but cannot be changed, or nothing can be made beside it, which writing needs: by its mode,
/// or because the disk is read-only.
bool can_only_be_read(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    return access(file.c_str(), F_OK) == 0 && (access(file.c_str(), W_OK) != 0 || access(folder.c_str(), W_OK) != 0);
}

/// "file:" and the path, in which "?", "#" and "%" are no longer signs of a URI.
std::string as_uri(const std::filesystem::path& file) {
    std::string uri = "file:";
    for (const char c : std::filesystem::absolute(file).string()) {
        if (c == '?') {
            uri += "%3f";
        } else if (c == '#') {
            uri += "%23";
        } else if (c == '%') {
            uri += "%25";
        } else {
            uri += c;
        }
    }
    return uri;
}

}  // namespace

Connection::Connection(std::filesystem::path file, std::unique_ptr<Handles> handles)
    : file_(std::move(file)), handles_(std::move(handles)) {}

Connection::~Connection() = default;

Result<std::unique_ptr<Connection>> Connection::open(const std::filesystem::path& file,
                                                     const ConnectionOptions& options) {
    if (auto place = prepare_place(file); !place) return place.error();

    const bool read_only = can_only_be_read(file);
    auto connection =
        read_only ? open_for_reading(file) : open_handle(file, file, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
    if (!connection) return connection;
    (*connection)->read_only_ = read_only;

    // Nothing is written before the file is known to be ours or new.
    sqlite3_busy_timeout((*connection)->handles_->database, options.wait_milliseconds);
    if (auto owned = (*connection)->check_ownership(options); !owned) return owned.error();
    if (auto configured = (*connection)->configure(options); !configured) return configured.error();
    return connection;
}

Result<std::unique_ptr<Connection>> Connection::open_handle(const std::filesystem::path& file, const std::string& name,
                                                            int flags) {
    // One instance a thread, so the library needs no lock of its own.
    auto handles = std::make_unique<Handles>();
    const int code =
        sqlite3_open_v2(name.c_str(), &handles->database, flags | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE, nullptr);
    if (code != SQLITE_OK) return describe(file, code, handles->database ? sqlite3_errmsg(handles->database) : nullptr);
    return std::unique_ptr<Connection>(new Connection(file, std::move(handles)));
}

Result<std::unique_ptr<Connection>> Connection::open_for_reading(const std::filesystem::path& file) {
    // With the write-ahead log of a program that is writing now.
    auto connection = open_handle(file, file, SQLITE_OPEN_READONLY);
    if (!connection) return connection;
    const auto tables = (*connection)->query_integer("SELECT count(*) FROM sqlite_schema");
    const int code = sqlite3_extended_errcode((*connection)->handles_->database) & 0xff;
    if (tables || (code != SQLITE_CANTOPEN && code != SQLITE_READONLY)) return connection;

    // The log's index cannot be made beside the file. Without a log all is in the file itself, which nobody changes as
    // long as there is none.
    std::error_code no_log;
    if (std::filesystem::file_size(file.string() + "-wal", no_log) > 0 && !no_log) {
        return Error{file.string(), "is read-only, and its last changes are still in the log beside it",
                     "let a program that may write there open it once, or make file and folder writable"};
    }
    return open_handle(file, as_uri(file) + "?immutable=1", SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
}

Result<void> Connection::need_writable() const {
    if (!read_only_) return {};
    return describe(file_, SQLITE_READONLY, nullptr);
}

Result<void> Connection::check_ownership(const ConnectionOptions& options) {
    // One snapshot for all queries: another process may be creating the file just now.
    if (auto begun = execute("BEGIN"); !begun) return begun;
    Result<void> owned = compare_marks(options);
    if (auto ended = execute("COMMIT"); owned && !ended) return ended;
    return owned;
}

Result<void> Connection::compare_marks(const ConnectionOptions& options) {
    const auto mark = query_integer("PRAGMA application_id");
    if (!mark) return mark.error();
    if (static_cast<std::uint32_t>(*mark) == options.application_id) return {};

    // No mark and nothing in it: a new or empty file.
    const auto version = query_integer("PRAGMA user_version");
    if (!version) return version.error();
    const auto tables = query_integer("SELECT count(*) FROM sqlite_schema");
    if (!tables) return tables.error();
    if (*mark == 0 && *version == 0 && *tables == 0) return {};
    return Error{file_.string(), "is a database of another program, not " + options.content,
                 "name another file with --database; this one was left as it is"};
}

Result<void> Connection::configure(const ConnectionOptions& options) {
    if (read_only_) return execute("PRAGMA cache_size = -32768; PRAGMA temp_store = MEMORY");
    // A page size counts only before the first write; the mark is set by the first process to write.
    if (auto size = execute("PRAGMA page_size = " + std::to_string(page_bytes)); !size) return size;
    if (auto log = switch_to_write_ahead_log(options.wait_milliseconds); !log) return log;
    if (auto marked = set_mark(options.application_id); !marked) return marked;

    // NORMAL: a killed process loses nothing that was committed, a power cut at most the last commits, never the file.
    return execute(
        "PRAGMA synchronous = NORMAL; PRAGMA foreign_keys = ON; PRAGMA cache_size = -32768; PRAGMA temp_store = MEMORY;"
        "PRAGMA journal_size_limit = 67108864");
}

Result<void> Connection::set_mark(std::uint32_t application_id) {
    const auto mark = query_integer("PRAGMA application_id");
    if (!mark) return mark.error();
    if (*mark != 0) return {};
    // The write lock first: one that is asked for after reading is refused at once where another process has written.
    if (auto begun = execute("BEGIN IMMEDIATE"); !begun) return begun;
    return execute("PRAGMA application_id = " + std::to_string(application_id) + "; COMMIT");
}

Result<void> Connection::switch_to_write_ahead_log(int wait_milliseconds) {
    // The switch does not wait for other connections by itself: two processes may create the file at the same moment.
    const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(wait_milliseconds);
    while (true) {
        const int code = sqlite3_exec(handles_->database, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
        if (code == SQLITE_OK) return {};
        if ((code & 0xff) != SQLITE_BUSY || std::chrono::steady_clock::now() > until) return last_error();
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
}

Result<void> Connection::execute(const std::string& commands) {
    if (sqlite3_exec(handles_->database, commands.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) return last_error();
    return {};
}

Result<Statement> Connection::prepare(std::string_view command) {
    // Takes an idle one where there is one.
    if (auto found = handles_->idle.find(command); found != handles_->idle.end()) {
        auto taken = handles_->idle.extract(found);
        return Statement(*this, std::move(taken.key()), taken.mapped());
    }
    sqlite3_stmt* compiled = nullptr;
    const int code = sqlite3_prepare_v3(handles_->database, command.data(), static_cast<int>(command.size()),
                                        SQLITE_PREPARE_PERSISTENT, &compiled, nullptr);
    if (code != SQLITE_OK) return last_error();
    return Statement(*this, std::string(command), compiled);
}

void Connection::recycle(std::string command, void* compiled) {
    auto* statement = static_cast<sqlite3_stmt*>(compiled);
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    handles_->idle.emplace(std::move(command), statement);
}

Result<std::int64_t> Connection::query_integer(std::string_view command) {
    auto statement = prepare(command);
    if (!statement) return statement.error();
    const auto row = statement->step();
    if (!row) return row.error();
    if (!*row) return Error{file_.string(), "gave no row for: " + std::string(command), {}};
    return statement->integer(0);
}

std::int64_t Connection::last_row_id() const { return sqlite3_last_insert_rowid(handles_->database); }

Result<void> Connection::check_integrity() {
    auto pages = prepare("PRAGMA integrity_check(1)");
    if (!pages) return pages.error();
    if (const auto row = pages->step(); !row) return row.error();
    if (const std::string told = pages->text(0); told != "ok") return describe(file_, SQLITE_CORRUPT, told.c_str());

    auto references = prepare("PRAGMA foreign_key_check");
    if (!references) return references.error();
    const auto broken = references->step();
    if (!broken) return broken.error();
    if (*broken)
        return describe(file_, SQLITE_CORRUPT,
                        ("a row of table " + references->text(0) + " has lost its model").c_str());
    return {};
}

Error Connection::last_error() const {
    return describe(file_, sqlite3_extended_errcode(handles_->database), sqlite3_errmsg(handles_->database));
}

}  // namespace embody::database
