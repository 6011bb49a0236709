// SPDX-License-Identifier: MIT
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "foundation/heap_optional.h"
#include "scene/document/document.h"

namespace embody::scene {

// Changes of a document in a form that can be done and undone: the states before and after of everything they change.
// A history keeps thousands of them, most of which are moves: larger states lie outside the variant.

/// An entity comes (no `before`), goes (no `after`) or changes. An unchanged geometry is in neither state: a mesh of a
/// thousand triangles is not copied with each move of a slider.
struct EntityChange {
    HeapOptional<Entity> before, after;
    bool same_geometry = false;
};
struct PoseChange {
    EntityIndex index = 0;
    Transform before, after;
};
struct JointChange {
    HeapOptional<SceneJoint> before, after;
};
struct ActionChange {
    HeapOptional<Action> before, after;
};
struct HeadingChange {
    HeapOptional<Heading> before, after;  ///< always there
};
using Change = std::variant<EntityChange, PoseChange, JointChange, ActionChange, HeadingChange>;

/// Record of an act on the catalogue's models in the audit of manual changes. Such changes are no part of the document.
struct CatalogStep {
    std::int64_t back = 0;   ///< the batch that undo reverts
    std::int64_t again = 0;  ///< after undo: the batch that redo reverts
};

/// Number of a person who edits; 0: the program itself.
using PersonId = std::uint32_t;

/// One step of undo: changes of the document, or an act on the catalogue.
struct Edit {
    std::string label;            ///< for people: "Move chair"
    std::string merge;            ///< edits in a row with the same non-empty text become one step: a drag
    std::vector<Change> changes;  ///< in order
    EntityIndex next_before = 0, next_after = 0;  ///< the document's next_index
    std::optional<CatalogStep> catalog = {};      ///< such an edit has no changes
    PersonId person = 0;
    std::uint64_t mark = 0;  ///< given by the history: tells this state of the edit from all others
    std::uint64_t time = 0;  ///< given by the history: when it was done or undone
    /// When undo was refused, after the last act of somebody else; undo passes it until somebody acts again.
    std::uint64_t refused = 0;
    std::size_t bytes = 0;  ///< given by the history: what its changes take
};

/// The thing that a change is about: an entity, a joint, an action or the heading (number 0).
struct ChangedThing {
    enum class Kind : std::uint8_t { entity, joint, action, heading } kind = Kind::entity;
    std::uint32_t number = 0;
    friend auto operator<=>(const ChangedThing&, const ChangedThing&) = default;
};
ChangedThing thing_of(const Change& change);

/// An edit of an entity's fields other than its geometry.
EntityChange change_of(const Entity& before, const Entity& after);

/// Applies the changes to the document, in order.
void apply_changes(Document& document, const std::vector<Change>& changes);
/// The changes that revert these, the last one first.
std::vector<Change> reversed(const std::vector<Change>& changes);
/// The change that reverts `change`.
Change reversed(const Change& change);

/// About what a change takes in memory.
std::size_t bytes_of(const Change& change);

/// The edits that were done and those that were undone. Each person undoes and redoes their own. The oldest go where
/// there are too many of a person or of all, or where they take too much memory.
class History {
public:
    static constexpr std::size_t usual_bytes = 256ull << 20;

    explicit History(std::size_t max_bytes = usual_bytes) : max_bytes_(max_bytes) {}

    /// The edit itself always stays, however large.
    void add(Edit edit);
    /// What the changes of all edits take.
    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    /// The person's last edit that is not set aside, which undo would revert; null where there is none.
    [[nodiscard]] const Edit* undoable(PersonId person) const;
    [[nodiscard]] const Edit* redoable(PersonId person) const;
    /// Whether an edit of the document was done after this one of the lists, or somebody else has undone or redone
    /// one: then it must be rebased on the document as it is.
    [[nodiscard]] bool is_followed(const Edit& edit) const;
    /// Sets aside the person's edit that undo was refused: the next undo reverts the one before it.
    void set_aside(PersonId person);
    /// The last done edit of another person that changed the thing; null where there is none.
    [[nodiscard]] const Edit* last_of_others(PersonId person, ChangedThing thing) const;
    /// Call after the person's edit was undone or redone, with the edit's changes as they are now: those that undo
    /// reverted, or those that redo made.
    void move_back(PersonId person, std::vector<Change> changes);
    void move_forward(PersonId person, std::vector<Change> changes);
    void clear();
    /// The person will not come back: what could be redone is dropped.
    void forget(PersonId person);

    /// Call after the person's edit, an act on the catalogue, was undone by this batch.
    void move_back(PersonId person, std::int64_t batch);
    /// Removes the edit that is next for undo, or redo, since it can't be carried out any more.
    void drop_undoable(PersonId person);
    void drop_redoable(PersonId person);

    /// The document as it is now is on disk.
    void mark_saved();
    [[nodiscard]] bool is_saved() const { return saved_ == applied_; }
    /// No state of the document is on disk, whatever is undone.
    void mark_unsaved() { saved_.reset(); }

private:
    bool merge(Edit& edit);
    [[nodiscard]] bool others_changed(PersonId person, const std::set<ChangedThing>& things, std::uint64_t since) const;
    [[nodiscard]] bool is_set_aside(const Edit& edit) const;
    [[nodiscard]] std::uint64_t last_act_of_others(PersonId person) const;
    [[nodiscard]] std::uint64_t next_mark();
    void note(const Edit& edit, bool is_applied);
    void put_changes(Edit& edit, std::vector<Change> changes);
    void measure(Edit& edit);
    void drop(std::deque<Edit>::iterator edit);
    void drop_undone(PersonId person);
    [[nodiscard]] std::deque<Edit>::iterator last_of(PersonId person);
    /// undoable(), as a place in the list.
    [[nodiscard]] std::deque<Edit>::iterator next_of(PersonId person);

    std::size_t max_bytes_;
    std::size_t bytes_ = 0;  ///< of the edits in both lists
    std::deque<Edit> done_;
    std::map<PersonId, std::vector<Edit>> undone_;
    std::uint64_t marks_ = 0;                    ///< number given so far
    std::uint64_t applied_ = 0;                  ///< sum of the marks of all edits that the document has in it
    std::optional<std::uint64_t> saved_ = 0;     ///< the sum when it was saved; empty: never again
    std::uint64_t clock_ = 0;                    ///< counts edits, undos and redos
    std::map<PersonId, std::uint64_t> acted_;    ///< when each person last changed the document
    std::map<PersonId, std::uint64_t> merging_;  ///< mark of each person's edit that the next one may become a part of
};

}  // namespace embody::scene
