// SPDX-License-Identifier: MIT
#include "scene/document/history.h"

#include <algorithm>
#include <map>
#include <span>
#include <type_traits>

namespace embody::scene {

namespace {

constexpr std::size_t max_edits = 1000;
/// Up to this many entities that come or go in a row are inserted or erased one by one.
constexpr std::size_t few_entities = 4;

// Inserts, replaces or erases an item in a list that is ascending by its number.
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
    void operator()(const HeadingChange& change) const { static_cast<Heading&>(document) = change.after; }
};

// Key of changes that can be merged: the kind of change and the entity; empty for other changes.
std::optional<std::pair<std::size_t, EntityIndex>> merge_key(const Change& change) {
    if (const auto* moved = std::get_if<PoseChange>(&change)) return std::pair{change.index(), moved->index};
    const auto* changed = std::get_if<EntityChange>(&change);
    if (changed && changed->same_geometry) return std::pair{change.index(), changed->after->index};
    return std::nullopt;
}

bool comes_or_goes(const Change& change) {
    const auto* entity = std::get_if<EntityChange>(&change);
    return entity && !(entity->before && entity->after);
}

// Inserts and erases entities that come and go in a row, in one pass over the list: one by one, each would move all
// entities behind it.
void put_entities(std::vector<Entity>& entities, std::span<const Change> changes) {
    std::map<EntityIndex, std::optional<Entity>> wanted;
    for (const Change& item : changes) {
        const auto& change = std::get<EntityChange>(item);
        wanted[change.after ? change.after->index : change.before->index] = change.after;
    }
    std::vector<Entity> merged;
    merged.reserve(entities.size() + wanted.size());
    // From here on nothing can fail.
    auto next = wanted.begin();
    const auto take_wanted = [&] {
        if (next->second) merged.push_back(std::move(*next->second));
        ++next;
    };
    for (Entity& entity : entities) {
        while (next != wanted.end() && next->first < entity.index) take_wanted();
        if (next != wanted.end() && next->first == entity.index)
            take_wanted();
        else
            merged.push_back(std::move(entity));
    }
    while (next != wanted.end()) take_wanted();
    entities = std::move(merged);
}

Entity without_geometry(const Entity& entity) {
    Entity out;
    for_each_field<Entity>([&](const auto& field) {
        if constexpr (!std::is_same_v<typename std::remove_cvref_t<decltype(field)>::Member, Geometry>)
            out.*field.member = entity.*field.member;
    });
    return out;
}

}  // namespace

EntityChange change_of(const Entity& before, const Entity& after) {
    return {without_geometry(before), without_geometry(after), true};
}

void apply_changes(Document& document, const std::vector<Change>& changes) {
    for (std::size_t i = 0; i < changes.size();) {
        std::size_t end = i;
        while (end < changes.size() && comes_or_goes(changes[end])) ++end;
        if (end - i > few_entities) {
            put_entities(document.entities, std::span(changes).subspan(i, end - i));
            i = end;
        } else {
            std::visit(Applier{document}, changes[i++]);
        }
    }
}

Change reversed(const Change& change) {
    Change back = change;
    std::visit([](auto& item) { std::swap(item.before, item.after); }, back);
    return back;
}

std::vector<Change> reversed(const std::vector<Change>& changes) {
    std::vector<Change> back;
    back.reserve(changes.size());
    for (auto change = changes.rbegin(); change != changes.rend(); ++change) back.push_back(reversed(*change));
    return back;
}

// A drag is many small edits of the same poses, or of the same entity: the first state before and the last state after
// are kept.
bool History::merge(Edit& edit) {
    if (!merging_ || done_.empty() || edit.merge.empty() || done_.back().merge != edit.merge || is_saved())
        return false;
    std::vector<Change>& done = done_.back().changes;
    std::map<std::pair<std::size_t, EntityIndex>, std::size_t> places;
    for (std::size_t i = 0; i < done.size(); ++i)
        if (const auto key = merge_key(done[i])) places.emplace(*key, i);
    for (Change& change : edit.changes) {
        const auto key = merge_key(change);
        const auto same = key ? places.find(*key) : places.end();
        if (same == places.end()) {
            if (key) places.emplace(*key, done.size());
            done.push_back(std::move(change));
        } else if (auto* moved = std::get_if<PoseChange>(&done[same->second])) {
            moved->after = std::get<PoseChange>(change).after;
        } else {
            std::get<EntityChange>(done[same->second]).after = std::get<EntityChange>(change).after;
        }
    }
    done_.back().next_after = edit.next_after;
    return true;
}

void History::add(Edit edit) {
    // An undone edit can't be redone on another document; if the document on disk contained it, no state in the history
    // is on disk any more.
    if (saved_ > document_edits_) saved_ = -1;
    undone_.clear();
    if (merge(edit)) return;
    if (!edit.catalog) ++document_edits_;
    done_.push_back(std::move(edit));
    merging_ = true;
    if (done_.size() > max_edits) {
        if (!done_.front().catalog) {
            --document_edits_;
            if (saved_ >= 0) --saved_;
        }
        done_.pop_front();
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
