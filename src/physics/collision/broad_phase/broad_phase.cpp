// SPDX-License-Identifier: MIT
#include "physics/collision/broad_phase/broad_phase.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "foundation/assert.h"
#include "foundation/zone.h"
#include "physics/collision/broad_phase/box_tree.h"
#include "physics/collision/broad_phase/moving_box.h"

namespace embody::physics::collision {

namespace {

// A box wider than this would make every box above it useless; such bodies (planes) are kept in a list.
constexpr double widest_in_tree = 1e7;  // m
// The enlargement: a tenth of the size, but no more than 5 cm, so that small things do not pair with far ones.
constexpr double max_margin = 0.05;  // m
// Worlds with fewer changed bodies look for pairs on one thread.
constexpr std::uint32_t min_parallel_count = 500;
// Room for this many pairs is always kept; beyond, for as many as a body may have partners.
constexpr std::size_t always_kept_pairs = 100000;

double margin_of(const Bounds& bounds) {
    const Vec3 size = bounds.size();
    return std::min(max_margin, 0.1 * std::max(size.x, std::max(size.y, size.z)));
}

// Motion in a step, over the margin, below which a body's bounds stay where they are: they hold it for some steps, and
// while all bodies are slow boxes at rest are compared. Faster bodies' bounds travel with them, so that what flies side
// by side is as far apart as at rest (BroadPhase.pairs_do_not_depend_on_a_common_speed).
constexpr double max_resting_motion = 0.25;  // of the margin

// The enlarged bounds of a body that travels by `motion` from `bounds` on.
MovingBox enlarged_for(const Bounds& bounds, Vec3 motion) {
    const double margin = margin_of(bounds);
    const FloatBox fat(enlarged(bounds, margin));
    const Vec3 m = abs(motion);
    const bool stays = std::max(m.x, std::max(m.y, m.z)) <= max_resting_motion * margin;
    return stays ? MovingBox(fat) : MovingBox(fat, motion);
}

// Whether the enlarged bounds hold the body on all of its path.
bool holds_path(const MovingBox& fat, const Bounds& bounds, Vec3 motion) {
    const Vec3 lag = motion - fat.displacement();
    return fat.box.contains(bounds) && fat.box.contains({bounds.lower + lag, bounds.upper + lag});
}

bool is_wide(const Bounds& b) {
    const Vec3 s = b.size();
    return s.x > widest_in_tree || s.y > widest_in_tree || s.z > widest_in_tree;
}

std::uint32_t lowest_lane(std::uint32_t mask) { return static_cast<std::uint32_t>(std::countr_zero(mask)); }

// The distance along the ray at which it enters the box, `never` if not before `max_distance`; m along the direction.
constexpr double never = 1e300;
double entry_of(const Bounds& box, Vec3 origin, Vec3 direction, double max_distance) {
    double enter = 0, leave = max_distance;
    for (int k = 0; k < 3; ++k) {
        if (std::fabs(direction[k]) < 1e-300) {
            if (origin[k] < box.lower[k] || origin[k] > box.upper[k]) return never;
            continue;
        }
        const double a = (box.lower[k] - origin[k]) / direction[k], b = (box.upper[k] - origin[k]) / direction[k];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : never;
}

}  // namespace

struct BroadPhase::State {
    struct Proxy {
        MovingBox fat;
        bool used = false, movable = false, wide = false;
    };
    /// The new pairs that one worker finds.
    struct Finder {
        std::vector<Pair> pairs;
        std::vector<std::uint32_t> partners, movable_leaves, immovable_leaves;  ///< scratch
    };
    BoxTree movable, immovable;
    std::vector<Proxy> proxies;             ///< by body
    std::vector<std::uint32_t> wide;        ///< bodies in neither tree, ascending
    std::vector<std::uint8_t> has_changed;  ///< by body: placed or removed since the last update
    std::vector<std::uint32_t> changed;     ///< those bodies
    std::vector<Pair> pairs;
    std::uint64_t version = 0;  ///< of pairs
    bool too_many = false;
    bool all_changed = false;  ///< whether all movable ones changed, in this update
    std::vector<Finder> finders;
    std::vector<Pair> kept, found, sorted;  ///< scratch of update, as is the next
    std::vector<std::uint32_t> first_of_a;

