// SPDX-License-Identifier: MIT
#include "scene/document/history.h"

#include <algorithm>
#include <map>
#include <span>
#include <type_traits>

namespace embody::scene {

namespace {

/// Edits that each person can undo, and all together.
constexpr std::size_t max_edits = 1000;
constexpr std::size_t max_edits_of_all = 10 * max_edits;
/// Up to this many entities that come or go in a row are inserted or erased one by one.
constexpr std::size_t few_entities = 4;

// Inserts, replaces or erases an item in a list that is ascending by its number.
template <class Item, class Number>
void put_item(std::vector<Item>& items, Number Item::*number, const HeapOptional<Item>& before,
              const HeapOptional<Item>& after) {
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
    void operator()(const HeadingChange& change) const { static_cast<Heading&>(document) = *change.after; }
};

// Whether two changes of one thing can be one: both move it, or both change its fields.
bool can_merge(const Change& first, const Change& second) {
    if (first.index() != second.index()) return false;
    if (std::holds_alternative<PoseChange>(first)) return true;
    const auto* one = std::get_if<EntityChange>(&first);
    if (!one) return false;
    const auto& other = std::get<EntityChange>(second);
    if (one->same_geometry != other.same_geometry) return false;
    return one->same_geometry || (one->before && one->after && other.before && other.after);
}

bool comes_or_goes(const Change& change) {
    const auto* entity = std::get_if<EntityChange>(&change);
    return entity && !(entity->before && entity->after);
}

// Inserts and erases entities that come and go in a row, in one pass over the list: one by one, each would move all
// entities behind it.
void put_entities(std::vector<Entity>& entities, std::span<const Change> changes) {
    std::map<EntityIndex, HeapOptional<Entity>> wanted;
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

// What lies outside the objects themselves. Nodes and blocks of the heap are taken as a few pointers each.
constexpr std::size_t block_bytes = 4 * sizeof(void*);

template <class Item>
std::size_t outside(const std::vector<Item>& items) {
    return items.capacity() * sizeof(Item);
}

struct ShapeBytes {
    std::size_t operator()(const physics::HullShape& hull) const { return outside(hull.points); }
    std::size_t operator()(const physics::HeightfieldShape& field) const { return outside(field.heights); }
    std::size_t operator()(const physics::MeshShape& mesh) const {
        return outside(mesh.positions) + outside(mesh.triangles);
    }
    std::size_t operator()(const physics::CompoundShape& compound) const {
        std::size_t bytes = outside(compound.children);
        for (const physics::CompoundChild& child : compound.children) bytes += std::visit(*this, child.shape);
        return bytes;
    }
    std::size_t operator()(const physics::WallShape& wall) const { return outside(wall.openings); }
    std::size_t operator()(const auto& /*lengths*/) const { return 0; }
};

std::size_t outside(const Entity& entity) {
    std::size_t bytes = entity.name.capacity() + entity.category.capacity() + entity.group.capacity();
    for (const auto& item : entity.attributes) bytes += sizeof(item) + item.first.capacity() + block_bytes;
    bytes += outside(entity.pins);
    if (const auto* shape = std::get_if<physics::ShapeDefinition>(&entity.geometry))
        bytes += std::visit(ShapeBytes{}, *shape);
    return bytes;
}
std::size_t outside(const auto& /*joint, action or heading: little*/) { return 0; }

std::size_t outside(const KeptForm& form) {
    return outside(form.places.values) + outside(form.plastic_strain.values) + outside(form.broken) +
           outside(form.bend.values);
}

// A kept form is one in memory for all states that have it: it counts where it comes or goes.
std::size_t kept_bytes(const EntityChange& change) {
    const SharedOptional<KeptForm> before = change.before ? change.before->kept : SharedOptional<KeptForm>();
    const SharedOptional<KeptForm> after = change.after ? change.after->kept : SharedOptional<KeptForm>();
    if (before.is_copy_of(after)) return 0;
    return (before ? outside(*before) : 0) + (after ? outside(*after) : 0);
}

}  // namespace

std::size_t bytes_of(const Change& change) {
    const auto of_state = [](const auto& state) {
        return state ? sizeof(*state) + block_bytes + outside(*state) : std::size_t{0};
    };
    return std::visit(
        [&](const auto& item) {
            using Item = std::remove_cvref_t<decltype(item)>;
            if constexpr (std::is_same_v<Item, PoseChange>)
                return sizeof(Change);
            else if constexpr (std::is_same_v<Item, EntityChange>)
                return sizeof(Change) + of_state(item.before) + of_state(item.after) + kept_bytes(item);
            else
                return sizeof(Change) + of_state(item.before) + of_state(item.after);
        },
        change);
}

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

ChangedThing thing_of(const Change& change) {
    using Kind = ChangedThing::Kind;
    if (const auto* entity = std::get_if<EntityChange>(&change))
        return {Kind::entity, entity->after ? entity->after->index : entity->before->index};
    if (const auto* pose = std::get_if<PoseChange>(&change)) return {Kind::entity, pose->index};
    if (const auto* joint = std::get_if<JointChange>(&change))
        return {Kind::joint, joint->after ? joint->after->index : joint->before->index};
    if (const auto* action = std::get_if<ActionChange>(&change))
        return {Kind::action, action->after ? action->after->id : action->before->id};
    return {Kind::heading, 0};
}

// Edits of the document
// ---------------------------------------------------------------------------------------------------------

// Numbers that look random, so that no two sets of edits have the same sum (Steele et al. 2014, "Fast splittable
// pseudorandom number generators", the output function of SplitMix64).
std::uint64_t History::next_mark() {
    std::uint64_t z = ++marks_ * 0x9E3779B97F4A7C15U;
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
    return z ^ (z >> 31U);
}

// Acts on the catalogue are no part of the document: they neither make it unsaved nor stand in another edit's way.
void History::note(const Edit& edit, bool is_applied) {
    ++clock_;
    if (edit.catalog) return;
    applied_ = is_applied ? applied_ + edit.mark : applied_ - edit.mark;
    acted_[edit.person] = clock_;
}

std::deque<Edit>::iterator History::last_of(PersonId person) {
    const auto found =
        std::find_if(done_.rbegin(), done_.rend(), [person](const Edit& edit) { return edit.person == person; });
    return found == done_.rend() ? done_.end() : std::prev(found.base());
}

const Edit* History::undoable(PersonId person) const {
    const auto found = std::find_if(done_.rbegin(), done_.rend(),
                                    [&](const Edit& edit) { return edit.person == person && !is_set_aside(edit); });
    return found == done_.rend() ? nullptr : &*found;
}

bool History::is_set_aside(const Edit& edit) const {
    return edit.refused > 0 && edit.refused > last_act_of_others(edit.person);
}

std::uint64_t History::last_act_of_others(PersonId person) const {
    std::uint64_t last = 0;
    for (const auto& [other, time] : acted_)
        if (other != person) last = std::max(last, time);
    return last;
}

void History::set_aside(PersonId person) {
    const auto edit = next_of(person);
    if (edit != done_.end()) edit->refused = last_act_of_others(person) + 1;
}

std::deque<Edit>::iterator History::next_of(PersonId person) {
    const Edit* next = undoable(person);
    return std::find_if(done_.begin(), done_.end(), [next](const Edit& edit) { return &edit == next; });
}

const Edit* History::redoable(PersonId person) const {
    const auto found = undone_.find(person);
    return found == undone_.end() || found->second.empty() ? nullptr : &found->second.back();
}

bool History::is_followed(const Edit& edit) const {
    return last_act_of_others(edit.person) > edit.time ||
           std::any_of(done_.begin(), done_.end(),
                       [&edit](const Edit& other) { return !other.catalog && other.time > edit.time; });
}

const Edit* History::last_of_others(PersonId person, ChangedThing thing) const {
    const auto changes_it = [&](const Edit& edit) {
        return edit.person != person && std::any_of(edit.changes.begin(), edit.changes.end(),
                                                    [&](const Change& change) { return thing_of(change) == thing; });
    };
    const auto found = std::find_if(done_.rbegin(), done_.rend(), changes_it);
    return found == done_.rend() ? nullptr : &*found;
}

// Whether another person has done or undone an edit of one of the things since then.
bool History::others_changed(PersonId person, const std::set<ChangedThing>& things, std::uint64_t since) const {
    const auto meets = [&](const Edit& other) {
        return other.person != person && other.time > since &&
               std::any_of(other.changes.begin(), other.changes.end(),
                           [&](const Change& change) { return things.contains(thing_of(change)); });
    };
    return std::any_of(done_.begin(), done_.end(), meets) ||
           std::any_of(undone_.begin(), undone_.end(), [&](const auto& undone) {
               return std::any_of(undone.second.begin(), undone.second.end(), meets);
           });
}

// A drag is many small edits of the same poses, or of the same entity: the first state before and the last state after
// are kept. Edits of other people in between do not end it, unless they are of the same things: those would be undone
// with the step.
bool History::merge(Edit& edit) {
    const auto open = merging_.find(edit.person);
    if (edit.merge.empty() || open == merging_.end() || is_saved()) return false;
    const auto last = last_of(edit.person);
    if (last == done_.end() || last->mark != open->second || last->merge != edit.merge) return false;
    if (is_followed(*last)) {
        std::set<ChangedThing> things;
        for (const Change& change : last->changes) things.insert(thing_of(change));
        for (const Change& change : edit.changes) things.insert(thing_of(change));
        if (others_changed(edit.person, things, last->time)) return false;
    }

    // A change becomes a part of the last one of its thing, if that is of the same kind.
    std::vector<Change>& done = last->changes;
    std::map<ChangedThing, std::size_t> last_of_thing;
    for (std::size_t i = 0; i < done.size(); ++i) last_of_thing[thing_of(done[i])] = i;
    for (Change& change : edit.changes) {
        const auto [found, is_new] = last_of_thing.try_emplace(thing_of(change), done.size());
        if (is_new || !can_merge(done[found->second], change)) {
            found->second = done.size();
            done.push_back(std::move(change));
        } else if (auto* moved = std::get_if<PoseChange>(&done[found->second])) {
            moved->after = std::get<PoseChange>(change).after;
        } else {
            std::get<EntityChange>(done[found->second]).after = std::get<EntityChange>(change).after;
        }
    }
    last->next_after = edit.next_after;
    measure(*last);
    note(*last, false);
    last->mark = open->second = next_mark();
    note(*last, true);
    last->time = clock_;
    return true;
}

void History::add(Edit edit) {
    drop_undone(edit.person);
    if (merge(edit)) return;
    edit.bytes = 0;
    measure(edit);
    edit.mark = next_mark();
    note(edit, true);
    edit.time = clock_;
    merging_[edit.person] = edit.mark;
    const PersonId person = edit.person;
    done_.push_back(std::move(edit));
    const auto is_own = [person](const Edit& one) { return one.person == person; };
    if (std::count_if(done_.begin(), done_.end(), is_own) > static_cast<std::ptrdiff_t>(max_edits))
        drop(std::find_if(done_.begin(), done_.end(), is_own));
    while (done_.size() > 1 && (done_.size() > max_edits_of_all || bytes_ > max_bytes_)) drop(done_.begin());
}

void History::measure(Edit& edit) {
    bytes_ -= edit.bytes;
    edit.bytes = 0;
    for (const Change& change : edit.changes) edit.bytes += bytes_of(change);
    bytes_ += edit.bytes;
}

void History::put_changes(Edit& edit, std::vector<Change> changes) {
    edit.changes = std::move(changes);
    measure(edit);
}

void History::drop(std::deque<Edit>::iterator edit) {
    bytes_ -= edit->bytes;
    done_.erase(edit);
}

void History::drop_undone(PersonId person) {
    const auto undone = undone_.find(person);
    if (undone == undone_.end()) return;
    for (const Edit& edit : undone->second) bytes_ -= edit.bytes;
    undone_.erase(undone);
}

void History::forget(PersonId person) {
    drop_undone(person);
    merging_.erase(person);
}

void History::move_back(PersonId person, std::vector<Change> changes) {
    const auto edit = next_of(person);
    note(*edit, false);
    edit->time = clock_;
    put_changes(*edit, std::move(changes));
    undone_[person].push_back(std::move(*edit));
    done_.erase(edit);
    merging_.erase(person);
}

void History::move_forward(PersonId person, std::vector<Change> changes) {
    std::vector<Edit>& undone = undone_[person];
    note(undone.back(), true);
    undone.back().time = clock_;
    put_changes(undone.back(), std::move(changes));
    done_.push_back(std::move(undone.back()));
    undone.pop_back();
    merging_.erase(person);
}

void History::move_back(PersonId person, std::int64_t batch) {
    next_of(person)->catalog->again = batch;
    move_back(person, std::vector<Change>());
}

void History::drop_undoable(PersonId person) { drop(next_of(person)); }
void History::drop_redoable(PersonId person) {
    bytes_ -= undone_[person].back().bytes;
    undone_[person].pop_back();
}

void History::mark_saved() {
    saved_ = applied_;
    merging_.clear();
}

void History::clear() { *this = History(max_bytes_); }

}  // namespace embody::scene
