// SPDX-License-Identifier: MIT
// The pair's relative velocity where they touch is that of two rigid bodies: of a solid, of its nodes' motion as a
// whole. An impulse J along the normal changes it by k J, with k the sum of both inverse masses there.
#include "physics/stages/deformable/solid_bounces.h"

#include <algorithm>
#include <cmath>

#include "physics/definitions/world_settings.h"
#include "physics/deformable/contact/free_motion.h"
#include "physics/stages/deformable/solid_contact_search.h"

namespace embody::physics::stages {

namespace {

// Speed, and gain of speed in a substep, below which a solid is pushed back no further, over the speed at which it
// came: what comes to a stop slows down by less and less. Test: SoftTime.BallsAndCubesComeBackAsTheirRestitutionSays.
constexpr double slow_fraction = 0.02;

/// What a solid and another thing do to each other in a substep.
struct Touch {
    std::uint32_t solid = 0;
    SolidBounce now;       // its partner, and the push of this substep
    bool is_held = false;  // one holds the other, or the two are being separated
};

class Bounces {
public:
    Bounces(const DeformableAccess& world, std::span<DeformableRecord* const> records, std::span<TouchedBody> bodies,
            double h, double time)
        : world_(world), records_(records), bodies_(bodies), h_(h), time_(time) {}

    void run(std::span<const SolidContact> contacts) {
        std::vector<Touch> touches = find_touches(contacts);
        for (const Touch& touch : touches) follow(touch);
        for (std::uint32_t s = 0; s < records_.size(); ++s) {
            std::erase_if(records_[s]->bounces, [&](SolidBounce& bounce) {
                const bool is_over = std::ranges::none_of(touches, [&](const Touch& touch) {
                    return touch.solid == s && touch.now.partner == bounce.partner;
                });
                if (is_over && bounce.approach > 0 && is_there(bounce)) come_back(s, bounce);
                return is_over;
            });
        }
    }

private:
    // One for each pair; of two solids, the first one's.
    [[nodiscard]] std::vector<Touch> find_touches(std::span<const SolidContact> contacts) const {
        std::vector<Touch> touches;
        std::vector<Vec3> centers;
        for (const DeformableRecord* record : records_) centers.push_back(motion_of_whole(record->nodes()).center);
        for (const SolidContact& contact : contacts) {
            if (contact.force == Vec3{}) continue;
            const bool has_body = contact.has_body();
            const bool is_second = !has_body && contact.other.solid < contact.point.solid;
            const std::uint32_t solid = is_second ? contact.other.solid : contact.point.solid;
            const std::uint32_t other = has_body ? contact.body : is_second ? contact.point.solid : contact.other.solid;
            const std::uint64_t partner = has_body ? contact.partner : first_deformable_partner + records_[other]->slot;
            auto touch = std::ranges::find_if(
                touches, [&](const Touch& t) { return t.solid == solid && t.now.partner == partner; });
            if (touch == touches.end()) {
                touches.push_back({.solid = solid, .now = {.partner = partner, .has_body = has_body}});
                touch = touches.end() - 1;
            }
            const double push = dot(contact.force, contact.normal);
            Vec3 place;
            for (std::size_t k = 0; k < contact.point.count; ++k)
                place +=
                    contact.point.weight[k] * records_[contact.point.solid]->nodes().position[contact.point.node[k]];
            touch->now.pushes += push;
            touch->now.arms += push * (place - centers[solid]);
            touch->now.normals += (is_second ? -push : push) * contact.normal;
            touch->is_held = touch->is_held || contact.holds || contact.parts;
        }
        std::erase_if(touches, [](const Touch& touch) { return !(touch.now.pushes > 0); });
        return touches;
    }

    void follow(const Touch& touch) {
        // Slower ones lie there: gravity alone makes half of that in a step.
        const DeformableRecord& record = *records_[touch.solid];
        const double min_approach =
            2 * length(record.acceleration(world_.settings.gravity)) * world_.settings.time_step;  // m/s
        std::vector<SolidBounce>& bounces = records_[touch.solid]->bounces;
        auto bounce = std::ranges::find(bounces, touch.now.partner, &SolidBounce::partner);
        if (bounce == bounces.end()) {
            const Motion motion = motion_of(touch.solid, touch.now);
            SolidBounce begun = touch.now;
            const double approach = motion.inverse_mass * length(touch.now.normals) * h_ - motion.speed;
            const double restitution = restitution_of(touch.solid, touch.now);
            if (!touch.is_held && restitution > 0 && is_free(touch.solid) &&
                approach > std::max(min_approach, records_[touch.solid]->definition.material.restitution_threshold))
                begun.approach = approach;
            begun.speed = motion.speed;
            bounces.push_back(begun);
            return;
        }
        if (!(bounce->approach > 0)) return;
        bounce->pushes += touch.now.pushes;
        bounce->normals += touch.now.normals;
        bounce->arms += touch.now.arms;
        const Motion motion = motion_of(touch.solid, *bounce);
        if (bounce->has_come_back) {
            if (!(motion.speed > 0)) bounce->approach = 0;  // it stays
            return;
        }
        // Nothing pushes the two apart any more.
        const double slow = slow_fraction * bounce->approach;
        if (motion.speed > -slow && motion.speed - bounce->speed < slow) {
            come_back(touch.solid, *bounce);
            bounce->has_come_back = true;
        }
        bounce->speed = motion.speed;
    }

