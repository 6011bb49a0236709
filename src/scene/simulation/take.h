// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "scene/simulation/moment.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

/// What moved in a run, sample by sample (docs/time.md): a ring of chunks, each of which begins with everything and
/// goes on with what changed.
class Take {
public:
    /// Bytes after which the oldest chunk goes.
    static constexpr std::size_t usual_bytes = 256ull << 20;

    explicit Take(std::size_t max_bytes = usual_bytes) : max_bytes_(max_bytes) {}

    /// Takes a sample of the simulation where one is due: at every step, of steps below 1/60 s 60 times a second.
    void add(const Simulation& simulation);
    /// Takes a sample at this step, due or not; one that it has of this step is kept.
    void add_now(const Simulation& simulation);

    [[nodiscard]] bool empty() const { return chunks_.empty(); }
    /// Simulated times of the first and the last sample, s; 0 where there is none.
    [[nodiscard]] double start() const;
    [[nodiscard]] double end() const;
    [[nodiscard]] std::size_t bytes() const;
    [[nodiscard]] std::size_t samples() const;
    /// Times of all samples, ascending, s.
    [[nodiscard]] std::vector<double> times() const;
    /// The moment at this time, between two samples interpolated; the nearest one where the take has none there. The
    /// take must not be empty. With `only` of these entities.
    [[nodiscard]] Moment at(double time, const std::set<EntityIndex>* only = nullptr) const;
    /// Forgets the samples after this time; the next sample goes on from there.
    void cut(double time);
    void clear() { *this = Take(max_bytes_); }

private:
    using Numbers = std::array<std::int64_t, 13>;  ///< position 3, rotation 4, linear velocity 3, angular velocity 3
    static constexpr std::size_t predicted = 7;    ///< of these the first are predicted from the last difference
    struct Track {
        Numbers numbers{};
        std::array<std::int64_t, predicted> steps{};  ///< differences from the sample before
        std::uint64_t written = 0;                    ///< number of the sample that wrote it: steps hold only there
        std::uint8_t state = 3;
        bool has_points = false, is_liquid = false;
        float radius = 0;
        std::uint64_t membership = 0;                ///< of the simulation's points; 0 after reading
        bool is_renewed = false;                     ///< its points are not those of the sample before
        RecordedPoints::Places points, point_steps;  ///< point_steps null: none
    };
    using Tracks = std::map<EntityIndex, Track>;
    struct Sample {
        double time = 0;
        std::uint64_t step = 0;
        std::size_t at = 0;  ///< its first byte
    };
    struct Chunk {
        std::string data;
        std::vector<Sample> samples;
        std::uint64_t number = 0;   ///< of the first sample in the whole take
        std::size_t beginning = 0;  ///< bytes of the first sample
        [[nodiscard]] std::size_t bytes() const { return data.size() + samples.size() * sizeof(Sample); }
    };
    /// What a sample changes in the tracks.
    struct Changes {
        std::vector<std::pair<EntityIndex, Track>> written;
        std::vector<EntityIndex> removed;
    };
    /// Where the last at() was, so that one soon after it costs one sample.
    struct Cursor {
        const Chunk* chunk = nullptr;
        std::size_t sample = 0;
        Tracks tracks;                ///< at the sample
        std::optional<Changes> next;  ///< of the sample after it
    };

    /// `interval`: s since the sample before.
    static Track quantised(const EntityMotion& motion, const Track* before, std::uint64_t number, double interval);
    static bool are_same_points(const Track& a, const Track& b);
    static bool is_same(const Track& a, const Track& b);
    static void write(std::string& data, const Track& track, const Track* before, std::uint64_t number);
    static Track read(const char*& at, const Track* before, std::uint64_t number);
    static Changes decode(const Chunk& chunk, std::size_t sample, const Tracks& tracks);
    static void apply(Tracks& tracks, Changes changes);
    static Moment moment(const Cursor& cursor, double time, const std::set<EntityIndex>* only);
    void sample(const Simulation& simulation);
    void begin_chunk();
    void drop_oldest();
    void place_cursor(double time) const;

    std::size_t max_bytes_;
    std::deque<Chunk> chunks_;
    std::size_t closed_bytes_ = 0;  ///< of all chunks but the last
    bool is_open_ = false;          ///< the last chunk goes on
    std::uint64_t number_ = 0;      ///< of the next sample
    Tracks tracks_;                 ///< at the last sample
    mutable Cursor cursor_;
};

}  // namespace embody::scene
