// SPDX-License-Identifier: MIT
// A disk fills, a file breaks, a lock is held too long: any statement may fail, when it is compiled or at any of its
// instructions. Whichever does, the call says so, and with its transaction nothing of it is kept.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "database/change_table.h"
#include "database/decomposition_table.h"
#include "database/import_table.h"
#include "database/model_schema.h"
#include "database/model_table.h"
#include "database/simulation_mesh_table.h"
#include "database/temporary_folder.h"
#include "database/transaction.h"

namespace embody::database {
namespace {

enum class Fault { none, compiling, running };

/// Lets one compilation or one instruction fail, in databases that are opened while it lives.
class FaultInjector {
public:
    FaultInjector() { sqlite3_auto_extension(reinterpret_cast<void (*)()>(&FaultInjector::install)); }
    ~FaultInjector() {
        disarm();
        sqlite3_cancel_auto_extension(reinterpret_cast<void (*)()>(&FaultInjector::install));
    }
    FaultInjector(const FaultInjector&) = delete;
    FaultInjector& operator=(const FaultInjector&) = delete;

    /// The one after `count` others.
    static void arm(Fault fault, int count) {
        fault_ = fault;
        left_ = count;
        has_struck_ = false;
    }
    static void disarm() { fault_ = Fault::none; }
    [[nodiscard]] static bool has_struck() { return has_struck_; }

private:
    static int install(sqlite3* database, const char**, const void*) {
        sqlite3_progress_handler(
            database, 1,
            [](void* own) { return is_alone(static_cast<sqlite3*>(own)) && strikes(Fault::running) ? 1 : 0; },
            database);
        sqlite3_set_authorizer(
            database,
            [](void*, int action, const char*, const char*, const char*, const char*) {
                const bool is_read = action == SQLITE_READ || action == SQLITE_FUNCTION;  // a column of a statement
                return !is_read && strikes(Fault::compiling) ? SQLITE_DENY : SQLITE_OK;
            },
            nullptr);
        return SQLITE_OK;
    }
    // The full-text index runs statements of its own within ours, and does without some of them.
    static bool is_alone(sqlite3* database) {
        int busy = 0;
        for (sqlite3_stmt* one = nullptr; (one = sqlite3_next_stmt(database, one)) != nullptr;)
            busy += sqlite3_stmt_busy(one) != 0 ? 1 : 0;
        return busy == 1;
    }
    static bool strikes(Fault fault) {
        if (fault != fault_ || has_struck_ || left_-- > 0) return false;
        return has_struck_ = true;
    }

    static inline Fault fault_ = Fault::none;
    static inline int left_ = 0;
    static inline bool has_struck_ = false;
};

/// All rows of all tables, as text.
std::string content_of(const std::filesystem::path& file) {
    std::string content;
    const auto append = [](void* text, int count, char** values, char**) {
        for (int i = 0; i < count; ++i) {
            *static_cast<std::string*>(text) += values[i] != nullptr ? values[i] : "null";
            *static_cast<std::string*>(text) += '|';
        }
        return 0;
    };
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr), SQLITE_OK);
    std::string tables;
    sqlite3_exec(database, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name", append, &tables,
                 nullptr);
    for (std::size_t at = 0, end = 0; (end = tables.find('|', at)) != std::string::npos; at = end + 1) {
        const std::string table = tables.substr(at, end - at);
        sqlite3_exec(database, ("SELECT * FROM \"" + table + "\"").c_str(), append, &content, nullptr);
    }
    sqlite3_close(database);
    return content;
}

const std::vector<std::uint8_t> bytes{1, 2, 3};

ModelRow model(const std::string& key, std::uint64_t hash) {
    ModelRow row;
    row.key = key;
    row.name = "oak " + key;
    row.category = "furniture";
    row.tags = {"wood", "old"};
    row.file_hash = row.geometry_hash = hash;
    return row;
}

/// A call of the tables. True: it succeeded.
struct Call {
    const char* name;
    std::function<bool(Connection&)> run;
};

template <class Table, class Use>
Call call(const char* name, Use use) {
    return {name, [use](Connection& connection) {
                Table table(connection);
                return use(table).ok();
            }};
}

constexpr const char* key = "chair";
constexpr std::int64_t id = 1, batch = 1;