    struct Motion {
        Vec3 normal, place;
        double speed = 0;         // of the solid away from the other, m/s
        double inverse_mass = 0;  // of both, there and along the normal, 1/kg
    };
    [[nodiscard]] static std::uint32_t slot_of(const SolidBounce& bounce) {
        return static_cast<std::uint32_t>(bounce.has_body ? bounce.partner : bounce.partner - first_deformable_partner);
    }
    // A thing that was taken away in the impact throws nothing back.
    [[nodiscard]] bool is_there(const SolidBounce& bounce) const {
        const std::uint32_t slot = slot_of(bounce);
        return bounce.has_body ? world_.rigid.is_used(slot) : world_.deformables.records.used(slot);
    }
    [[nodiscard]] std::uint32_t index_of_other(const SolidBounce& bounce) const {
        if (bounce.has_body) {
            const std::uint32_t slot = slot_of(bounce);
            const auto body = std::ranges::lower_bound(bodies_, slot, {}, &TouchedBody::body);
            return body != bodies_.end() && body->body == slot ? static_cast<std::uint32_t>(body - bodies_.begin())
                                                               : no_body;
        }
        const std::uint32_t slot = slot_of(bounce);
        const auto record = std::ranges::lower_bound(records_, slot, {}, &DeformableRecord::slot);
        return record != records_.end() && (*record)->slot == slot
                   ? static_cast<std::uint32_t>(record - records_.begin())
                   : no_body;
    }
    [[nodiscard]] Motion motion_of(std::uint32_t solid, const SolidBounce& bounce) const {
        const WholeMotion one = motion_of_whole(records_[solid]->nodes());
        const Vec3 normal = normalized(bounce.normals), place = one.center + bounce.arms / bounce.pushes;
        Motion motion{normal, place, dot(normal, one.velocity_at(place)), one.inverse_mass_at(place, normal)};
        const std::uint32_t other = index_of_other(bounce);
        if (other == no_body) return motion;
        if (bounce.has_body) {
            const TouchedBody& body = bodies_[other];
            const Vec3 arm = place - body.center_at(time_), turning = cross(arm, normal);
            motion.speed -= dot(normal, body.displacement(h_, time_, arm)) / h_;
            if (body.is_dynamic)
                motion.inverse_mass += body.inverse_mass + dot(turning, body.inverse_inertia * turning);
            return motion;
        }
        const WholeMotion two = motion_of_whole(records_[other]->nodes());
        motion.speed -= dot(normal, two.velocity_at(place));
        if (is_free(other)) motion.inverse_mass += two.inverse_mass_at(place, normal);
        return motion;
    }
    [[nodiscard]] bool is_free(std::uint32_t solid) const {
        const DeformableDefinition& definition = records_[solid]->definition;
        return definition.pinned.empty() && definition.attachments.empty();
    }
    // What bends is what the coefficient was measured of; of two solids the one that comes back less.
    [[nodiscard]] double restitution_of(std::uint32_t solid, const SolidBounce& bounce) const {
        const double own = records_[solid]->definition.material.restitution;
        if (bounce.has_body) return own;
        const std::uint32_t other = index_of_other(bounce);
        return other == no_body ? own : std::min(own, records_[other]->definition.material.restitution);
    }

    // The two part with e times the speed at which they came; what of the energy then would be more than before is
    // taken from the solid's vibrations, and what is left of it in its stretch from the speed.
    void come_back(std::uint32_t solid, const SolidBounce& bounce) {
        const Motion motion = motion_of(solid, bounce);
        const double wanted = restitution_of(solid, bounce) * bounce.approach;
        SolidDeformable& own = *records_[solid]->solid();
        double speed = wanted;
        if (speed > motion.speed) {
            const double most = bounce.approach * bounce.approach / (2 * motion.inverse_mass);  // J
            const double left = own.calm_down(most - wanted * wanted / (2 * motion.inverse_mass));
            speed = std::sqrt(std::max(0.0, 2 * motion.inverse_mass * (most - left)));
            speed = std::min(wanted, std::max(speed, motion.speed));
        }
        const Vec3 impulse = ((speed - motion.speed) / motion.inverse_mass) * motion.normal;  // N s
        own.strike(impulse, motion.place);
        const std::uint32_t other = index_of_other(bounce);
        if (other == no_body) return;
        if (bounce.has_body) {
            TouchedBody& body = bodies_[other];
            body.push(-impulse, motion.place - body.center_at(time_), h_);
        } else if (is_free(other)) {
            records_[other]->solid()->strike(-impulse, motion.place);
        }
    }

    const DeformableAccess& world_;
    std::span<DeformableRecord* const> records_;
    std::span<TouchedBody> bodies_;
    double h_, time_;
};

}  // namespace

void bounce_solids(const DeformableAccess& world, std::span<DeformableRecord* const> records,
                   std::span<const SolidContact> contacts, std::span<TouchedBody> bodies, double h, double time) {
    Bounces(world, records, bodies, h, time).run(contacts);
}

}  // namespace embody::physics::stages
