// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace embody::cli {

// What a person asked for: one struct for each command. Every command has --json; those with a database have
// --database.

struct ServeArguments {
    std::filesystem::path database;
    std::string address = "127.0.0.1";
    std::optional<unsigned short> port;  ///< open: 8420, or a free port where 8420 is in use
    std::optional<std::string> scene;    ///< none: the furnished room
    bool tls = false;
    std::filesystem::path certificate, key;   ///< empty: Embody's own
    bool qr = false;                          ///< draw the QR code wherever the output goes
    std::vector<std::filesystem::path> fill;  ///< catalogues to import in the background
    std::filesystem::path fill_list;          ///< file or pipe that names more of them
    std::filesystem::path fill_mark;          ///< file to write when all is in the database
    bool open_browser = false;
};
struct ImportArguments {
    std::filesystem::path database;
    std::vector<std::filesystem::path> paths;
    std::string collection;  ///< name, or file of a description; empty: none
    int workers = 0;
    bool again = false;
    bool json = false;
};
struct ImportHomeArguments {
    std::filesystem::path database;
    std::filesystem::path home;
    std::filesystem::path output;  ///< empty: standard output
    int workers = 0;
};
struct SearchArguments {
    std::filesystem::path database;
    std::vector<std::string> words;
    std::string category;
    int limit = 20;
    int offset = 0;
    bool json = false;
};
struct ShowArguments {
    std::filesystem::path database;
    std::string model;
    bool json = false;
};
/// Selects models by a search, instead of one model by its name.
struct ManyArguments {
    std::string query, category;
    bool all = false;
    bool dry_run = false;  ///< print what would change and change nothing; works for one model, too
    bool skip = false;     ///< change the other models where some refuse

    [[nodiscard]] bool are_chosen() const { return all || !query.empty() || !category.empty(); }
};
struct SetArguments {
    std::filesystem::path database;
    std::vector<std::string> words;  ///< the model unless many are chosen, then "name=value" …
    ManyArguments many;
    bool json = false;
};
struct ResetArguments {
    std::filesystem::path database;
    std::vector<std::string> words;  ///< the model unless many are chosen, then names of attributes
    ManyArguments many;
    bool json = false;
};
struct HistoryArguments {
    std::filesystem::path database;
    std::string model;       ///< key, id or name; empty: all
    std::string since;       ///< as typed
    std::int64_t batch = 0;  ///< 0: all
    int limit = 100;
    bool json = false;
};
struct UndoArguments {
    std::filesystem::path database;
    std::int64_t batch = 0;  ///< 0: this person's last
    bool dry_run = false;
    bool json = false;
};
struct SimulateArguments {
    std::filesystem::path database;
    std::string scene;  ///< a file, or the name of a demo scene or builder
    double seconds = 10;
    std::filesystem::path record;
    double rate = 60;  ///< samples per simulated second
    bool contacts = false, energy = false;
    std::filesystem::path trace;
    bool json = false;
};
struct CheckArguments {
    std::filesystem::path database;
    std::vector<std::filesystem::path> scenes;
    bool json = false;
};
struct ClassifyArguments {
    std::string name;
    std::vector<std::string> tags;
    std::string category, folder;  ///< as a catalogue would name them
    std::vector<double> size;      ///< extents, m; empty: unknown
    bool json = false;
};
struct AttributesArguments {
    std::string name;  ///< empty: all
    bool markdown = false;
    bool json = false;
};
struct EvaluateArguments {
    std::string what;  ///< "mass", "catalogue" or "behaviour"
    std::filesystem::path database;
    std::filesystem::path truth;      ///< table of measured objects
    std::filesystem::path kinds;      ///< table of labelled words; empty: none
    std::string told = "everything";  ///< or "name", "category"
    bool unseen = false;              ///< hide each object's category from the taxonomy
    int worst = 20;                   ///< objects to list
    int limit = 0;                    ///< models to simulate; 0: all
    bool json = false;
};
struct SceneArguments {
    std::string name;  ///< of a builder; empty: list them
    std::filesystem::path output;
    bool json = false;
};
struct BenchArguments {
    /// Or "stability", "simbenchmark", "scaling", "matter", "decomposition", "tetrahedra", "grains", "cloth",
    /// "soft", "fluid", "tanks", "convergence", "catalogue", "race".
    std::string suite = "table1";
    std::filesystem::path database;       ///< of decomposition, tetrahedra and catalogue
    std::vector<std::string> race_words;  ///< for the race's own program
    std::string scene;                    ///< only this one
    int steps = 0;                        ///< 0: as many as the scene says
    int bodies = 100'000;                 ///< largest scene of the suite "scaling"
    int models = 0;                       ///< number of models that the suite "catalogue" fills the database up to
    bool json = false;
};

using Arguments =
    std::variant<ServeArguments, ImportArguments, ImportHomeArguments, SearchArguments, ShowArguments, SetArguments,
                 ResetArguments, HistoryArguments, UndoArguments, SimulateArguments, CheckArguments, ClassifyArguments,
                 AttributesArguments, EvaluateArguments, SceneArguments, BenchArguments>;

/// Exit codes of the program.
enum ExitCode : int { exit_ok = 0, exit_failed = 1, exit_usage = 2, exit_partly = 3 };

/// The command to run; or the exit code of a program that is done already, because it printed help or an error.
struct Parsed {
    std::optional<Arguments> arguments;
    int exit_code = exit_ok;
};
Parsed parse_arguments(int count, char** words);

}  // namespace embody::cli