std::vector<Call> model_calls() {
    using Models = ModelTable;
    return {
        call<Models>("put",
                     [](auto& t) {
                         return t.put(model("stool", 9), {"{}", "[]"}, {bytes, bytes, bytes});
                     }),
        call<Models>("put again",
                     [](auto& t) {
                         return t.put(model(key, 4), {"{}", "[]"}, {bytes, bytes, bytes});
                     }),
        call<Models>("put_like",
                     [](auto& t) {
                         return t.put_like(id, model("stool", 9), {"{}", "[]"});
                     }),
        call<Models>("describe",
                     [](auto& t) {
                         ModelRow row = model(key, 1);
                         row.id = id;
                         return t.describe(row, {"{}", "[1]"});
                     }),
        call<Models>("put_knowledge",
                     [](auto& t) {
                         return t.put_knowledge(id, {"{}", "[2]"});
                     }),
        call<Models>("remove", [](auto& t) { return t.remove(id); }),
        call<Models>("find", [](auto& t) { return t.find(id); }),
        call<Models>("find_key", [](auto& t) { return t.find_key(key); }),
        call<Models>("find_name", [](auto& t) { return t.find_name("oak chair"); }),
        call<Models>("find_file", [](auto& t) { return t.find_file(1); }),
        call<Models>("search all", [](auto& t) { return t.search({}); }),
        call<Models>("search words", [](auto& t) { return t.search({.words = "oak"}); }),
        call<Models>("search category", [](auto& t) { return t.search({.category = "furniture"}); }),
        call<Models>("search both", [](auto& t) { return t.search({.words = "oak chair", .category = "furniture"}); }),
        call<Models>("count_categories", [](auto& t) { return t.count_categories(); }),
        call<Models>("count", [](auto& t) { return t.count(); }),
        call<Models>("ids", [](auto& t) { return t.ids(); }),
        call<Models>("knowledge", [](auto& t) { return t.knowledge(id); }),
        call<Models>("geometry", [](auto& t) { return t.geometry(id); }),
        call<Models>("hull_points", [](auto& t) { return t.hull_points(id); }),
        call<Models>("thumbnail", [](auto& t) { return t.thumbnail(id); }),
    };
}

std::vector<Call> other_calls() {
    using Attributes = ManualAttributeTable;
    using Changes = ChangeTable;
    using Imports = ImportTable;
    const auto change = ManualChange{1, key, "mass", {}, "3"};
    return {
        call<Attributes>("of", [](auto& t) { return t.of(key); }),
        call<Attributes>("find attribute", [](auto& t) { return t.find(key, "mass"); }),
        call<Attributes>("put attribute",
                         [](auto& t) {
                             return t.put(key, {"mass", "5", "ann"});
                         }),
        call<Attributes>("restore",
                         [](auto& t) {
                             return t.restore(key, {"mass", "6", "ann", 7});
                         }),
        call<Attributes>("erase", [](auto& t) { return t.erase(key, "mass"); }),
        call<Changes>("begin_batch", [](auto& t) { return t.begin_batch({.person = "bob", .command = "set"}); }),
        call<Changes>("add", [change](auto& t) { return t.add(batch, change); }),
        call<Changes>("mark_undone", [](auto& t) { return t.mark_undone(batch, batch); }),
        call<Changes>("find_batch", [](auto& t) { return t.find_batch(batch); }),
        call<Changes>("last_batch", [](auto& t) { return t.last_batch("ann"); }),
        call<Changes>("changes_of", [](auto& t) { return t.changes_of(batch); }),
        call<Changes>("changed_since", [change](auto& t) { return t.changed_since(change); }),
        call<Changes>("search changes", [](auto& t) { return t.search(ChangeSearch{.model_key = key}); }),
        call<Changes>("batches", [](auto& t) { return t.batches(BatchSearch{.model_key = key}); }),
        call<Changes>("newest_batch", [](auto& t) { return t.newest_batch(); }),
        call<Imports>("find import", [](auto& t) { return t.find("a.zip!b.obj"); }),
        call<Imports>("find_in_archive", [](auto& t) { return t.find_in_archive("a.zip"); }),
        call<Imports>("put import",
                      [](auto& t) {
                          return t.put({"c.obj", id, "now", 1, 2, 3});
                      }),
        call<Imports>("locations_of", [](auto& t) { return t.locations_of(id); }),
        call<Imports>("has_preparation", [](auto& t) { return t.has_preparation(id, 2); }),
        call<Imports>("forget_other_preparations", [](auto& t) { return t.forget_other_preparations(id, 5); }),
        call<SettingTable>("get", [](auto& t) { return t.get("language"); }),
        call<SettingTable>("put setting", [](auto& t) { return t.put("language", "zh"); }),
        call<DecompositionTable>("put parts",
                                 [](auto& t) {
                                     return t.put(id, {8, 100, 0.1, 0.2, bytes});
                                 }),
        call<DecompositionTable>("find parts", [](auto& t) { return t.find(id, 16, 100); }),
        call<DecompositionTable>("forget parts", [](auto& t) { return t.forget(id); }),
        call<SimulationMeshTable>("put mesh",
                                  [](auto& t) {
                                      return t.put(id, {"soft", 2, "", bytes});
                                  }),
        call<SimulationMeshTable>("find mesh", [](auto& t) { return t.find(id, "soft"); }),
        call<SimulationMeshTable>("forget mesh", [](auto& t) { return t.forget(id); }),
    };
}

