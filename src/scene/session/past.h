// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scene/simulation/take.h"

namespace embody::scene {

/// Something that happened in a run, for the timeline.
struct Mark {
    enum class Kind : std::uint8_t { contact, action, rope, tear, hand, branch };
    double time = 0;  ///< simulated, s
    Kind kind = Kind::contact;
    EntityIndex a = 0, b = 0;  ///< what met, or sender and receiver; 0: none
    double impulse = 0;        ///< of a contact, N s
    std::string name;          ///< of an action
};

/// Marks in the order of time; of very many contacts the strongest.
class Marks {
public:
    void add(Mark mark);
    [[nodiscard]] const std::vector<Mark>& all() const { return marks_; }
    /// Another number: there are other marks.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }
    /// Forgets those after this time, or before it.
    void cut_after(double time);
    void cut_before(double time);
    void clear();

private:
    std::vector<Mark> marks_;
    std::uint64_t revision_ = 0;
};

/// What is kept of a run, and what is shown of it: docs/time.md.
struct Past {
    Take take;
    Marks marks;
    struct Spawned {
        Entity entity;
        double time = 0;  ///< s
    };
    std::map<EntityIndex, Spawned> spawned;  ///< by actions, ever in this run
    std::map<EntityIndex, double> removed;   ///< by actions, and when, s
    struct Melted {
        EntityIndex liquid = 0;
        double time = 0;  ///< s
    };
    std::map<EntityIndex, Melted> melted;   ///< things that became drops of a liquid, in this run
    std::map<std::uint32_t, double> fired;  ///< actions by id, and when first, s
    struct Break {
        EntityIndex rope = 0;
        std::uint32_t segment = 0;
        double time = 0;  ///< s
    };
    struct Torn {
        double since = 0;  ///< s
        std::vector<physics::TornCorner> corners;
    };
    /// What has torn of sheets in this run, also of what is gone since. A sheet that was made anew begins another
    /// entry; by time.
    std::map<EntityIndex, std::vector<Torn>> torn;
    std::vector<Break> breaks;                     ///< of ropes in this run, by time
    std::optional<Moment> shown;                   ///< empty: what is now
    std::uint64_t jumps = 0;                       ///< how often something else was shown
    double rate = 1;                               ///< simulated seconds in one of the clock's
    std::chrono::steady_clock::time_point told{};  ///< when clients were told of the take last

    /// Segments of the rope that broke in this run until the time (s).
    [[nodiscard]] std::vector<std::uint32_t> broken_at(EntityIndex rope, double time) const;
    /// What had torn of the sheet at that time, when it had so many points.
    [[nodiscard]] std::vector<physics::TornCorner> torn_at(EntityIndex sheet, double time, std::size_t points) const;
    /// The sheet has torn: `corners` are all that have, in the order of time.
    void add_torn(EntityIndex sheet, double time, std::vector<physics::TornCorner> corners);
    /// For a new run. The rate stays.
    void clear();
};

}  // namespace embody::scene
