// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "math/quat.h"
#include "physics/collision/broad_phase/broad_phase.h"
#include "physics/collision/pairs/manifold.h"
#include "physics/collision/pairs/pair_memory.h"
#include "physics/constraint/contact/contact.h"
#include "physics/state/namespace.h"

namespace embody::physics::state {

/// A body as the touch stage needs it besides its state, in one cache line.
struct alignas(64) TouchBody {
    Vec3 acceleration;   ///< 0 where forces do not move the body, m/s²
    double turning = 0;  ///< of the fastest surface point about the centre of mass, m/s; 0 of balls
    double size = 0;     ///< BodyRecord::reach; planes and meshes, which have none, count as larger than all else, m
    double path = 0;     ///< upper bound of any surface point's travel since the slot has a body, m
    std::uint32_t version = 0;          ///< BodyRecord::version
    std::uint32_t group = 0, mask = 0;  ///< of collision
    bool is_round = false, is_ball = false;
    bool yields = false;  ///< an impulse can move it
    bool stands = false;  ///< was neither moved nor pushed since the last step began, and has no velocity
};
static_assert(sizeof(TouchBody) == 64);

/// What the touch stage reads of every pair in every step: little, since most pairs are apart and stay apart.
struct PairWatch {
    BroadPhase::Pair pair;
    double next_check_travel = 0;  ///< the pair has no contacts until the sum of both bodies' paths reaches this, m
    std::uint32_t record = 0;      ///< in TouchMemory::records
    std::uint32_t count = 0;       ///< of its contacts
};
static_assert(sizeof(PairWatch) == 24);

/// What the touch stage keeps of a pair that it has checked.
struct alignas(64) PairRecord {
    std::uint32_t version_a = 0, version_b = 0;  ///< of the bodies when last compared; 0: never
    std::uint32_t contact_count = 0;             ///< found then
    bool is_whole = false;                       ///< the contacts are all corners within the margin, at that time
    double margin = 0;                           ///< nothing else was within this distance at that time, m
    Vec3 relative_center;                        ///< of the smaller body seen from the larger one, at that time
    Quat relative_rotation;
    PairMemory memory;
};
static_assert(sizeof(PairRecord) == 128);

/// The contacts of a checked pair in a step: those at the same places as before, or new ones.
struct PairTouch {
    std::uint32_t watch = 0;
    std::uint32_t first = 0, count = 0;            ///< its contacts as they lie now
    std::uint32_t next_first = 0, next_count = 0;  ///< and as this step will have them
    std::uint32_t found_first = 0;                 ///< in its finder's
    std::uint8_t finder = keeps;                   ///< worker that found others than were there
    static constexpr std::uint8_t keeps = 255;     // no worker: it has the contacts of the step before
};

/// Memory of the touch stage.
struct TouchMemory {
    struct Worker {
        std::vector<Contact> found;
        std::vector<Manifold> manifolds;
    };
    std::vector<TouchBody> bodies;
    std::vector<double> path_bounds;  ///< by body: its path at the end of the step, if nothing hits it, m
    std::vector<PairWatch> watches;   ///< one for each pair of the broad phase, in its order
    std::vector<PairRecord> records;  ///< indexed by watches; entries between are free
    std::vector<std::uint32_t> free_records;
    std::uint64_t watches_version = 0;  ///< pairs_version that watches was built from
    std::vector<std::uint32_t> live;    ///< while any body sleeps: pairs in which one is awake, ascending
    std::uint64_t live_version = 0, awake_version = 0;  ///< pairs_version and awake_version that live was built from
    std::vector<PairTouch> pairs;                       ///< the pairs that are checked in this step
    bool is_laid_out = false;  ///< contacts lie as watches says; cleared by whoever adds or removes contacts
    std::vector<Worker> workers;
};

}  // namespace embody::physics::state
