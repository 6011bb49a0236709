// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "foundation/assert.h"
#include "foundation/handle.h"

namespace embody {

/// Elements addressed by handles: stable indices, slots reused with a new generation, iteration by index
/// (always in the same order, which determinism needs).
template <class Tag, class T>
class HandleTable {
public:
    using HandleType = Handle<Tag>;

    /// Puts `element` in the lowest-numbered recently freed slot, or a new one.
    HandleType insert(T element) {
        std::uint32_t index = 0;
        if (free_.empty()) {
            index = static_cast<std::uint32_t>(slots_.size());
            slots_.push_back({});
        } else {
            index = free_.back();
            free_.pop_back();
        }
        Slot& slot = slots_[index];
        slot.element = std::move(element);
        slot.used = true;
        ++count_;
        return {index, slot.generation};
    }

    /// Removes the element; false for a null or stale handle.
    bool remove(HandleType handle) {
        if (!contains(handle)) return false;
        Slot& slot = slots_[handle.index];
        slot.element = T{};
        slot.used = false;
        ++slot.generation;
        if (slot.generation == 0) slot.generation = 1;
        free_.push_back(handle.index);
        --count_;
        return true;
    }

    [[nodiscard]] bool contains(HandleType handle) const {
        return handle.index < slots_.size() && slots_[handle.index].used &&
               slots_[handle.index].generation == handle.generation;
    }

    /// The element, or nullptr for a null or stale handle.
    [[nodiscard]] T* find(HandleType handle) { return contains(handle) ? &slots_[handle.index].element : nullptr; }
    [[nodiscard]] const T* find(HandleType handle) const {
        return contains(handle) ? &slots_[handle.index].element : nullptr;
    }

    [[nodiscard]] std::uint32_t count() const { return count_; }
    /// One past the highest slot in use now or before; iterate 0 … slot_count() with used() and at().
    [[nodiscard]] std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
    [[nodiscard]] bool used(std::uint32_t index) const { return index < slots_.size() && slots_[index].used; }
    [[nodiscard]] T& at(std::uint32_t index) {
        EMBODY_ASSERT(used(index));
        return slots_[index].element;
    }
    [[nodiscard]] const T& at(std::uint32_t index) const {
        EMBODY_ASSERT(used(index));
        return slots_[index].element;
    }
    [[nodiscard]] HandleType handle_at(std::uint32_t index) const { return {index, slots_[index].generation}; }

private:
    struct Slot {
        T element{};
        std::uint32_t generation = 1;
        bool used = false;
    };
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> free_;
    std::uint32_t count_ = 0;
};

}  // namespace embody
