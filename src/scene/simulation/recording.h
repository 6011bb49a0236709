// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "foundation/result.h"
#include "scene/document/document.h"
#include "scene/simulation/simulation.h"

namespace embody::scene {

struct RecordingOptions {
    double rate = 60;       ///< samples per simulated second, > 0; at most one per step
    bool contacts = false;  ///< contact points with their impulses
    bool energy = false;    ///< total energy, linear and angular momentum
};

/// Writes a recording as JSON lines: a header, then one line per sample (docs/scene-format.md, "Recordings"). Each line
/// is whole or missing, however the program ends.
class Recorder {
public:
    /// The error has the file's name, where it cannot be written.
    static Result<std::unique_ptr<Recorder>> create(const std::filesystem::path& file, const Document& document,
                                                    const RecordingOptions& options);
    ~Recorder();

    /// Call once before the first step and after every step; writes a line when a sample is due.
    Result<void> sample(const Simulation& simulation);
    /// Writes buffered lines; then the file is complete.
    Result<void> finish();

private:
    Recorder();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
