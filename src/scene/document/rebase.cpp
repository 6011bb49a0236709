// SPDX-License-Identifier: MIT
#include "scene/document/rebase.h"

#include <algorithm>
#include <map>

namespace embody::scene {

namespace {

using Kind = ChangedThing::Kind;

std::string in_words(std::string field) {
    std::replace(field.begin(), field.end(), '_', ' ');
    return field;
}

// Each attribute is a field of its own: one person sets the mass, another the friction.
using Attributes = std::map<std::string, attributes::AttributeValue>;
std::optional<std::string> merge_attributes(Attributes& present, const Attributes& from, const Attributes& to) {
    const auto value = [](const Attributes& all, const std::string& name) {
        const auto found = all.find(name);
        return found == all.end() ? std::nullopt : std::optional(found->second);
    };
    Attributes names = from;
    names.insert(to.begin(), to.end());
    for (const auto& [name, ignored] : names) {
        const auto before = value(from, name), after = value(to, name);
        if (before == after) continue;
        if (value(present, name) != before) return in_words(name);
        if (after)
            present.insert_or_assign(name, *after);
        else
            present.erase(name);
    }
    return std::nullopt;
}

// Gives the fields that differ between `from` and `to` their value of `to`; the name of the first one that is not as in
// `from`.
template <class Owner>
std::optional<std::string> merge_fields(Owner& present, const Owner& from, const Owner& to, bool same_geometry) {
    std::optional<std::string> conflict;
    for_each_field<Owner>([&](const auto& field) {
        using Member = typename std::remove_cvref_t<decltype(field)>::Member;
        const auto member = field.member;
        if (conflict || (same_geometry && std::is_same_v<Member, Geometry>)) return;
        if constexpr (std::remove_cvref_t<decltype(field)>::saved == Saved::never) {
            return;
        } else if constexpr (std::is_same_v<Member, Attributes>) {
            conflict = merge_attributes(present.*member, from.*member, to.*member);
        } else if constexpr (std::is_same_v<Member, physics::WorldSettings>) {
            conflict = merge_fields(present.*member, from.*member, to.*member, same_geometry);
        } else if (!are_same(from.*member, to.*member)) {
            if (are_same(present.*member, from.*member))
                present.*member = to.*member;
            else
                conflict = *field.name ? in_words(field.name) : "shape";
        }
    });
    return conflict;
}

// Rebases changes in a row: each sees the document as those before it leave it.
class Rebaser {
public:
    Rebaser(const Document& document, const DocumentIndex& lookup) : document_(document), lookup_(lookup) {}

    Rebased run(const std::vector<Change>& changes) {
        Rebased out;
        for (const Change& change : changes) {
            std::optional<std::string> why =
                std::visit([&](const auto& item) { return take(item, out.changes); }, change);
            if (!why) continue;
            out.changes.clear();
            out.conflict = Conflict{thing_of(change), std::move(*why)};
            return out;
        }
        return out;
    }

private:
    using Why = std::optional<std::string>;

    const Entity* find(EntityIndex index) const {
        const auto changed = entities_.find(index);
        if (changed == entities_.end()) return document_.find(index);
        return changed->second ? &*changed->second : nullptr;
    }
    bool has_joint(std::uint32_t index) const {
        const auto changed = joints_.find(index);
        return changed == joints_.end() ? document_.find_joint(index) != nullptr : changed->second;
    }

    Why take(const PoseChange& change, std::vector<Change>& out) {
        const Entity* present = find(change.index);
        if (!present) return "it was deleted since";
        if (present->pose != change.before) return "it was moved since";
        out.emplace_back(change);
        Entity moved = *present;
        moved.pose = change.after;
        entities_.insert_or_assign(change.index, std::move(moved));
        return {};
    }

