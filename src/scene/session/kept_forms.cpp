// SPDX-License-Identifier: MIT
#include "scene/session/kept_forms.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace embody::scene {

using nlohmann::json;

namespace {

struct ShownEntity {
    Transform pose;
    SharedOptional<KeptForm> form;
};

std::map<EntityIndex, ShownEntity> shown_now(const SessionState& state) {
    const bool has_run = state.play_state != PlayState::stopped;
    std::map<EntityIndex, ShownEntity> shown;
    for (const EntityIndex index : state.simulation->entities())
        shown[index] = {state.simulation->pose(index),
                        has_run ? state.simulation->kept_form(index) : SharedOptional<KeptForm>()};
    return shown;
}

std::map<EntityIndex, ShownEntity> shown_at(const SessionState& state, const Moment& moment) {
    std::map<EntityIndex, ShownEntity> shown;
    for (const EntityMoment& was : moment.entities) {
        const EntityIndex index = was.motion.entity;
        const Entity* entity = state.document.find(index);
        std::vector<std::uint32_t> broken = state.past.broken_at(index, moment.time);
        if (entity && entity->kept)
            broken.insert(broken.end(), entity->kept->broken.begin(), entity->kept->broken.end());
        std::ranges::sort(broken);
        broken.erase(std::unique(broken.begin(), broken.end()), broken.end());
        shown[index] = {was.motion.pose, state.simulation->kept_form(was, std::move(broken))};
    }
    return shown;
}

// Of what the entity's points are made from, as the document has it; empty where it is none or has no points.
std::string fingerprint_of(SessionState& state, const Entity& entity) {
    const Result<attributes::AttributeSet> acting = state.definitions.attributes.acting(entity);
    if (!acting.ok()) return {};
    return state.definitions.points.form(entity, acting.value(), false).kept_fit.fingerprint;
}

// What melted into a liquid is kept as a part of that liquid's form: it must not be there twice.
void disable_melted(const SessionState& state, const std::map<EntityIndex, ShownEntity>& shown, Edit& edit) {
    std::set<EntityIndex> kept;
    for (const Change& item : edit.changes) {
        const auto* change = std::get_if<EntityChange>(&item);
        if (change != nullptr && change->after && change->after->kept) kept.insert(change->after->index);
    }
    for (const auto& [index, melted] : state.past.melted) {
        const Entity* thing = state.document.find(index);
        if (thing == nullptr || shown.contains(index) || !kept.contains(melted.liquid)) continue;
        EntityChange change = change_of(*thing, *thing);
        change.after->enabled = false;
        edit.changes.emplace_back(std::move(change));
    }
}

bool may_be_unfit(const EntityChange& change) {
    if (!change.before || !change.after || !change.after->kept) return false;
    const Entity &before = *change.before, &after = *change.after;
    if (!before.kept.is_copy_of(after.kept)) return false;
    return !change.same_geometry || before.attributes != after.attributes || before.scale != after.scale ||
           before.category != after.category;
}

}  // namespace

Edit edit_of_shown(SessionState& state) {
    const std::map<EntityIndex, ShownEntity> all =
        state.past.shown ? shown_at(state, *state.past.shown) : shown_now(state);
    Edit edit = state.start_edit("Keep poses and forms");
    for (const Entity& entity : state.document.entities) {
        const auto found = all.find(entity.index);
        if (found == all.end() || entity.locked) continue;
        const auto& [pose, form] = found->second;
        // An action may have made other points of it in the run: the document's have no such form.
        const bool has_new_form =
            form && !form.is_copy_of(entity.kept) && form->fingerprint == fingerprint_of(state, entity);
        if (has_new_form) {
            EntityChange change = change_of(entity, entity);
            change.after->pose = pose;
            change.after->kept = form;
            edit.changes.emplace_back(std::move(change));
        } else if (pose != entity.pose) {
            edit.changes.emplace_back(PoseChange{entity.index, entity.pose, pose});
        }
    }
    disable_melted(state, all, edit);
    return edit;
}

std::vector<std::string> drop_unfit_forms(SessionState& state, Edit& edit) {
    std::vector<std::string> told;
    for (Change& item : edit.changes) {
        auto* change = std::get_if<EntityChange>(&item);
        if (change == nullptr || !may_be_unfit(*change)) continue;
        Entity after = *change->after;
        if (change->same_geometry) after.geometry = state.document.find(after.index)->geometry;
        const Result<attributes::AttributeSet> acting = state.definitions.attributes.acting(after);
        if (!acting.ok() || state.definitions.points.check_kept(after, acting.value()).ok()) continue;
        change->after->kept.reset();
        told.push_back(state.called({after.index}) +
                       " begins as modelled again: the form that was kept is of other points. Undo brings it back.");
    }
    return told;
}

bool change_kept_forms(const std::vector<Change>& changes) {
    return std::ranges::any_of(changes, [](const Change& item) {
        const auto* change = std::get_if<EntityChange>(&item);
        return change != nullptr && change->before && change->after &&
               !change->before->kept.is_copy_of(change->after->kept);
    });
}

void tell_in_short(json& entity) {
    const auto kept = entity.find("kept");
    if (kept == entity.end() || !kept->is_object()) return;
    std::size_t characters = 0;
    for (const json& line : (*kept)["places"]) characters += line.get_ref<const std::string&>().size();
    constexpr std::size_t bytes_per_point = 3 * sizeof(double);
    *kept = {{"points", characters / 4 * 3 / bytes_per_point}};
}

void tell_changes_in_short(json& changes, const Document& document) {
    for (json& change : changes) {
        if (change["op"] == "reset") tell_scene_in_short(change["scene"]);
        if (change["op"] != "entity") continue;
        json& entity = change["entity"];
        change.erase("same_kept");
        entity.erase("kept");
        const Entity* present = document.find(entity["index"].get<EntityIndex>());
        if (present && present->kept) entity["kept"] = {{"points", present->kept->places.values.size() / 3}};
    }
}

void tell_scene_in_short(json& scene) {
    for (json& entity : scene["entities"]) tell_in_short(entity);
}

}  // namespace embody::scene
