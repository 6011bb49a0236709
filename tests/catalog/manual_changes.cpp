// SPDX-License-Identifier: MIT
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <set>

#include "attributes/physical_kind.h"
#include "catalog/catalog.h"
#include "catalog/import_fixture.h"
#include "end_child.h"

namespace embody::catalog {
namespace {

using attributes::AttributeLevel;

constexpr std::size_t chairs = 12;

/// Chairs, and a cushion, which is soft.
class ManualChangesTest : public ImportTest {
protected:
    void SetUp() override {
        for (std::size_t i = 0; i < chairs; ++i)
            write_model("chair " + std::string(1, static_cast<char>('a' + i)) + ".obj", std::string(60 + i, 'x'));
        write_model("cushion.obj", std::string(40, 'y'));
        ASSERT_TRUE(import());
        catalog_ = open();
    }
    [[nodiscard]] std::optional<double> manual(const std::string& name, const char* attribute = "mass") const {
        const auto set = catalog_->attributes(catalog_->model(name)->id);
        const auto* entry = set->find(attribute);
        if (entry == nullptr || entry->level != AttributeLevel::manual) return std::nullopt;
        return std::get<double>(entry->value);
    }
    [[nodiscard]] std::size_t chairs_of(double mass) const {
        std::size_t count = 0;
        const auto page = catalog_->search({.words = "chair"});
        for (const ModelSummary& model : page->models) count += manual(model.key) == mass ? 1 : 0;
        return count;
    }
    Result<ChangeReport> set_chairs(double mass, const ChangeOptions& options = {}) const {
        return catalog_->change_attributes(SearchQuery{.words = "chair", .limit = 1}, {{"mass", mass}}, options);
    }
    /// Runs `act` in a process of its own, with a catalogue of its own; returns the process's exit status.
    template <class Act>
    pid_t start(const Act& act) const {
        const pid_t child = fork();
        if (child != 0) return child;
        auto own = Catalog::open(database(), taxonomy_folder);
        if (own) act(**own);
        test::end_child(own ? 0 : 1);
    }
    static int end_of(pid_t child) {
        int status = 0;
        waitpid(child, &status, 0);
        return status;
    }

