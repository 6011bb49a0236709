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
    double rate = 60;       ///< samples a simulated second, > 0; never more than one a step
    bool contacts = false;  ///< contact points with their impulses
    bool energy = false;    ///< total energy, linear and angular momentum
};

/// Writes what happens as JSON lines: a header, then one line a sample (docs/scene-format.md, "Recordings"). Each line
/// is whole or not there, whatever ends the program.
class Recorder {
public:
    /// Fails, with the file's name, where it cannot be written.
    static Result<std::unique_ptr<Recorder>> create(const std::filesystem::path& file, const Document& document,
                                                    const RecordingOptions& options);
    ~Recorder();

    /// Call once before the first step and after every step; writes when a sample is due.
    Result<void> sample(const Simulation& simulation);
    /// Writes what is still held; the file is complete after this.
    Result<void> finish();

private:
    Recorder();
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace embody::scene
