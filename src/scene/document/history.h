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

// Changes of a document in a form that can be done and undone: the states before and after of everything they change.

/// An entity comes (no `before`), goes (no `after`) or changes. An unchanged geometry is in neither state: a mesh of a
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

/// Record of an act on the catalogue's models in the audit of manual changes. Such changes are no part of the document.
struct CatalogStep {
    std::int64_t back = 0;   ///< the batch that undo reverts
    std::int64_t again = 0;  ///< after undo: the batch that redo reverts
};

/// One step of undo: changes of the document, or an act on the catalogue.
struct Edit {
    std::string label;            ///< for people: "Move chair"
    std::string merge;            ///< edits in a row with the same non-empty text become one step: a drag
    std::vector<Change> changes;  ///< in order
    EntityIndex next_before = 0, next_after = 0;  ///< the document's next_index
    std::optional<CatalogStep> catalog = {};      ///< such an edit has no changes
};

/// An edit of an entity's fields other than its geometry.
EntityChange change_of(const Entity& before, const Entity& after);

/// Applies the changes to the document, in order.
void apply_changes(Document& document, const std::vector<Change>& changes);
/// The changes that revert these, the last one first.
std::vector<Change> reversed(const std::vector<Change>& changes);
/// The change that reverts `change`.
Change reversed(const Change& change);

/// The edits that were done and those that were undone.
class History {
public:
    void add(Edit edit);
    /// The edit that undo would revert; null where there is none.
    [[nodiscard]] const Edit* undoable() const { return done_.empty() ? nullptr : &done_.back(); }
    [[nodiscard]] const Edit* redoable() const { return undone_.empty() ? nullptr : &undone_.back(); }
    /// Call after the edit was undone or redone.
    void move_back();
    void move_forward();
    void clear();

    /// Call after the edit, an act on the catalogue, was undone by this batch.
    void move_back(std::int64_t batch);
    /// Removes the edit that is next for undo, or redo, since it can't be carried out any more.
    void drop_undoable() { done_.pop_back(); }
    void drop_redoable() { undone_.pop_back(); }

    /// The document as it is now is on disk.
    void mark_saved() {
        saved_ = document_edits_;
        merging_ = false;
    }
    [[nodiscard]] bool is_saved() const { return saved_ == document_edits_; }
    /// No state of the document is on disk, whatever is undone.
    void mark_unsaved() { saved_ = -1; }

private:
    bool merge(Edit& edit);

    std::deque<Edit> done_, undone_;
    std::ptrdiff_t document_edits_ = 0;  ///< number of done edits of the document; acts on the catalogue are left out
    std::ptrdiff_t saved_ = 0;           ///< their number when it was saved; -1: never again
    bool merging_ = false;               ///< the last thing that happened was an edit
};

}  // namespace embody::scene
