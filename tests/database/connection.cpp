// SPDX-License-Identifier: MIT
#include "database/connection.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <functional>
#include <sstream>

#include "database/migrations.h"
#include "database/model_schema.h"
#include "database/temporary_folder.h"
#include "database/transaction.h"
#include "end_child.h"

namespace embody::database {
namespace {

using test::TemporaryFolder;

constexpr ConnectionOptions ours{.application_id = 0x1234, .content = {}, .wait_milliseconds = 50};

std::string bytes_of(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
}
void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

TEST(Connection, RefusesAFileThatIsNoDatabaseAndLeavesItAsItIs) {
    TemporaryFolder folder;
    const std::string letter = "Dear reader, this is a letter and by no means a database." + std::string(5000, '.');
    write(folder / "letter.txt", letter);
    const auto connection = Connection::open(folder / "letter.txt", ours);
    ASSERT_FALSE(connection);
    EXPECT_NE(connection.error().message().find("is not a database"), std::string::npos)
        << connection.error().message();
    EXPECT_EQ(bytes_of(folder / "letter.txt"), letter);
}

TEST(Connection, RefusesAnotherProgramsDatabaseAndLeavesItAsItIs) {
    TemporaryFolder folder;
    {
        auto theirs = Connection::open(folder / "theirs.sqlite", {.application_id = 99});
        ASSERT_TRUE(theirs);
        ASSERT_TRUE((*theirs)->execute("CREATE TABLE letter (text)"));
    }
    const std::string before = bytes_of(folder / "theirs.sqlite");
    const auto connection = Connection::open(folder / "theirs.sqlite", ours);
    ASSERT_FALSE(connection);
    EXPECT_NE(connection.error().why.find("another program"), std::string::npos);
    EXPECT_EQ(bytes_of(folder / "theirs.sqlite"), before);
}

TEST(Connection, RefusesAnUnmarkedDatabaseThatHoldsTables) {
    TemporaryFolder folder;
    {
        auto theirs = Connection::open(folder / "theirs.sqlite", {.application_id = 0});
        ASSERT_TRUE(theirs);
        ASSERT_TRUE((*theirs)->execute("CREATE TABLE letter (text)"));
    }
    EXPECT_FALSE(Connection::open(folder / "theirs.sqlite", ours));
}

TEST(Connection, RefusesAFolderAndNoName) {
    TemporaryFolder folder;
    const auto connection = Connection::open(folder.path(), ours);
    ASSERT_FALSE(connection);
    EXPECT_NE(connection.error().why.find("folder"), std::string::npos);
    EXPECT_FALSE(Connection::open("", ours));
}

TEST(Connection, RefusesAFileBelowAFile) {
    TemporaryFolder folder;
    write(folder / "file", "x");
    const auto connection = Connection::open(folder / "file/below/models.sqlite", ours);
    ASSERT_FALSE(connection);
    EXPECT_NE(connection.error().where.find("below"), std::string::npos);
}

/// The result of `look` as a user who may not write this process's files, because the administrator may write
/// everywhere. "" means success.
std::string as_another_person(const std::function<std::string()>& look) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        const std::string told = geteuid() == 0 && setuid(65534) != 0 ? "cannot be somebody else" : look();
        _exit(::write(ends[1], told.data(), told.size()) == static_cast<ssize_t>(told.size()) ? 0 : 1);
    }
    close(ends[1]);
    std::string told(4096, '\0');
    const ssize_t count = ::read(ends[0], told.data(), told.size());
    close(ends[0]);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
    told.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    return told;
}

/// Reads `rows` rows from the table `letter`; writing must fail with an error that names the file.
std::string read_only_fault(const std::filesystem::path& file, std::int64_t rows) {
    const auto connection = Connection::open(file, ours);
    if (!connection) return connection.error().message();
    const auto found = (*connection)->query_integer("SELECT count(*) FROM letter");
    if (!found) return found.error().message();
    if (*found != rows) return "found " + std::to_string(*found) + " rows";
    for (const auto& refused :
         {(*connection)->execute("INSERT INTO letter VALUES (9)"), (*connection)->need_writable()})
        if (refused || refused.error().why.find("read-only") == std::string::npos) return "was written";
    return "";
}

