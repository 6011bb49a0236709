// SPDX-License-Identifier: MIT
#pragma once

#include "physics/deformable/contact/crossing_guard.h"
#include "physics/deformable/contact/support_springs.h"
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
    /// Pushes the bodies, notes ropes that break. A member with non-finite numbers freezes. Where things meet so fast
    /// that shorter parts are needed nothing is changed and the answer is false; never if `is_shortest`.
    bool advance(std::span<TouchedBody> bodies, bool is_shortest);

private:
    struct Member {
        ThinDeformable* thin = nullptr;
        Substep substep;
        std::size_t first = 0, count = 0;  // of its nodes among all
        TouchSprings touch;                // as the last solve had them
        std::vector<Vec3> mean_velocity;   // before the part, m/s
        double last_substep = 0;           // as Nodes::substep before the part
        std::vector<std::array<std::uint32_t, 2>> segments;
        [[nodiscard]] DeformableRecord& record() const { return *thin->record; }
    };
    template <class Values>
    [[nodiscard]] static auto part(Values& values, const Member& member) {
        return std::span(values).subspan(member.first, member.count);
    }
    [[nodiscard]] std::span<Member> ropes() { return std::span(members_).subspan(sheets_); }
    [[nodiscard]] bool has_ropes() const { return members_.size() > sheets_; }
    [[nodiscard]] bool is_rope_alone() const { return members_.size() == 1 && has_ropes(); }
    void begin(std::span<const TouchedBody> bodies);
    void begin_members(std::span<const TouchedBody> bodies);
    void load_nodes(std::span<const TouchedBody> bodies);
    void begin_pairs(std::span<const TouchedBody> bodies);
    void begin_supports(std::span<const TouchedBody> bodies);
    [[nodiscard]] double mass_of_members() const;
    [[nodiscard]] double carried_mass(std::span<const TouchedBody> bodies) const;
    enum class Outcome : std::uint8_t { solved, too_fast, not_finite };
    Outcome solve(std::span<const TouchedBody> bodies, bool is_shortest);
    int solve_linear(std::span<const SheetSystem> sheets, std::span<const LineSystem> lines,
                     std::span<const BodyInertia> inertias);
    [[nodiscard]] bool are_finite() const;
    [[nodiscard]] bool is_too_fast(const ThinMeeting& meeting) const;
    void gather_springs();
    [[nodiscard]] double energy(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias,
                                SpringEnergy spring_energy);
    double go_as_far_as_it_pays(std::span<const SheetSystem> sheets, std::span<const BodyInertia> inertias);
    void go_as_far_as_energy_lasts(std::span<const BodyInertia> inertias);
    bool choose_again(bool is_last);
    enum class Stretch : std::uint8_t { foreseen, unforeseen, too_far };
    Stretch linearize_again(bool is_last, bool may_cut, std::span<const TouchedBody> bodies);
    [[nodiscard]] double unforeseen_stretch(const Member& member, std::span<const TouchedBody> bodies);
    [[nodiscard]] double energy_of_motion(const Member& member, std::span<const TouchedBody> bodies) const;
    [[nodiscard]] bool is_struck(std::span<const TouchedBody> bodies) const;
    void settle_bodies(std::span<const BodyInertia> inertias);
    void add_contacts(std::span<const ThinMeeting> meetings);
    [[nodiscard]] std::vector<double> compliances() const;
    void keep_momenta();
    void shorten_moves();
    [[nodiscard]] std::vector<TouchSpring> springs_of_others(const Member& member) const;
    void end(std::span<TouchedBody> bodies);
    void take_back();

    const DeformableAccess world_;
    const ThinGroup& group_;
    double h_ = 0;
    std::vector<Member> members_;       // sheets first
    std::vector<std::uint32_t> place_;  // of the group's members among these
    std::size_t sheets_ = 0;
    std::vector<ThinMember> seen_;              // the members as others see them
    std::vector<ThinPair> met_;                 // pairs of members, of a sheet with itself too
    std::vector<CrossingGuard::Pair> guarded_;  // the same
    PairSprings pairs_;                         // of `met_`
    TieSprings ties_;
    SupportSprings supports_;
    std::vector<TouchSpring> springs_;  // of all
    std::vector<Vec3> moves_, from_;    // by node of all
    std::vector<Vec3> rigid_moves_;     // of a rope alone: the least that it may do
    std::vector<BodyMove> body_moves_, body_from_;
};

/// Input of a sheet or rope for a substep of h seconds that begins at `time` in the step.
Substep substep_of(const DeformableAccess& world, const DeformableRecord& record, double h, double time);
/// Reports what broke in the last substep.
void note_breaks(const DeformableAccess& world, const DeformableRecord& record);
/// Its surface for contacts with others. `segments`: storage for those of a rope.
ThinSurface surface_of(const DeformableRecord& record, std::vector<std::array<std::uint32_t, 2>>& segments);

}  // namespace embody::physics::stages
