// SPDX-License-Identifier: MIT
#include "physics/collision/broad_phase.h"

#include <algorithm>
#include <cmath>

#include "foundation/assert.h"
#include "physics/collision/bounds_tree.h"

namespace embody::physics {

namespace {

// A box wider than this would make every box above it useless; such bodies (planes) are kept in a list.
constexpr double widest_in_tree = 1e7;
// The enlargement: a tenth of the size, but no more than 5 cm, so that small things do not pair with far ones.
constexpr double most_margin = 0.05;

Bounds enlarged_for(const Bounds& bounds, Vec3 motion) {
    const Vec3 size = bounds.size();
    const double margin = std::min(most_margin, 0.1 * std::max(size.x, std::max(size.y, size.z)));
    Bounds fat = enlarged(bounds, margin);
    fat.lower += min(motion, {});
    fat.upper += max(motion, {});
    return fat;
}

bool is_wide(const Bounds& b) {
    const Vec3 s = b.size();
    return s.x > widest_in_tree || s.y > widest_in_tree || s.z > widest_in_tree;
}

// Whether the ray enters the box before `max_distance`.
bool ray_meets(const Bounds& box, Vec3 origin, Vec3 direction, double max_distance) {
    double enter = 0, leave = max_distance;
    for (int k = 0; k < 3; ++k) {
        if (std::fabs(direction[k]) < 1e-300) {
            if (origin[k] < box.lower[k] || origin[k] > box.upper[k]) return false;
            continue;
        }
        const double a = (box.lower[k] - origin[k]) / direction[k], b = (box.upper[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave;
}

}  // namespace

struct BroadPhase::State {
    struct Proxy {
        Bounds fat;
        std::uint32_t leaf = BoundsTree::none;  ///< none: kept in `wide`
        bool used = false, movable = false, changed = false;
    };
    BoundsTree tree;
    std::vector<Proxy> proxies;       ///< by body
    std::vector<std::uint32_t> wide;  ///< bodies without a leaf, ascending
    std::vector<std::uint32_t> changed;
    std::vector<Pair> pairs;
    std::vector<Pair> found;  ///< scratch of sort_pairs, as is the next
    std::vector<std::uint32_t> first_of_a;
    std::uint64_t version = 0;  ///< of pairs

    void place(std::uint32_t body, const Bounds& fat) {
        Proxy& proxy = proxies[body];
        proxy.fat = fat;
        if (is_wide(fat)) {
            wide.insert(std::lower_bound(wide.begin(), wide.end(), body), body);
        } else {
            proxy.leaf = tree.insert(fat, body);
        }
        if (!proxy.changed) changed.push_back(body);
        proxy.changed = true;
    }

    void unplace(std::uint32_t body) {
        Proxy& proxy = proxies[body];
        if (proxy.leaf == BoundsTree::none) {
            wide.erase(std::lower_bound(wide.begin(), wide.end(), body));
        } else {
            tree.remove(proxy.leaf);
        }
        proxy.leaf = BoundsTree::none;
    }

    // Visits the bodies whose enlarged bounds overlap the box, in no particular but always the same order.
    template <class Visit>
    void visit_overlapping(const Bounds& box, Visit&& visit) const {
        tree.query(box, visit);
        for (const std::uint32_t body : wide) {
            if (overlaps(proxies[body].fat, box)) visit(body);
        }
    }

    void sort_pairs_from(std::size_t first);

    void add_pairs_of(std::uint32_t body) {
        const Proxy& proxy = proxies[body];
        visit_overlapping(proxy.fat, [&](std::uint32_t other) {
            if (other == body || !(proxy.movable || proxies[other].movable)) return;
            // Of two that changed, the lower one adds the pair.
            if (proxies[other].changed && other < body) return;
            pairs.push_back({std::min(body, other), std::max(body, other)});
        });
    }
};

// Sorts the pairs from `first` on and merges them with the sorted ones before: by the first body by counting, then each
// body's few by the second.
void BroadPhase::State::sort_pairs_from(std::size_t first) {
    found.assign(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end());
    first_of_a.assign(proxies.size() + 1, 0);
    for (const Pair& pair : found) ++first_of_a[pair.a + 1];
    for (std::size_t a = 1; a < first_of_a.size(); ++a) first_of_a[a] += first_of_a[a - 1];
    for (const Pair& pair : found) pairs[first + first_of_a[pair.a]++] = pair;

    // After the distribution an entry tells where the next body's pairs begin.
    const auto at = [&](std::size_t i) { return pairs.begin() + static_cast<std::ptrdiff_t>(first + i); };
    std::uint32_t begin = 0;
    for (std::size_t a = 0; a + 1 < first_of_a.size(); ++a) {
        if (first_of_a[a] - begin > 1) std::sort(at(begin), at(first_of_a[a]));
        begin = first_of_a[a];
    }
    std::inplace_merge(pairs.begin(), at(0), pairs.end());
}

BroadPhase::BroadPhase() : state_(std::make_unique<State>()) {}
BroadPhase::~BroadPhase() = default;

void BroadPhase::insert(std::uint32_t body, const Bounds& bounds, bool movable) {
    State& s = *state_;
    if (body >= s.proxies.size()) s.proxies.resize(body + 1);
    EMBODY_ASSERT(!s.proxies[body].used);
    EMBODY_ASSERT(!bounds.is_empty());
    s.proxies[body].used = true;
    s.proxies[body].movable = movable;
    s.place(body, enlarged_for(bounds, {}));
}

void BroadPhase::remove(std::uint32_t body) {
    State& s = *state_;
    EMBODY_ASSERT(body < s.proxies.size() && s.proxies[body].used);
    s.unplace(body);
    s.proxies[body].used = false;
    // Its pairs go at once: a new body may take the index before the next update.
    std::erase_if(s.pairs, [body](const Pair& pair) { return pair.a == body || pair.b == body; });
    ++s.version;
}

void BroadPhase::move(std::uint32_t body, const Bounds& bounds, Vec3 expected_motion) {
    State& s = *state_;
    EMBODY_ASSERT(body < s.proxies.size() && s.proxies[body].used);
    const Bounds& fat = s.proxies[body].fat;
    const Bounds wanted = enlarged_for(bounds, expected_motion);
    // Kept while it still holds the body and has not become far too large (after a fast move came to rest).
    if (contains(fat, bounds) && contains(enlarged(wanted, 4 * most_margin), fat)) return;
    s.unplace(body);
    s.place(body, wanted);
}

std::uint64_t BroadPhase::pairs_version() const { return state_->version; }

const std::vector<BroadPhase::Pair>& BroadPhase::update_pairs() {
    State& s = *state_;
    if (s.changed.empty()) return s.pairs;
    ++s.version;
    // Changed bodies lose their pairs and look for them anew; the others keep theirs.
    std::sort(s.changed.begin(), s.changed.end());
    std::erase_if(s.pairs, [&s](const Pair& p) { return s.proxies[p.a].changed || s.proxies[p.b].changed; });
    const std::size_t kept = s.pairs.size();
    for (const std::uint32_t body : s.changed) {
        if (s.proxies[body].used) s.add_pairs_of(body);
    }
    for (const std::uint32_t body : s.changed) s.proxies[body].changed = false;
    s.changed.clear();
    s.sort_pairs_from(kept);
    return s.pairs;
}

void BroadPhase::query(const Bounds& box, const std::function<void(std::uint32_t)>& visit) const {
    std::vector<std::uint32_t> found;
    state_->visit_overlapping(box, [&found](std::uint32_t body) { found.push_back(body); });
    std::sort(found.begin(), found.end());
    for (const std::uint32_t body : found) visit(body);
}

void BroadPhase::query_ray(Vec3 origin, Vec3 direction, double max_distance,
                           const std::function<double(std::uint32_t, double)>& visit) const {
    const State& s = *state_;
    const auto meets = [&](const Bounds& b) { return ray_meets(b, origin, direction, max_distance); };
    const auto shorten = [&](std::uint32_t body) { max_distance = visit(body, max_distance); };
    for (const std::uint32_t body : s.wide) {
        if (meets(s.proxies[body].fat)) shorten(body);
    }
    s.tree.walk(meets, shorten);
}

}  // namespace embody::physics