TEST(Connection, AReadOnlyFileIsReadAndTellsWhoWritesIt) {
    // Characters with a meaning in a URI are allowed in names.
    for (const char* name : {"models.sqlite", "50%25 of #1?mode=rw.sqlite"}) {
        for (const mode_t folder_mode : {0777, 0555}) {
            for (const mode_t file_mode : {0444, 0666}) {
                if (folder_mode == 0777 && file_mode == 0666) continue;
                TemporaryFolder folder;
                {
                    const auto connection = Connection::open(folder / name, ours);
                    ASSERT_TRUE(connection);
                    ASSERT_TRUE((*connection)->execute("CREATE TABLE letter (number); INSERT INTO letter VALUES (1)"));
                }
                chmod((folder / name).c_str(), file_mode);
                chmod(folder.path().c_str(), folder_mode);
                const std::string before = bytes_of(folder / name);
                EXPECT_EQ(as_another_person([&] { return read_only_fault(folder / name, 1); }), "")
                    << name << std::oct << " " << folder_mode << " " << file_mode;
                EXPECT_EQ(bytes_of(folder / name), before);
                chmod(folder.path().c_str(), 0755);
            }
        }
    }
}

TEST(Connection, AReadOnlyFileIsReadWhileItsOwnerWrites) {
    TemporaryFolder folder;
    const auto owner = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(owner);
    ASSERT_TRUE((*owner)->execute("CREATE TABLE letter (number); INSERT INTO letter VALUES (1)"));
    chmod((folder / "models.sqlite").c_str(), 0644);
    chmod(folder.path().c_str(), 0755);
    for (std::int64_t rows = 1; rows < 4; ++rows) {
        EXPECT_EQ(as_another_person([&] { return read_only_fault(folder / "models.sqlite", rows); }), "");
        ASSERT_TRUE((*owner)->execute("INSERT INTO letter VALUES (2)"));
    }
}

TEST(Connection, ReportsAReadOnlyFileWhoseLastChangesAreInItsLog) {
    TemporaryFolder folder;
    {
        const auto owner = Connection::open(folder / "models.sqlite", ours);
        ASSERT_TRUE(owner);
        ASSERT_TRUE((*owner)->execute("CREATE TABLE letter (number); INSERT INTO letter VALUES (1)"));
        // The files as a killed program leaves them.
        std::filesystem::copy_file(folder / "models.sqlite", folder / "killed.sqlite");
        std::filesystem::copy_file(folder / "models.sqlite-wal", folder / "killed.sqlite-wal");
    }
    chmod(folder.path().c_str(), 0555);
    const std::string told = as_another_person([&] { return read_only_fault(folder / "killed.sqlite", 1); });
    EXPECT_NE(told.find("killed.sqlite: is read-only, and its last changes are still in the log"), std::string::npos)
        << told;
    chmod(folder.path().c_str(), 0755);
}