    BoxTree& tree_of(const Proxy& proxy) { return proxy.movable ? movable : immovable; }

    void mark_changed(std::uint32_t body) {
        if (!has_changed[body]) changed.push_back(body);
        has_changed[body] = 1;
    }

    void place(std::uint32_t body, const MovingBox& fat) {
        Proxy& proxy = proxies[body];
        proxy.fat = fat;
        proxy.wide = is_wide(fat.box.bounds());
        if (proxy.wide) {
            wide.insert(std::lower_bound(wide.begin(), wide.end(), body), body);
        } else {
            tree_of(proxy).insert(body, proxy.fat);
        }
        mark_changed(body);
    }

    void unplace(std::uint32_t body) {
        Proxy& proxy = proxies[body];
        if (proxy.wide) {
            wide.erase(std::lower_bound(wide.begin(), wide.end(), body));
        } else {
            tree_of(proxy).remove(body);
        }
        mark_changed(body);
    }

    void refresh() {
        movable.refresh();
        immovable.refresh();
    }

    // Visits the bodies whose enlarged bounds the box meets.
    template <class Visit>
    void visit_met(const MovingBox& box, Visit&& visit) const {
        for (const BoxTree* tree : {&movable, &immovable}) {
            tree->query(box, [&](std::uint32_t node, std::uint32_t mask) {
                for (; mask != 0; mask &= mask - 1) visit(tree->value(node, lowest_lane(mask)));
            });
        }
        for (const std::uint32_t body : wide) {
            if (proxies[body].fat.meets(box)) visit(body);
        }
    }