void fill(Connection& connection) {
    auto transaction = Transaction::begin(connection);
    ASSERT_TRUE(transaction.ok());
    ModelTable models(connection);
    ASSERT_TRUE(models.put(model(key, 1), {"{}", "[]"}, {bytes, bytes, bytes}));
    ASSERT_TRUE(models.put(model("table", 2), {"{}", "[]"}, {bytes, bytes, bytes}));
    ASSERT_TRUE(ManualAttributeTable(connection).put(key, {"mass", "3", "ann"}));
    ChangeTable changes(connection);
    for (int i = 0; i < 2; ++i) {
        const auto made = changes.begin_batch({.person = "ann", .session = "s", .command = "set", .asked = "{}"});
        ASSERT_TRUE(made.ok());
        ASSERT_TRUE(changes.add(*made, {0, key, "mass", {}, "3"}));
    }
    ASSERT_TRUE(ImportTable(connection).put({"a.zip!b.obj", id, "now", 1, 2, 3}));
    ASSERT_TRUE(SettingTable(connection).put("language", "en"));
    ASSERT_TRUE(DecompositionTable(connection).put(id, {16, 100, 0.1, 0.2, bytes}));
    ASSERT_TRUE(SimulationMeshTable(connection).put(id, {"soft", 1, "", bytes}));
    ASSERT_TRUE(transaction->commit().ok());
}

// Lets the first statement of the call fail, then the second, and so on until the call needs no more.
void expect_told(const Call& call, Fault fault, const std::filesystem::path& file) {
    SCOPED_TRACE(testing::Message() << call.name << (fault == Fault::compiling ? ", compiling" : ", running"));
    const std::string before = content_of(file);
    int told = 0;
    for (bool has_struck = true; has_struck && !testing::Test::HasFailure(); ++told) {
        // A new connection has compiled nothing yet.
        const auto connection = open_model_database(file);
        ASSERT_TRUE(connection.ok());
        bool succeeded = false;
        {
            auto transaction = Transaction::begin(**connection);
            ASSERT_TRUE(transaction.ok());
            FaultInjector::arm(fault, told);
            succeeded = call.run(**connection);
            has_struck = FaultInjector::has_struck();
            FaultInjector::disarm();
        }
        EXPECT_EQ(succeeded, !has_struck) << "fault " << told;
        EXPECT_EQ(content_of(file), before) << "fault " << told;
    }
    EXPECT_GT(told, 1);
}

class Faults : public testing::TestWithParam<Fault> {};

TEST_P(Faults, OfAnyStatementAreToldAndLeaveEverythingAsItWas) {
    const FaultInjector injector;
    const test::TemporaryFolder folder;
    const std::filesystem::path file = folder / "models.sqlite";
    fill(**open_model_database(file));
    for (const auto& calls : {model_calls(), other_calls()}) {
        for (const Call& call : calls) expect_told(call, GetParam(), file);
    }
}

TEST_P(Faults, OfTheFirstOpeningLeaveAFileThatOpens) {
    const FaultInjector injector;
    const test::TemporaryFolder folder;
    int told = 0;
    for (int count = 0; count < 3000; count += 1 + count / 4) {
        const std::filesystem::path file = folder / (std::to_string(count) + ".sqlite");
        FaultInjector::arm(GetParam(), count);
        told += open_model_database(file).ok() ? 0 : 1;
        FaultInjector::disarm();
        const auto again = open_model_database(file);
        ASSERT_TRUE(again.ok()) << "fault " << count << ": " << again.error().message();
        EXPECT_TRUE((*again)->check_integrity().ok()) << "fault " << count;
    }
    EXPECT_GT(told, 10);
}

INSTANTIATE_TEST_SUITE_P(Each, Faults, testing::Values(Fault::compiling, Fault::running),
                         [](const auto& info) { return info.param == Fault::compiling ? "Compiling" : "Running"; });

}  // namespace
}  // namespace embody::database
