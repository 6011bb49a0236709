// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scene/document/document.h"

namespace embody::scene {

// What an edit does to a document, told so that it can be done and undone: both states of what it touches.

/// An entity comes (no `before`), goes (no `after`) or changes. Where the geometry stays it is in neither: a mesh of a
/// thousand triangles is not copied with each move of a slider.
struct EntityChange {
    std::optional<Entity> before, after;
    bool same_geometry = false;
};
struct PoseChange {
    EntityIndex index = 0;
    Transform before, after;
};
struct JointChange {
    std::optional<SceneJoint> before, after;
};
struct ActionChange {
    std::optional<Action> before, after;
};
struct HeadingChange {
    Heading before, after;
};
using Change = std::variant<EntityChange, PoseChange, JointChange, ActionChange, HeadingChange>;

/// What an act on the catalogue's models left in the audit of manual changes. They are no part of the document.
struct CatalogStep {
    std::int64_t back = 0;   ///< the batch that undo takes back
    std::int64_t again = 0;  ///< once undone: the batch that redo takes back
};

/// One step of undo: changes of the document, or an act on the catalogue.
struct Edit {
    std::string label;                            ///< for people: "Move chair"
    std::string merge;                            ///< edits in a row with the same one, not empty, are one step: a drag
    std::vector<Change> changes;                  ///< in order
    EntityIndex next_before = 0, next_after = 0;  ///< the document's next_index
    std::optional<CatalogStep> catalog = {};      ///< then there are no changes
};

/// An edit that changes an entity's other fields but not its geometry.
EntityChange change_of(const Entity& before, const Entity& after);

/// Does the changes to the document, in order.
void apply_changes(Document& document, const std::vector<Change>& changes);
/// The changes that take these back, the last one first.
std::vector<Change> reversed(const std::vector<Change>& changes);
/// The change that takes `change` back.
Change reversed(const Change& change);

/// The edits that were done and those that were undone.
class History {
public:
    void add(Edit edit);
    /// What undo would take back; null where there is nothing.
    [[nodiscard]] const Edit* undoable() const { return done_.empty() ? nullptr : &done_.back(); }
    [[nodiscard]] const Edit* redoable() const { return undone_.empty() ? nullptr : &undone_.back(); }
    /// The edit has been undone or redone.
    void move_back();
    void move_forward();
    void clear();

    /// The edit was an act on the catalogue and has been undone by this batch.
    void move_back(std::int64_t batch);
    /// The edit that undo, or redo, would take next can't be carried out any more.
    void drop_undoable() { done_.pop_back(); }
    void drop_redoable() { undone_.pop_back(); }

    /// The document is on disk as it is now.
    void mark_saved() {
        saved_ = document_edits_;
        merging_ = false;
    }
    [[nodiscard]] bool is_saved() const { return saved_ == document_edits_; }
    /// The document is on no disk, whatever is undone.
    void mark_unsaved() { saved_ = -1; }

private:
    bool merge(Edit& edit);

    std::deque<Edit> done_, undone_;
    std::ptrdiff_t document_edits_ = 0;  ///< of those done: acts on the catalogue leave the document as it is
    std::ptrdiff_t saved_ = 0;           ///< their number when it was saved; -1: never again
    bool merging_ = false;               ///< the last thing that happened was an edit
};

}  // namespace embody::scene
