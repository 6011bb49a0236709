// SPDX-License-Identifier: MIT
// For every field of an entity or a document: a change of it is told, undone, done again and saved. The fields are
// those of the lists (scene/document/field_list.h), so that a new one is tested as soon as it is in a list.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <type_traits>

#include "foundation/random.h"
#include "scene/file/json/fields_json.h"
#include "scene/file/json/parts.h"
#include "scene/file/scene_file.h"
#include "scene/live_scene.h"
#include "scene/sample_documents.h"

namespace embody::scene {
namespace {

using nlohmann::json;

template <class OneField>
using MemberOf = typename std::remove_cvref_t<OneField>::Member;
template <class OneField>
constexpr bool is_saved = std::remove_cvref_t<OneField>::saved != Saved::never;

/// Makes another valid value of a field.
class OtherValue {
public:
    explicit OtherValue(std::uint64_t seed) : random_(seed) {}

    void change(bool& value) { value = !value; }
    void change(int& value) { value = value % 60 + 1; }
    void change(std::uint32_t& value) { value += 1 + static_cast<std::uint32_t>(random_.below(1000)); }
    void change(double& value) { value = value == 0 ? random_.between(0.1, 1) : value * random_.between(0.5, 0.9); }
    void change(std::string& value) { value += " " + std::to_string(random_.next()); }
    void change(Finish& value) { value = value == Finish::parquet ? Finish::brick : Finish::parquet; }
    void change(Vec3& value) { value += Vec3{random_.between(0.1, 1), random_.between(-1, 1), random_.between(-1, 1)}; }
    void change(Transform& value) {
        change(value.position);
        value.rotation = normalized(Quat{random_.unit(), random_.unit(), random_.unit(), 1});
    }
    void change(std::optional<std::array<double, 3>>& value) {
        value = {random_.unit(), random_.unit(), random_.unit()};
    }
    template <class Value>
    void change(std::optional<Value>& value) {
        if (!value) value.emplace();
        change(*value);
    }
    void change(SharedOptional<KeptForm>& value) {
        KeptForm form{.fingerprint = "0123456789abcdef", .broken = {1, 5}, .cell_size = random_.unit()};
        for (PackedNumbers* numbers : {&form.places, &form.plastic_strain, &form.bend})
            for (int i = 0; i < 30; ++i) numbers->values.push_back(random_.between(-1, 1));
        value = form;
    }
    void change(std::vector<Pin>& value) {
        Pin pin{.to = 1, .clamped = true};
        change(pin.position);
        change(pin.radius);
        value.push_back(pin);
    }
    void change(std::vector<Level>& value) {
        Level level;
        change(level.name);
        change(level.elevation);
        change(level.height);
        value.push_back(level);
    }
    void change(std::map<std::string, attributes::AttributeValue>& value) { value["restitution"] = random_.unit(); }
    void change(Geometry& value) {
        physics::BoxShape box;
        change(box.half_extents.x);
        value = physics::ShapeDefinition{box};
    }
    template <Listed Value>
    void change(Value& value) {
        for_each_field<Value>([&](const auto& field) {
            if constexpr (is_saved<decltype(field)>) change(value.*field.member);
        });
    }

private:
    Random random_;
};

/// Shapes have no operator ==, and are compared by their JSON.
bool are_alike(const Entity& a, const Entity& b) {
    bool alike = true;
    for_each_field<Entity>([&](const auto& field) {
        if constexpr (std::is_same_v<MemberOf<decltype(field)>, Geometry>) {
            json of_a, of_b;
            write_field(of_a, field, a);
            write_field(of_b, field, b);
            alike = alike && of_a == of_b;
        } else {
            alike = alike && are_same(a.*field.member, b.*field.member);
        }
    });
    return alike;
}
bool are_alike(const Heading& a, const Heading& b) { return are_same(a, b); }

class EveryField : public samples::LiveSession {
protected:
    void SetUp() override { open(samples::floor_and_box()); }