    std::unique_ptr<Catalog> catalog_;
};

TEST_F(ManualChangesTest, RefusesWhatIsWrongBeforeAnythingIsDone) {
    const std::vector<std::int64_t> some = {catalog_->model("chair a")->id, 999'999};
    EXPECT_FALSE(catalog_->change_attributes(some, {{"mass", 5.0}}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {{"mas", 5.0}}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {{"mas"}}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {{"mass", -5.0}}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {{"mass", 5.0}, {"mass"}}));
    EXPECT_FALSE(catalog_->change_attributes(SearchQuery{}, {{"mass"}}, {.reset_all = true}));
    EXPECT_FALSE(catalog_->undo_changes(0));
    EXPECT_FALSE(catalog_->undo_changes(7));
    EXPECT_TRUE(catalog_->history({})->empty());
    EXPECT_EQ(manual("chair a"), std::nullopt);
}

TEST_F(ManualChangesTest, AMaterialBringsItsDensityAndFrictionAndMustBeKnown) {
    const auto id = catalog_->model("chair a")->id;
    const auto density = [&] { return catalog_->attributes(id)->number("density", 0); };
    const double before = density();
    ASSERT_TRUE(catalog_->set_attribute(id, "surface_material", std::string("polished steel")));
    const auto steel = catalog_->attributes(id);
    EXPECT_EQ(steel->word("surface_material", ""), "steel");
    EXPECT_NEAR(steel->number("density", 0), 7850, 100);
    EXPECT_NE(density(), before);
    EXPECT_FALSE(catalog_->set_attribute(id, "surface_material", std::string("unobtainium")));
    EXPECT_EQ(catalog_->attributes(id)->word("surface_material", ""), "steel");
    ASSERT_TRUE(catalog_->reset_attribute(id, "surface_material"));
    EXPECT_EQ(density(), before);
}

TEST_F(ManualChangesTest, AnAttributeThatDoesNotApplyToAModelStopsAllOrIsSkipped) {
    const std::vector<AttributeChange> softness = {{"youngs_modulus", 1e5}};
    const auto refused = catalog_->change_attributes(SearchQuery{}, softness);
    ASSERT_TRUE(refused);
    EXPECT_EQ(refused->refused.size(), chairs);
    EXPECT_EQ(refused->batch, 0);
    EXPECT_NE(refused->refused.front().why.find("rigid"), std::string::npos);
    EXPECT_EQ(manual("cushion", "youngs_modulus"), std::nullopt);
    EXPECT_FALSE(catalog_->set_attribute(catalog_->model("chair a")->id, "youngs_modulus", 1e5));

    const auto skipped = catalog_->change_attributes(SearchQuery{}, softness, {.skip_refused = true});
    ASSERT_TRUE(skipped);
    EXPECT_EQ(skipped->models.size(), 1u);
    EXPECT_EQ(manual("cushion", "youngs_modulus"), 1e5);

    // The other attribute applies to a chair that becomes soft in the same change.
    const std::vector<std::int64_t> chair = {catalog_->model("chair a")->id};
    ASSERT_TRUE(
        catalog_->change_attributes(chair, {{"kind", to_value(attributes::PhysicalKind::soft)}, softness.front()}));
    EXPECT_EQ(manual("chair a", "youngs_modulus"), 1e5);
    EXPECT_EQ(catalog_->model("chair a")->physical_kind, attributes::PhysicalKind::soft);
}

TEST_F(ManualChangesTest, AQueryMeansAllThatItFindsAndADryRunChangesNothing) {
    const auto planned = set_chairs(5, {.dry_run = true});
    ASSERT_TRUE(planned);
    EXPECT_EQ(planned->models.size(), chairs);
    EXPECT_EQ(chairs_of(5), 0u);
    std::size_t told = 0;
    const auto done = set_chairs(5, {.progress = [&](std::size_t now, std::size_t total) {
                                     EXPECT_EQ(now, ++told);
                                     EXPECT_EQ(total, chairs);
                                     return true;
                                 }});
    ASSERT_TRUE(done);
    EXPECT_EQ(told, chairs);
    EXPECT_EQ(chairs_of(5), chairs);
    const auto again = set_chairs(5);
    EXPECT_EQ(again->unchanged, chairs);
    EXPECT_EQ(again->batch, 0);
}

TEST_F(ManualChangesTest, StoppedOrKilledHalfWayNothingIsChanged) {
    ASSERT_TRUE(set_chairs(5));
    EXPECT_FALSE(set_chairs(6, {.progress = [](std::size_t now, std::size_t) { return now < 3; }}));
    EXPECT_EQ(chairs_of(5), chairs);
    catalog_.reset();
    const pid_t child = start([](Catalog& own) {
        (void)own.change_attributes(SearchQuery{.words = "chair"}, {{"mass", 7.0}, {"category", std::string("mine")}},
                                    {.progress = [](std::size_t now, std::size_t) {
                                        if (now == chairs / 2) (void)raise(SIGKILL);
                                        return true;
                                    }});
    });
    EXPECT_TRUE(WIFSIGNALED(end_of(child)));
    catalog_ = open();
    EXPECT_EQ(chairs_of(5), chairs);
    EXPECT_EQ(catalog_->search({.category = "mine"})->total, 0);
    EXPECT_EQ(catalog_->history({})->size(), chairs);
    ASSERT_TRUE(set_chairs(8));
    EXPECT_EQ(chairs_of(8), chairs);
}

TEST_F(ManualChangesTest, ProcessesThatChangeAtTheSameTimeTakeTurns) {
    catalog_.reset();
    std::vector<pid_t> children;
    for (int one = 1; one <= 4; ++one) {
        children.push_back(start([one](Catalog& own) {
            for (int round = 0; round < 5; ++round)
                (void)own.change_attributes(SearchQuery{.words = "chair"}, {{"mass", 10.0 * round + one}});
        }));
    }
    for (const pid_t child : children) EXPECT_EQ(end_of(child), 0);
    catalog_ = open();
    // Every change affected all chairs or was not needed, and each saw the result of the one before it.
    const auto history = catalog_->history({.limit = 10'000});
    EXPECT_EQ(history->size(), 20 * chairs);
    std::map<std::string, attributes::AttributeValue> present;
    for (auto record = history->rbegin(); record != history->rend(); ++record) {
        const auto before = present.find(record->model_key);
        EXPECT_EQ(record->before.has_value(), before != present.end());
        if (record->before && before != present.end()) {
            EXPECT_EQ(*record->before, before->second);
        }
        present[record->model_key] = *record->after;
    }
    EXPECT_EQ(chairs_of(std::get<double>(*history->front().after)), chairs);
}

TEST_F(ManualChangesTest, TheHistoryTellsWhoChangedWhatAndOutlivesTheModel) {
    setenv("USER", "ada", 1);
    catalog_ = open();
    catalog_->set_session("Studio client 2");
    const auto model = catalog_->model("chair b");
    ASSERT_TRUE(catalog_->set_attribute(model->id, "mass", 4.0));
    ASSERT_TRUE(catalog_->set_attribute(model->id, "mass", 5.0));
    ASSERT_TRUE(catalog_->reset_attribute(model->id, "mass"));
    ASSERT_TRUE(catalog_->reset_attribute(model->id, "mass"));  // nothing to change, so nothing is recorded
    ASSERT_TRUE(catalog_->remove(model->id));
    const auto history = catalog_->history({.model_key = model->key});
    ASSERT_TRUE(history);
    ASSERT_EQ(history->size(), 3u);
    const ChangeRecord& last = history->front();
    EXPECT_EQ(last.command, "reset");
    EXPECT_EQ(last.author.person, "ada");
    EXPECT_EQ(last.author.session, "Studio client 2");
    EXPECT_EQ(last.before, attributes::AttributeValue(5.0));
    EXPECT_EQ(last.after, std::nullopt);
    EXPECT_EQ(last.model_name, "");
    EXPECT_EQ(history->back().before, std::nullopt);
    EXPECT_EQ(catalog_->history({.since = last.made_at + 1000})->size(), 0u);

    // The model's change is there when it returns, and can still be undone.
    ASSERT_TRUE(catalog_->undo_changes(last.batch));
    ASSERT_TRUE(import({models()}));
    EXPECT_EQ(manual("chair b"), 5.0);
    EXPECT_EQ(catalog_->history({.limit = 1})->front().model_name, "chair b");
}

TEST_F(ManualChangesTest, UndoRestoresValueAuthorAndTime) {
    setenv("USER", "ada", 1);
    catalog_ = open();
    const std::int64_t id = catalog_->model("chair a")->id;
    ASSERT_TRUE(catalog_->set_attribute(id, "mass", 4.0));
    const std::string source = catalog_->attributes(id)->find("mass")->source;
    setenv("USER", "bob", 1);
    catalog_ = open();
    const auto batch = set_chairs(9);
    ASSERT_TRUE(batch);
    EXPECT_NE(catalog_->attributes(id)->find("mass")->source, source);
    const auto undone = catalog_->undo_changes(0);
    ASSERT_TRUE(undone);
    EXPECT_EQ(undone->command, "undo");
    EXPECT_EQ(catalog_->attributes(id)->find("mass")->source, source);
    EXPECT_EQ(manual("chair b"), std::nullopt);
    EXPECT_FALSE(catalog_->undo_changes(batch->batch));  // already undone
    EXPECT_FALSE(catalog_->undo_changes(0));             // the other changes are ada's

    // The undo of an undo applies the change again, any number of times.
    const auto redone = catalog_->undo_changes(undone->batch);
    ASSERT_TRUE(redone);
    EXPECT_EQ(redone->command, "redo");
    EXPECT_EQ(chairs_of(9), chairs);
    EXPECT_FALSE(catalog_->undo_changes(undone->batch));
    ASSERT_TRUE(catalog_->undo_changes(redone->batch));
    EXPECT_EQ(manual("chair a"), 4.0);
    EXPECT_EQ(chairs_of(9), 0u);
}

TEST_F(ManualChangesTest, UndoRefusesWhatWasChangedSince) {
    const auto first = set_chairs(5);
    ASSERT_TRUE(catalog_->set_attribute(catalog_->model("chair c")->id, "mass", 6.0));
    const auto refused = catalog_->undo_changes(first->batch);
    ASSERT_TRUE(refused);
    ASSERT_EQ(refused->refused.size(), 1u);
    EXPECT_EQ(refused->refused.front().name, "chair c");
    EXPECT_EQ(refused->batch, 0);
    EXPECT_EQ(chairs_of(5), chairs - 1);
    // After the later change is undone, the earlier one can be undone; then the later one cannot be redone.
    const auto later = catalog_->undo_changes(0);
    ASSERT_TRUE(later);
    EXPECT_NE(catalog_->undo_changes(first->batch)->batch, 0);
    EXPECT_EQ(chairs_of(5), 0u);
    const auto ungrounded = catalog_->undo_changes(later->batch);
    ASSERT_TRUE(ungrounded);
    EXPECT_EQ(ungrounded->refused.size(), 1u);
    EXPECT_EQ(manual("chair c"), std::nullopt);
}

TEST_F(ManualChangesTest, UndoOfACategoryListsTheModelsWhereTheyWere) {
    ASSERT_TRUE(catalog_->change_attributes(SearchQuery{.words = "chair"}, {{"category", std::string("throne")}}));
    EXPECT_EQ(catalog_->search({.category = "throne"})->total, static_cast<std::int64_t>(chairs));
    ASSERT_TRUE(catalog_->undo_changes(0));
    EXPECT_EQ(catalog_->search({.category = "throne"})->total, 0);
    EXPECT_EQ(catalog_->search({.category = "chair"})->total, static_cast<std::int64_t>(chairs));
}

}  // namespace
}  // namespace embody::catalog