    Why take(const EntityChange& change, std::vector<Change>& out) {
        if (!change.before) return come(change, out);
        const Entity* present = find(change.before->index);
        if (!present) return "it was deleted since";
        if (!change.after) return go(change, *present, out);
        Entity merged = *present;
        if (const Why field = merge_fields(merged, *change.before, *change.after, change.same_geometry))
            return "its " + *field + " was changed since";
        for (const Pin& pin : merged.pins)
            if (pin.to && !find(*pin.to)) return "what it was pinned to was deleted since";
        out.push_back(change.same_geometry ? Change(change_of(*present, merged)) : EntityChange{*present, merged});
        entities_.insert_or_assign(merged.index, std::move(merged));
        return {};
    }

    Why come(const EntityChange& change, std::vector<Change>& out) {
        if (find(change.after->index)) return "its place in the scene is taken";
        for (const Pin& pin : change.after->pins)
            if (pin.to && !find(*pin.to)) return "what it was pinned to was deleted since";
        out.emplace_back(change);
        entities_.insert_or_assign(change.after->index, *change.after);
        return {};
    }

    Why go(const EntityChange& change, const Entity& present, std::vector<Change>& out) {
        if (!are_same(present, *change.before)) return "it was changed since";
        const auto& joints = lookup_.holds.joints_of(present.index);
        if (std::any_of(joints.begin(), joints.end(), [this](std::uint32_t joint) { return has_joint(joint); }))
            return "a joint was put to it since";
        for (const EntityIndex other : lookup_.holds.pinned_to(present.index)) {
            const Entity* pinned = find(other);
            const auto holds_it = [&](const Pin& pin) { return pin.to == present.index; };
            if (pinned && std::any_of(pinned->pins.begin(), pinned->pins.end(), holds_it))
                return "something was pinned to it since";
        }
        out.emplace_back(change);
        entities_.insert_or_assign(present.index, std::nullopt);
        return {};
    }

    Why take(const JointChange& change, std::vector<Change>& out) {
        const std::uint32_t index = thing_of(change).number;
        const SceneJoint* present = has_joint(index) ? document_.find_joint(index) : nullptr;
        if (change.before && (!present || !are_same(*present, *change.before))) return "it was changed since";
        if (!change.before && has_joint(index)) return "its place in the scene is taken";
        if (change.after) {
            const auto& [entity_a, entity_b] = std::pair(change.after->entity_a, change.after->entity_b);
            if (!find(entity_b) || (entity_a && !find(*entity_a))) return "what it held was deleted since";
        }
        out.emplace_back(change);
        joints_.insert_or_assign(index, change.after.has_value());
        return {};
    }

    Why take(const ActionChange& change, std::vector<Change>& out) {
        const std::uint32_t id = thing_of(change).number;
        const auto present = std::find_if(document_.actions.begin(), document_.actions.end(),
                                          [id](const Action& action) { return action.id == id; });
        const bool is_there = present != document_.actions.end();
        if (change.before && (!is_there || !are_same(*present, *change.before))) return "it was changed since";
        if (!change.before && is_there) return "its place in the scene is taken";
        out.emplace_back(change);
        return {};
    }

    Why take(const HeadingChange& change, std::vector<Change>& out) {
        Heading merged = document_, before = *change.before;
        // Where a save has changed title or camera since, they stay.
        if (merged.title != before.title) before.title = change.after->title;
        if (!are_same(merged.camera, before.camera)) before.camera = change.after->camera;
        if (const Why field = merge_fields(merged, before, *change.after, false))
            return "its " + *field + " was changed since";
        out.emplace_back(HeadingChange{document_, merged});
        return {};
    }

    const Document& document_;
    const DocumentIndex& lookup_;
    std::map<EntityIndex, std::optional<Entity>> entities_;  ///< after the changes so far; empty: gone
    std::map<std::uint32_t, bool> joints_;                   ///< whether the joint is there after them
};

}  // namespace

Rebased rebased(const std::vector<Change>& changes, const Document& document, const DocumentIndex& lookup) {
    return Rebaser(document, lookup).run(changes);
}

}  // namespace embody::scene