TEST(Connection, ReportsADamagedFile) {
    TemporaryFolder folder;
    {
        auto connection = Connection::open(folder / "models.sqlite", ours);
        ASSERT_TRUE(connection);
        ASSERT_TRUE((*connection)->execute("CREATE TABLE row (text TEXT); CREATE INDEX by_text ON row (text)"));
        auto insert = (*connection)->prepare("INSERT INTO row VALUES (?)");
        ASSERT_TRUE(insert);
        ASSERT_TRUE(insert->bind(std::string_view(std::string(200'000, 'x'))).run());
    }
    // Everything after the first page becomes random.
    std::string bytes = bytes_of(folder / "models.sqlite");
    ASSERT_GT(bytes.size(), 40'000u);
    for (std::size_t i = 8192; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 31);
    write(folder / "models.sqlite", bytes);

    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    const auto whole = (*connection)->check_integrity();
    ASSERT_FALSE(whole);
    EXPECT_NE(whole.error().why.find("damaged"), std::string::npos) << whole.error().message();
    const auto read = (*connection)->query_integer("SELECT count(*) FROM row");
    EXPECT_FALSE(read);
}

TEST(Connection, ReportsAFullDiskAndKeepsWhatWasThere) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    Connection& database = **connection;
    ASSERT_TRUE(database.execute("CREATE TABLE row (bytes BLOB); INSERT INTO row VALUES (x'00')"));
    ASSERT_TRUE(database.execute("PRAGMA max_page_count = 8"));
    {
        auto transaction = Transaction::begin(database);
        ASSERT_TRUE(transaction);
        const auto written = database.execute("INSERT INTO row VALUES (zeroblob(1000000))");
        ASSERT_FALSE(written);
        EXPECT_NE(written.error().why.find("no space"), std::string::npos) << written.error().message();
    }
    EXPECT_EQ(*database.query_integer("SELECT count(*) FROM row"), 1);
    EXPECT_TRUE(database.execute("INSERT INTO row VALUES (x'01')"));
    EXPECT_TRUE(database.check_integrity());
}

TEST(Connection, ReportsALockThatIsHeldTooLong) {
    TemporaryFolder folder;
    auto first = Connection::open(folder / "models.sqlite", ours);
    auto second = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(first && second);
    auto holding = Transaction::begin(**first);
    ASSERT_TRUE(holding);
    const auto waiting = Transaction::begin(**second);
    ASSERT_FALSE(waiting);
    EXPECT_NE(waiting.error().why.find("another process is writing"), std::string::npos);
}

TEST(Connection, ReportsAWrongCommandAndContinues) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    EXPECT_FALSE((*connection)->execute("MAKE ME A TABLE"));
    EXPECT_FALSE((*connection)->prepare("SELECT nothing FROM nowhere"));
    EXPECT_TRUE((*connection)->execute("CREATE TABLE fine (x)"));
    auto bind_too_much = (*connection)->prepare("SELECT 1");
    ASSERT_TRUE(bind_too_much);
    EXPECT_FALSE(bind_too_much->bind(1).step());
}

TEST(Connection, MakesTheFolderOfANewFile) {
    TemporaryFolder folder;
    EXPECT_TRUE(Connection::open(folder / "new/folder/models.sqlite", ours));
    EXPECT_TRUE(std::filesystem::exists(folder / "new/folder/models.sqlite"));
}

TEST(Transaction, UndoesWhatWasNotCommitted) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    Connection& database = **connection;
    ASSERT_TRUE(database.execute("CREATE TABLE row (x)"));
    {
        auto transaction = Transaction::begin(database);
        ASSERT_TRUE(transaction);
        ASSERT_TRUE(database.execute("INSERT INTO row VALUES (1)"));
    }
    EXPECT_EQ(*database.query_integer("SELECT count(*) FROM row"), 0);
    {
        auto transaction = Transaction::begin(database);
        ASSERT_TRUE(transaction);
        ASSERT_TRUE(database.execute("INSERT INTO row VALUES (1)"));
        ASSERT_TRUE(transaction->commit());
    }
    EXPECT_EQ(*database.query_integer("SELECT count(*) FROM row"), 1);
}

TEST(Statement, KeepsValuesExactly) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    auto echo = (*connection)->prepare("SELECT ?, ?, ?, ?, ?");
    ASSERT_TRUE(echo);
    const std::string text("two\0parts", 9);
    const std::vector<std::uint8_t> bytes{0, 1, 255};
    echo->bind(~std::uint64_t{0}).bind(0.1).bind(std::string_view(text)).bind(bytes).bind(std::string_view());
    ASSERT_TRUE(*echo->step());
    EXPECT_EQ(echo->bits(0), ~std::uint64_t{0});
    EXPECT_EQ(echo->real(1), 0.1);
    EXPECT_EQ(echo->text(2), text);
    EXPECT_EQ(echo->bytes(3), bytes);
    EXPECT_EQ(echo->text(4), "");
    EXPECT_FALSE(*echo->step());
}

constexpr Migration steps[] = {{1, "CREATE TABLE model (name TEXT); INSERT INTO model VALUES ('oak chair')"},
                               {2, "ALTER TABLE model ADD COLUMN legs INTEGER DEFAULT 4"},
                               {3, "CREATE INDEX model_by_name ON model (name)"}};

TEST(Migrations, RefuseANewerSchemaByItsVersion) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    ASSERT_TRUE((*connection)->execute("PRAGMA user_version = 7"));
    const auto migrated = migrate(**connection, steps);
    ASSERT_FALSE(migrated);
    EXPECT_NE(migrated.error().why.find("version 7"), std::string::npos);
    EXPECT_FALSE(migrated.error().remedy.empty());
    EXPECT_EQ(*(*connection)->query_integer("SELECT count(*) FROM sqlite_schema"), 0);
}

