// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/contact/tie_springs.h"
#include "physics/stages/access.h"
#include "physics/stages/deformable/thin_groups.h"
#include "physics/stages/namespace.h"

namespace embody::physics::stages {

/// One part of a substep of sheets and ropes that are solved together (docs/physics/cloth.md).
class ThinGroupPart {
public:
    /// `h`: of the part, which begins at `time` in the step, s. The arguments outlive it.
    ThinGroupPart(const DeformableAccess& world, const ThinGroup& group, std::span<ThinDeformable> thin, double h,
                  double time);
    /// Pushes the bodies, notes ropes that break. A member with non-finite numbers freezes.
    void advance(std::span<TouchedBody> bodies);

private:
    struct Member {
        ThinDeformable* thin = nullptr;
        Substep substep;
        std::size_t first = 0, count = 0;  // of its nodes among all
        TouchSprings touch;                // as the last solve had them
        PairSprings layers;                // of a sheet
        std::vector<std::array<std::uint32_t, 2>> segments;
        [[nodiscard]] DeformableRecord& record() const { return *thin->record; }
    };
    template <class Values>
    [[nodiscard]] static auto part(Values& values, const Member& member) {
        return std::span(values).subspan(member.first, member.count);
    }
    [[nodiscard]] std::span<Member> ropes() { return std::span(members_).subspan(sheets_); }
    [[nodiscard]] bool has_ropes() const { return members_.size() > sheets_; }
    void begin(std::span<const TouchedBody> bodies);
    void begin_members(std::span<const TouchedBody> bodies, std::span<ThinMember> seen);
    void load_nodes(std::span<const TouchedBody> bodies, std::span<ThinMember> seen) const;
    void begin_pairs(std::span<const ThinMember> seen);
    bool solve(std::span<const TouchedBody> bodies);
    void gather_springs();
    [[nodiscard]] double energy(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias);
    double go_as_far_as_it_pays(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias);
    bool choose_again();
    [[nodiscard]] std::vector<TouchSpring> springs_of_others(const Member& member) const;
    void end(std::span<TouchedBody> bodies);

    const DeformableAccess world_;
    const ThinGroup& group_;
    double h_ = 0;
    std::vector<Member> members_;       // sheets first
    std::vector<std::uint32_t> place_;  // of the group's members among these
    std::size_t sheets_ = 0;
    PairSprings pairs_;
    TieSprings ties_;
    std::vector<TouchSpring> springs_;        // of all
    std::vector<Vec3> moves_, from_, given_;  // by node of all
    std::vector<BodyMove> body_moves_, body_from_;
};

/// Input of a sheet or rope for a substep of h seconds that begins at `time` in the step.
Substep substep_of(const DeformableAccess& world, const DeformableRecord& record, double h, double time);
/// Reports what broke in the last substep.
void note_breaks(const DeformableAccess& world, const DeformableRecord& record);
/// Its surface for contacts with others. `segments`: storage for those of a rope.
ThinSurface surface_of(const DeformableRecord& record, std::vector<std::array<std::uint32_t, 2>>& segments);

}  // namespace embody::physics::stages
