// SPDX-License-Identifier: MIT
#include "physics/collision/contact_cache.h"

#include <algorithm>

namespace embody::physics {

const CachedPoint* ContactCache::find(Key key, const CachedPoint& wanted, double tolerance) {
    const auto by_key = [](const Entry& entry, const Key& k) { return entry.key < k; };
    const auto first = std::lower_bound(last_.begin(), last_.end(), key, by_key);

    // The same features met: the same point, however far it moved.
    Entry* nearest = nullptr;
    double nearest_squared = tolerance * tolerance;
    for (auto entry = first; entry != last_.end() && entry->key == key; ++entry) {
        if (entry->taken) continue;
        const CachedPoint& point = entry->point;
        if (point.piece_a == wanted.piece_a && point.piece_b == wanted.piece_b && point.feature == wanted.feature) {
            entry->taken = true;
            return &point;
        }
        const double squared = length_squared(point.position - wanted.position);
        if (squared <= nearest_squared && (nearest == nullptr || squared < nearest_squared)) {
            nearest = &*entry;
            nearest_squared = squared;
        }
    }
    // Else the nearest, e.g. where a corner slid from one triangle to the next.
    if (nearest == nullptr) return nullptr;
    nearest->taken = true;
    return &nearest->point;
}

void ContactCache::put(Key key, const CachedPoint& point) { next_.push_back({key, point}); }

void ContactCache::turn_over() {
    std::swap(last_, next_);
    next_.clear();
    // Points usually come pair by pair in order already; the sort is stable, so equal input gives equal order.
    const auto by_key = [](const Entry& a, const Entry& b) { return a.key < b.key; };
    if (!std::is_sorted(last_.begin(), last_.end(), by_key)) std::stable_sort(last_.begin(), last_.end(), by_key);
}

void ContactCache::forget(std::uint32_t body) {
    const auto concerns = [body](const Entry& e) { return e.key.body_a == body || e.key.body_b == body; };
    std::erase_if(last_, concerns);
    std::erase_if(next_, concerns);
}

void ContactCache::clear() {
    last_.clear();
    next_.clear();
}

}  // namespace embody::physics