TEST(Migrations, OfAReadOnlyFileAreReported) {
    TemporaryFolder folder;
    ASSERT_TRUE(Connection::open(folder / "models.sqlite", ours));
    chmod((folder / "models.sqlite").c_str(), 0444);
    chmod(folder.path().c_str(), 0755);
    const std::string told = as_another_person([&] {
        const auto connection = Connection::open(folder / "models.sqlite", ours);
        if (!connection) return connection.error().message();
        const auto migrated = migrate(**connection, model_migrations());
        return migrated ? "migrated" : migrated.error().message();
    });
    EXPECT_NE(told.find("has schema version 0"), std::string::npos) << told;
    EXPECT_NE(told.find("is read-only"), std::string::npos) << told;
}

// The last migration changes no table: a file that cannot be written is read without it.
TEST(Migrations, OfAReadOnlyFileAreLeftOutWhereReadingNeedsNone) {
    TemporaryFolder folder;
    {
        const auto connection = open_model_database(folder / "models.sqlite");
        ASSERT_TRUE(connection);
        ASSERT_TRUE((*connection)->execute("PRAGMA user_version = 5"));
    }
    chmod((folder / "models.sqlite").c_str(), 0444);
    chmod(folder.path().c_str(), 0755);
    const std::string told = as_another_person([&] {
        const auto connection = open_model_database(folder / "models.sqlite");
        return connection ? "opened" : connection.error().message();
    });
    EXPECT_EQ(told, "opened");
}

TEST(Migrations, KeepRowsOfAnOlderSchema) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    ASSERT_TRUE(migrate(**connection, std::span(steps, 1)));
    EXPECT_EQ(*(*connection)->query_integer("PRAGMA user_version"), 1);
    ASSERT_TRUE(migrate(**connection, steps));
    EXPECT_EQ(*(*connection)->query_integer("PRAGMA user_version"), 3);
    EXPECT_EQ(*(*connection)->query_integer("SELECT legs FROM model WHERE name = 'oak chair'"), 4);
    EXPECT_TRUE(migrate(**connection, steps));
}

TEST(Migrations, AFailingStepLeavesTheVersionBefore) {
    TemporaryFolder folder;
    auto connection = Connection::open(folder / "models.sqlite", ours);
    ASSERT_TRUE(connection);
    const Migration broken[] = {steps[0], {2, "CREATE TABLE half (x); CREATE TABLE half (x)"}};
    EXPECT_FALSE(migrate(**connection, broken));
    EXPECT_EQ(*(*connection)->query_integer("PRAGMA user_version"), 1);
    EXPECT_EQ(*(*connection)->query_integer("SELECT count(*) FROM sqlite_schema WHERE name = 'half'"), 0);
}

TEST(Migrations, TwoProcessesCreateOneDatabaseTogether) {
    TemporaryFolder folder;
    std::vector<pid_t> children;
    for (int i = 0; i < 4; ++i) {
        children.push_back(fork());
        ASSERT_GE(children.back(), 0);
        if (children.back() == 0) test::end_child(open_model_database(folder / "models.sqlite") ? 0 : 1);
    }
    for (const pid_t child : children) {
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
    auto connection = open_model_database(folder / "models.sqlite");
    ASSERT_TRUE(connection);
    EXPECT_TRUE((*connection)->check_integrity());
}

TEST(Migrations, OfModelsHaveNoGap) {
    int version = 0;
    for (const Migration& migration : model_migrations()) EXPECT_EQ(migration.version, ++version);
}

}  // namespace
}  // namespace embody::database