    void change_all();
    void find_new_pairs(TaskPool& workers);
    void find_pairs_of_leaf(std::uint32_t leaf, Finder& finder) const;
    void find_pairs_of_immovable_leaf(std::uint32_t leaf, Finder& finder) const;
    void find_pairs_of_wide(std::uint32_t body, Finder& finder) const;
    void find_few_pairs(TaskPool& workers);
    void find_few_pairs_of(std::uint32_t body, Finder& finder) const;
    void keep_pairs();
    void sort_found();
    [[nodiscard]] std::size_t max_pairs() const { return always_kept_pairs + max_partners * proxies.size(); }
};

namespace {

void add_pair(std::vector<BroadPhase::Pair>& pairs, std::uint32_t a, std::uint32_t b) {
    pairs.push_back({std::min(a, b), std::max(a, b)});
}

}  // namespace

// Tests the changed boxes of one leaf against all others: first all of them together, then each against the leaves
// found.
// Of two movable boxes that changed, the earlier one finds the pair.
void BroadPhase::State::find_pairs_of_leaf(std::uint32_t leaf, Finder& finder) const {
    const std::uint32_t mine = movable.changed_mask(leaf);
    if (mine == 0) return;
    const MovingBox together = movable.leaf(leaf).joined(mine);
    const bool any_moves = movable.has_moving();
    const auto collect = [&](std::vector<std::uint32_t>& leaves) {
        leaves.clear();
        return [&leaves](std::uint32_t node, std::uint32_t) { leaves.push_back(node); };
    };
    movable.query(together, collect(finder.movable_leaves), all_changed ? leaf : 0);
    immovable.query(together, collect(finder.immovable_leaves));

    for (std::uint32_t rest = mine; rest != 0; rest &= rest - 1) {
        const std::uint32_t lane = lowest_lane(rest), body = movable.value(leaf, lane);
        const MovingBox box = movable.leaf(leaf).box(lane);
        for (const std::uint32_t node : finder.movable_leaves) {
            const BoxNode& other = movable.leaf(node);
            std::uint32_t mask = any_moves ? other.meeting_mask(box) : other.overlap_mask(box.box);
            if (node < leaf) mask &= ~movable.changed_mask(node);
            if (node == leaf) mask &= ~(mine & ((2u << lane) - 1));
            for (; mask != 0; mask &= mask - 1) add_pair(finder.pairs, body, movable.value(node, lowest_lane(mask)));
        }
        for (const std::uint32_t node : finder.immovable_leaves) {
            const BoxNode& other = immovable.leaf(node);
            std::uint32_t mask = any_moves ? other.meeting_mask(box) : other.overlap_mask(box.box);
            for (; mask != 0; mask &= mask - 1) add_pair(finder.pairs, body, immovable.value(node, lowest_lane(mask)));
        }
        for (const std::uint32_t other : wide) {
            if (proxies[other].fat.meets(box)) add_pair(finder.pairs, body, other);
        }
    }
}

// Movable boxes that changed have already found their pairs with the immovable ones.
void BroadPhase::State::find_pairs_of_immovable_leaf(std::uint32_t leaf, Finder& finder) const {
    for (std::uint32_t mine = immovable.changed_mask(leaf); mine != 0; mine &= mine - 1) {
        const std::uint32_t lane = lowest_lane(mine), body = immovable.value(leaf, lane);
        const MovingBox box = immovable.leaf(leaf).box(lane);
        movable.query(box, [&](std::uint32_t node, std::uint32_t mask) {
            mask &= ~movable.changed_mask(node);
            for (; mask != 0; mask &= mask - 1) add_pair(finder.pairs, body, movable.value(node, lowest_lane(mask)));
        });
        for (const std::uint32_t other : wide) {
            if (proxies[other].movable && proxies[other].fat.meets(box)) add_pair(finder.pairs, body, other);
        }
    }
}

// Changed boxes in the trees have already found their pairs with the wide bodies.
void BroadPhase::State::find_pairs_of_wide(std::uint32_t body, Finder& finder) const {
    const Proxy& proxy = proxies[body];
    const auto add_unchanged_of = [&](const BoxTree& tree) {
        tree.query(proxy.fat, [&](std::uint32_t node, std::uint32_t mask) {
            mask &= ~tree.changed_mask(node);
            for (; mask != 0; mask &= mask - 1) add_pair(finder.pairs, body, tree.value(node, lowest_lane(mask)));
        });
    };
    add_unchanged_of(movable);
    if (proxy.movable) add_unchanged_of(immovable);
    for (const std::uint32_t other : wide) {
        const bool is_others = has_changed[other] && other <= body;
        if (is_others || !(proxy.movable || proxies[other].movable)) continue;
        if (proxies[other].fat.meets(proxy.fat)) add_pair(finder.pairs, body, other);
    }
}

void BroadPhase::State::change_all() {
    for (std::uint32_t body = 0; body < proxies.size(); ++body) {
        if (proxies[body].used) mark_changed(body);
    }
    movable.change_all();
    immovable.change_all();
}

// Stops where there are too many.
void BroadPhase::State::find_new_pairs(TaskPool& workers) {
    const bool are_many = changed.size() >= min_parallel_count;
    all_changed = movable.are_all_changed();
    parallel_for(workers, movable.leaf_count(), are_many, [&](int worker, IndexRange range) {
        Finder& finder = finders[static_cast<std::size_t>(worker)];
        for (auto leaf = range.first; leaf < range.last; ++leaf) {
            find_pairs_of_leaf(static_cast<std::uint32_t>(leaf), finder);
            if (finder.pairs.size() > max_pairs()) return;
        }
    });
    for (std::uint32_t leaf = 0; leaf < immovable.leaf_count(); ++leaf) find_pairs_of_immovable_leaf(leaf, finders[0]);
    for (const std::uint32_t body : wide) {
        if (has_changed[body]) find_pairs_of_wide(body, finders[0]);
    }
}

// Which pairs are left out depends on the bodies' indices only.
void BroadPhase::State::find_few_pairs_of(std::uint32_t body, Finder& finder) const {
    const auto add_lowest = [&](bool are_movable, std::size_t most) {
        finder.partners.clear();
        visit_met(proxies[body].fat, [&](std::uint32_t other) {
            if (proxies[other].movable != are_movable || (are_movable && other <= body)) return;
            finder.partners.push_back(other);
        });
        std::vector<std::uint32_t>& partners = finder.partners;
        const auto last = partners.begin() + static_cast<std::ptrdiff_t>(std::min(most, partners.size()));
        std::partial_sort(partners.begin(), last, partners.end());
        std::for_each(partners.begin(), last, [&](std::uint32_t other) { add_pair(finder.pairs, body, other); });
    };
    add_lowest(true, max_partners);
    add_lowest(false, max_immovable_partners);
}

void BroadPhase::State::find_few_pairs(TaskPool& workers) {
    parallel_for(workers, proxies.size(), true, [&](int worker, IndexRange range) {
        Finder& finder = finders[static_cast<std::size_t>(worker)];
        finder.pairs.clear();
        for (auto body = range.first; body < range.last; ++body) {
            const Proxy& proxy = proxies[body];
            if (proxy.used && proxy.movable) find_few_pairs_of(static_cast<std::uint32_t>(body), finder);
        }
    });
}

// The pairs of bodies that have not changed.
void BroadPhase::State::keep_pairs() {
    kept.clear();
    for (const Pair& pair : pairs) {
        if (!has_changed[pair.a] && !has_changed[pair.b]) kept.push_back(pair);
    }
}

// Sorts the found pairs: by the first body by counting, then each body's few by the second.
void BroadPhase::State::sort_found() {
    first_of_a.assign(proxies.size() + 1, 0);
    std::size_t count = 0;
    for (const Finder& finder : finders) {
        count += finder.pairs.size();
        for (const Pair& pair : finder.pairs) ++first_of_a[pair.a + 1];
    }
    for (std::size_t a = 1; a < first_of_a.size(); ++a) first_of_a[a] += first_of_a[a - 1];
    found.resize(count);
    for (const Finder& finder : finders) {
        for (const Pair& pair : finder.pairs) found[first_of_a[pair.a]++] = pair;
    }

    // After the distribution an entry is the index at which the next body's pairs begin.
    std::uint32_t begin = 0;
    for (std::size_t a = 0; a + 1 < first_of_a.size(); ++a) {
        const std::uint32_t end = first_of_a[a];
        std::sort(found.begin() + begin, found.begin() + end);
        begin = end;
    }
}

BroadPhase::BroadPhase() : state_(std::make_unique<State>()) {}
BroadPhase::~BroadPhase() = default;

void BroadPhase::insert(std::uint32_t body, const Bounds& bounds, bool movable) {
    State& s = *state_;
    if (body >= s.proxies.size()) {
        s.proxies.resize(body + 1);
        s.has_changed.resize(body + 1);
    }
    EMBODY_ASSERT(!s.proxies[body].used);
    EMBODY_ASSERT(!bounds.is_empty());
    s.proxies[body].used = true;
    s.proxies[body].movable = movable;
    s.place(body, enlarged_for(bounds, {}));
}

// The body's pairs are removed by the next update, also if a new body has its index by then.
void BroadPhase::remove(std::uint32_t body) {
    State& s = *state_;
    EMBODY_ASSERT(body < s.proxies.size() && s.proxies[body].used);
    s.unplace(body);
    s.proxies[body].used = false;
}

// The enlarged bounds are kept while they still hold the body and are not far too large (after it shrank or came to
// rest).
bool BroadPhase::holds(std::uint32_t body, const Bounds& bounds, Vec3 motion) const {
    const MovingBox& fat = state_->proxies[body].fat;
    const Bounds largest = enlarged(enlarged_for(bounds, motion).box.bounds(), 4 * margin_of(bounds));
    return holds_path(fat, bounds, motion) && contains(largest, fat.box.bounds());
}

bool BroadPhase::covers(std::uint32_t body, const Bounds& bounds) const {
    if (body >= state_->proxies.size() || !state_->proxies[body].used) return false;
    return state_->proxies[body].fat.swept().contains(bounds);
}

void BroadPhase::move(std::uint32_t body, const Bounds& bounds, Vec3 motion) {
    State& s = *state_;
    EMBODY_ASSERT(body < s.proxies.size() && s.proxies[body].used);
    if (holds(body, bounds, motion)) return;
    State::Proxy& proxy = s.proxies[body];
    const MovingBox wanted = enlarged_for(bounds, motion);
    if (proxy.wide || is_wide(wanted.box.bounds())) {
        s.unplace(body);
        s.place(body, wanted);
        return;
    }
    proxy.fat = wanted;
    s.tree_of(proxy).set(body, proxy.fat);
    s.mark_changed(body);
}

std::uint64_t BroadPhase::pairs_version() const { return state_->version; }
bool BroadPhase::has_too_many_pairs() const { return state_->too_many; }

const std::vector<BroadPhase::Pair>& BroadPhase::update_pairs(TaskPool& workers) {
    EMBODY_ZONE("update pairs");
    State& s = *state_;
    if (s.changed.empty()) return s.pairs;
    s.refresh();
    s.finders.resize(static_cast<std::size_t>(workers.workers()));
    for (State::Finder& finder : s.finders) finder.pairs.clear();

    // Changed bodies lose their pairs and look for them anew; the others keep theirs, unless some were left out.
    if (s.too_many) s.change_all();
    s.keep_pairs();
    s.find_new_pairs(workers);
    std::size_t count = s.kept.size();
    for (const State::Finder& finder : s.finders) count += finder.pairs.size();
    s.too_many = count > s.max_pairs();
    if (s.too_many) {
        s.kept.clear();
        s.find_few_pairs(workers);
    }
    s.sort_found();
    s.sorted.resize(s.kept.size() + s.found.size());
    std::merge(s.kept.begin(), s.kept.end(), s.found.begin(), s.found.end(), s.sorted.begin());
    if (s.sorted != s.pairs) {
        s.pairs.swap(s.sorted);
        ++s.version;
    }

    for (const std::uint32_t body : s.changed) s.has_changed[body] = 0;
    s.changed.clear();
    s.movable.forget_changes();
    s.immovable.forget_changes();
    return s.pairs;
}

void BroadPhase::query(const Bounds& box, const std::function<void(std::uint32_t)>& visit) const {
    state_->refresh();
    std::vector<std::uint32_t> found;
    state_->visit_met(MovingBox(FloatBox(box)), [&found](std::uint32_t body) { found.push_back(body); });
    std::sort(found.begin(), found.end());
    for (const std::uint32_t body : found) visit(body);
}

void BroadPhase::query_ray(Vec3 origin, Vec3 direction, double max_distance,
                           const std::function<double(std::uint32_t, double)>& visit) const {
    State& s = *state_;
    s.refresh();
    struct Met {
        double entry;
        std::uint32_t body;
        auto operator<=>(const Met&) const = default;
    };
    std::vector<Met> met;
    const auto entry = [&](const MovingBox& b) {
        return entry_of(b.swept().bounds(), origin, direction, max_distance);
    };
    const auto meets = [&](const BoxNode& node) {
        std::uint32_t mask = 0;
        for (std::uint32_t lane = 0; lane < BoxNode::lanes; ++lane) {
            if (!node.is_clear(lane) && entry(node.box(lane)) < never) mask |= 1u << lane;
        }
        return mask;
    };
    const auto add = [&](std::uint32_t body) {
        if (const double e = entry(s.proxies[body].fat); e < never) met.push_back({e, body});
    };
    std::for_each(s.wide.begin(), s.wide.end(), add);
    for (const BoxTree* tree : {&s.movable, &s.immovable}) {
        tree->walk(meets, [&](std::uint32_t node, std::uint32_t mask) {
            for (; mask != 0; mask &= mask - 1) add(tree->value(node, lowest_lane(mask)));
        });
    }

    // The nearest first: boxes behind a hit need no test.
    std::sort(met.begin(), met.end());
    for (const Met& m : met) {
        if (m.entry > max_distance) break;
        max_distance = visit(m.body, max_distance);
    }
}

void BroadPhase::visit_boxes(const std::function<void(const Bounds&, int depth)>& visit) const {
    for (const BoxTree* tree : {&state_->movable, &state_->immovable})
        tree->visit_boxes([&](const FloatBox& box, int depth) { visit(box.bounds(), depth); });
}

}  // namespace embody::physics::collision