    /// The first change in the last event of the document.
    json told() {
        json change;
        for (const json& message : session_->take_events().messages)
            if (message["event"] == "document") change = message["changes"].at(0);
        return change;
    }
    Document loaded() {
        const auto file =
            std::filesystem::temp_directory_path() / ("every_field_" + std::to_string(getpid()) + ".json");
        EXPECT_TRUE(save_document(session_->document(), file).ok());
        Result<Document> read = load_document(file);
        std::filesystem::remove(file);
        EXPECT_TRUE(read.ok()) << (read.ok() ? "" : read.error().message());
        return read.ok() ? std::move(read).value() : Document{};
    }

    OtherValue other_{20261123};
};

TEST_F(EveryField, OfAnEntityIsToldUndoneAndSaved) {
    int count = 0;
    for_each_field<Entity>([&](const auto& field) {
        if constexpr (std::is_same_v<MemberOf<decltype(field)>, EntityIndex>) return;
        const Entity before = *session_->document().find(samples::thing);
        Entity changed = before;
        other_.change(changed.*field.member);
        ASSERT_FALSE(are_alike(before, changed)) << field.name;

        json fields = json::object();
        write_field(fields, field, changed);
        run("entity.update", {{"index", samples::thing}, {"entity", fields}});
        EXPECT_TRUE(are_alike(*session_->document().find(samples::thing), changed)) << field.name;
        const json change = told();
        for (const auto& [name, value] : fields.items()) {
            const json told_value = name == "kept" ? json{{"points", 10}} : value;
            EXPECT_EQ(change["entity"][name], told_value) << name;
        }

        run("edit.undo");
        EXPECT_TRUE(are_alike(*session_->document().find(samples::thing), before)) << field.name;
        run("edit.redo");
        EXPECT_TRUE(are_alike(*session_->document().find(samples::thing), changed)) << field.name;
        EXPECT_TRUE(are_alike(*loaded().find(samples::thing), changed)) << field.name;
        ++count;
    });
    EXPECT_EQ(count + 1, static_cast<int>(count_members<Entity>()));
}

TEST_F(EveryField, OfTheDocumentIsToldUndoneAndSaved) {
    int count = 0;
    const auto try_field = [&](const auto& field, auto& owner_of) {
        using Value = MemberOf<decltype(field)>;
        if constexpr (is_saved<decltype(field)> && !std::is_same_v<Value, physics::WorldSettings>) {
            const Heading before = session_->document();
            Heading changed = before;
            Value& value = owner_of(changed).*field.member;
            other_.change(value);
            json fields = json::object();
            write_value(fields, field.name, value);
            run("scene.settings", fields);
            EXPECT_TRUE(are_alike(session_->document(), changed)) << field.name;
            EXPECT_EQ(told()["settings"][field.name], fields[field.name]);

            run("edit.undo");
            EXPECT_TRUE(are_alike(session_->document(), before)) << field.name;
            EXPECT_TRUE(told()["settings"].contains(field.name)) << "also what is no more is told: " << field.name;
            run("edit.redo");
            EXPECT_TRUE(are_alike(session_->document(), changed)) << field.name;
            EXPECT_TRUE(are_alike(loaded(), changed)) << field.name;
            ++count;
        }
    };
    const auto whole = [](Heading& heading) -> Heading& { return heading; };
    const auto settings = [](Heading& heading) -> physics::WorldSettings& { return heading.settings; };
    for_each_field<Heading>([&](const auto& field) { try_field(field, whole); });
    for_each_field<physics::WorldSettings>([&](const auto& field) { try_field(field, settings); });
    EXPECT_EQ(count, 6 + 12);
}

TEST_F(EveryField, AllAtOnceAreSaved) {
    Document document = samples::floor_and_box();
    other_.change(static_cast<Heading&>(document));
    Entity& box = *document.find(samples::thing);
    other_.change(box);
    document.next_index = box.index + 1;
    const Result<Document> read = document_from_json(document_to_json(document));
    ASSERT_TRUE(read.ok()) << read.error().message();
    EXPECT_TRUE(are_alike(read.value(), document));
    EXPECT_TRUE(are_alike(read.value().entities.back(), box));
}

}  // namespace
}  // namespace embody::scene
