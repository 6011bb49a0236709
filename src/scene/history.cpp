// SPDX-License-Identifier: MIT
#include "scene/history.h"

#include <algorithm>

namespace embody::scene {

namespace {

constexpr std::size_t most_edits = 1000;

// Puts an item in a list that is kept ascending by its number, or takes it out.
template <class Item, class Number>
void put_item(std::vector<Item>& items, Number Item::*number, const std::optional<Item>& before,
              const std::optional<Item>& after) {
    const Number key = before ? (*before).*number : (*after).*number;
    const auto place = std::lower_bound(items.begin(), items.end(), key,
                                        [number](const Item& item, Number wanted) { return item.*number < wanted; });
    const bool is_there = place != items.end() && (*place).*number == key;
    if (!after) {
        if (is_there) items.erase(place);
    } else if (is_there) {
        *place = *after;
    } else {
        items.insert(place, *after);
    }
}

struct Applier {
    Document& document;

    void operator()(const EntityChange& change) const {
        if (!change.same_geometry) return put_item(document.entities, &Entity::index, change.before, change.after);
        Entity* entity = document.find(change.after->index);
        auto geometry = std::move(entity->geometry);
        *entity = *change.after;
        entity->geometry = std::move(geometry);
    }
    void operator()(const PoseChange& change) const { document.find(change.index)->pose = change.after; }
    void operator()(const JointChange& change) const {
        put_item(document.joints, &SceneJoint::index, change.before, change.after);
    }
    void operator()(const ActionChange& change) const {
        put_item(document.actions, &Action::id, change.before, change.after);
    }
    void operator()(const HeadingChange& change) const {
        document.title = change.after.title;
        document.description = change.after.description;
        document.settings = change.after.settings;
        document.camera = change.after.camera;
    }
};

Entity without_geometry(const Entity& entity) {
    Entity out;
    out.index = entity.index;
    out.name = entity.name;
    out.attributes = entity.attributes;
    out.pose = entity.pose;
    out.linear_velocity = entity.linear_velocity;
    out.angular_velocity = entity.angular_velocity;
    out.force = entity.force;
    out.torque = entity.torque;
    out.enabled = entity.enabled;
    out.start_asleep = entity.start_asleep;
    out.allow_sleep = entity.allow_sleep;
    out.continuous = entity.continuous;
    out.category = entity.category;
    out.color = entity.color;
    out.scale = entity.scale;
    out.pins = entity.pins;
    return out;
}

}  // namespace

EntityChange change_of(const Entity& before, const Entity& after) {
    return {without_geometry(before), without_geometry(after), true};
}

Heading heading_of(const Document& document) {
    return {document.title, document.description, document.settings, document.camera};
}

void apply_change(Document& document, const Change& change) { std::visit(Applier{document}, change); }

Change reversed(const Change& change) {
    Change back = change;
    std::visit([](auto& item) { std::swap(item.before, item.after); }, back);
    return back;
}

// A drag is many small edits of the same poses, or of the same entity: the first state and the last one count.
bool History::merge(Edit& edit) {
    if (!merging_ || done_.empty() || edit.merge.empty() || done_.back().merge != edit.merge || is_saved())
        return false;
    for (Change& change : edit.changes) {
        const auto same =
            std::find_if(done_.back().changes.begin(), done_.back().changes.end(), [&](const Change& old) {
                const auto* was_moved = std::get_if<PoseChange>(&old);
                const auto* moved = std::get_if<PoseChange>(&change);
                if (was_moved && moved) return was_moved->index == moved->index;
                const auto* was_changed = std::get_if<EntityChange>(&old);
                const auto* changed = std::get_if<EntityChange>(&change);
                return was_changed && changed && was_changed->same_geometry && changed->same_geometry &&
                       was_changed->after->index == changed->after->index;
            });
        if (same == done_.back().changes.end()) {
            done_.back().changes.push_back(std::move(change));
        } else if (auto* moved = std::get_if<PoseChange>(&*same)) {
            moved->after = std::get<PoseChange>(change).after;
        } else {
            std::get<EntityChange>(*same).after = std::get<EntityChange>(change).after;
        }
    }
    done_.back().next_after = edit.next_after;
    return true;
}

void History::add(Edit edit) {
    // What was undone can't be redone on another document; if it was on disk it is not any more.
    if (saved_ > document_edits_) saved_ = -1;
    undone_.clear();
    if (merge(edit)) return;
    if (!edit.catalog) ++document_edits_;
    done_.push_back(std::move(edit));
    merging_ = true;
    if (done_.size() > most_edits) {
        if (!done_.front().catalog) {
            --document_edits_;
            if (saved_ >= 0) --saved_;
        }
        done_.erase(done_.begin());
    }
}

void History::move_back() {
    if (!done_.back().catalog) --document_edits_;
    undone_.push_back(std::move(done_.back()));
    done_.pop_back();
    merging_ = false;
}

void History::move_forward() {
    if (!undone_.back().catalog) ++document_edits_;
    done_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    merging_ = false;
}

void History::move_back(std::int64_t batch) {
    done_.back().catalog->again = batch;
    move_back();
}

void History::clear() {
    done_.clear();
    undone_.clear();
    document_edits_ = 0;
    saved_ = 0;
    merging_ = false;
}

}  // namespace embody::scene
