// SPDX-License-Identifier: MIT
//
// The only file that sees CLI11. One function a command: its options, its help and an example.
#include "cli/arguments.h"

#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <sstream>

#include "catalog/catalog.h"
#include "catalog/import/find_models.h"
#include "cli/output.h"
#include "foundation/version.h"

namespace embody::cli {
namespace {

/// A sub-command whose options write into `into`; choosing it chooses that struct.
template <class T>
struct Command {
    CLI::App* app = nullptr;
    std::shared_ptr<T> into = std::make_shared<T>();
};

/// A number in the range; unlike CLI::Range it refuses "nan".
CLI::Validator between(double low, double high) {
    const auto check = [low, high](const std::string& word) -> std::string {
        double number = 0;
        if (CLI::detail::lexical_cast(word, number) && number >= low && number <= high) return {};
        return "must be a number from " + short_number(low) + " to " + short_number(high) + ", got " + word;
    };
    return {check, "NUMBER"};
}

class Parser {
public:
    Parser() : app_("Embody: a VR scene studio whose models behave.", "embody") {
        app_.set_version_flag("--version", std::string("embody ") + version_text);
        app_.set_help_flag("-h,--help", "Print this help");
        app_.require_subcommand(1);
        app_.failure_message(CLI::FailureMessage::simple);
        add_serve();
        add_import();
        add_import_home();
        add_search();
        add_show();
        add_set();
        add_reset();
        add_history();
        add_undo();
        add_simulate();
        add_check();
        add_classify();
        add_attributes();
        add_evaluate();
        add_scene();
        add_bench();
    }

    Parsed parse(int count, char** words) {
        try {
            app_.parse(count, words);
        } catch (const CLI::ParseError& error) {
            // CLI11's exit code is 0 where help or version was asked for. An error quotes the words, which may be names
            // of files.
            std::ostringstream output, errors;
            const int code = app_.exit(error, output, errors);
            write_text(stdout, printable_lines(output.str()));
            write_text(stderr, printable_lines(errors.str()));
            return {std::nullopt, code == 0 ? exit_ok : exit_usage};
        }
        return {chosen_, exit_ok};
    }

private:
    template <class T>
    Command<T> add(const std::string& name, const std::string& what, const std::string& example) {
        Command<T> command;
        command.app = app_.add_subcommand(name, what);
        command.app->footer("Example:\n  " + example);
        command.app->callback([this, into = command.into] { chosen_ = *into; });
        return command;
    }
    /// Sets the environment variable, because every part and process of this command reads the folder there.
    static void add_taxonomy(CLI::App* app) {
        const auto name = [](const std::string& folder) { setenv("EMBODY_TAXONOMY", folder.c_str(), 1); };
        app->add_option_function<std::string>("--taxonomy", name, "Folder of your own categories, laid over ours")
            ->check(CLI::ExistingDirectory);
    }
    template <class T>
    static void add_database(const Command<T>& command) {
        command.into->database = catalog::Catalog::default_file();
        command.app->add_option("--database", command.into->database, "Model database")->capture_default_str();
        add_taxonomy(command.app);
    }
    template <class T>
    static void add_json(const Command<T>& command) {
        command.app->add_flag("--json", command.into->json, "Print JSON, for programs");
    }

    void add_serve() {
        auto c = add<ServeArguments>("serve", "Serve the Studio: open the printed address in a browser",
                                     "embody serve --scene stack --port 9000");
        add_database(c);
        c.app
            ->add_option("--address", c.into->address,
                         "IP address to listen on; other than loopback needs the printed token")
            ->capture_default_str();
        c.app->add_option("--port", c.into->port,
                          "Port; 0: any free one (default 8420, or a free one where it is taken)");
        c.app->add_option("--scene", c.into->scene,
                          "Scene to open: a file, or the name of a saved or demo scene (default furnished_room)");
        c.app->add_flag("--tls", c.into->tls,
                        "Serve by https, which headsets need; makes a certificate where none is named");
        auto* certificate =
            c.app->add_option("--certificate", c.into->certificate, "Certificate for https, a PEM file");
        auto* key = c.app->add_option("--key", c.into->key, "Its private key, a PEM file");
        certificate->needs(key);
        key->needs(certificate);
        c.app->add_flag("--qr", c.into->qr, "Draw the address as a QR code, where the output is no terminal, too");
        c.app->add_option("--fill", c.into->fill,
                          "Files, folders and catalogues to import in the background, while the Studio is used");
        c.app->add_option("--fill-list", c.into->fill_list,
                          "A file or pipe that names more of them, one a line; \"# text\" says what could not be had");
        c.app->add_option("--fill-mark", c.into->fill_mark, "File to write when all of these are in the database");
        c.app->add_flag("--open", c.into->open_browser, "Open the Studio in the desktop's browser");
    }
    void add_import() {
        auto c =
            add<ImportArguments>("import", "Bring models into the database: files, folders, Sweet Home 3D catalogues",
                                 "embody import chair.glb ~/models /usr/share/sweethome3d/furniture/Scopia.sh3f");
        add_database(c);
        c.app->add_option("paths", c.into->paths, "Files (" + catalog::readable_extensions() + ") and folders");
        c.app->add_option(
            "--collection", c.into->collection,
            "Take the files as those of a collection (its unit, axes, licence), or without paths all that "
            "is installed of it: flightgear, kicad, or a description FILE.json");
        c.app->add_option("--workers", c.into->workers, "Processes that read models (default: one per core)")
            ->check(CLI::Range(0, 256));
        c.app->add_flag("--again", c.into->again, "Also read files that are unchanged since the last import");
        add_json(c);
    }
    void add_import_home() {
        auto c = add<ImportHomeArguments>(
            "import-home", "Make a scene of a home of Sweet Home 3D, and bring its furniture into the database",
            "embody import-home flat.sh3d -o flat.json");
        add_database(c);
        c.app->add_option("home", c.into->home, "The home (.sh3d)")->required();
        c.app->add_option("-o,--output", c.into->output, "The scene file (default: standard output)");
        c.app->add_option("--workers", c.into->workers, "Processes that read models (default: one per core)")
            ->check(CLI::Range(0, 256));
    }
    void add_search() {
        auto c = add<SearchArguments>("search", "Find models by words in name, tags, category and source",
                                      "embody search --limit 5 office chair");
        add_database(c);
        c.app->add_option("words", c.into->words, "Words; their beginnings match too");
        c.app->add_option("--category", c.into->category, "Only this category");
        c.app->add_option("--limit", c.into->limit, "Maximum number of models")
            ->capture_default_str()
            ->check(CLI::Range(1, 1000));
        c.app->add_option("--offset", c.into->offset, "Skip so many")->check(CLI::NonNegativeNumber);
        add_json(c);
    }
    void add_show() {
        auto c = add<ShowArguments>("show", "Print a model and its physical attributes, each with the reason",
                                    "embody show \"sweethome3d:Blend Swap CC-0#armchair\"");
        add_database(c);
        c.app->add_option("model", c.into->model, "Key, id or unique name of a model")->required();
        add_json(c);
    }
    template <class T>
    static void add_many(const Command<T>& command) {
        ManyArguments& many = command.into->many;
        command.app->add_option("--query", many.query, "In place of a model: all that these words find");
        command.app->add_option("--category", many.category, "In place of a model: all of this category");
        command.app->add_flag("--all", many.all, "In place of a model: every model");
        command.app->add_flag("--dry-run", many.dry_run,
                              "Print how many and which models would change, and change nothing");
        command.app->add_flag(
            "--skip", many.skip,
            "Skip models that an attribute does not apply to (otherwise one of them stops the change)");
    }
    void add_set() {
        auto c = add<SetArguments>("set", "Change attributes of a model, or of many, by hand; survives re-import",
                                   "embody set 17 mass=12.5 friction_dynamic=0.6\n"
                                   "  embody set --query \"office chair\" --category chair surface_material=oak");
        add_database(c);
        c.app->add_option("words", c.into->words, "Key, id or unique name of a model, then name=value …")->required();
        add_many(c);
        add_json(c);
    }
    void add_reset() {
        auto c = add<ResetArguments>("reset", "Go back to the automatic value of attributes",
                                     "embody reset 17 mass\n  embody reset --category chair mass");
        add_database(c);
        c.app->add_option("words", c.into->words,
                          "Key, id or unique name of a model, then attributes; none: all that were changed by hand");
        add_many(c);
        add_json(c);
    }
    void add_history() {
        auto c = add<HistoryArguments>("history", "List who changed what by hand, and when",
                                       "embody history --since 7d\n  embody history \"office chair\"");
        add_database(c);
        c.app->add_option("model", c.into->model, "Key, id or unique name of a model (default: all)");
        c.app->add_option("--since", c.into->since,
                          "Only changes since: 2026-11-22, 2026-11-22T14:30 (UTC), 7d (days ago) or 2h");
        c.app->add_option("--batch", c.into->batch, "Only the batch of changes with this number")
            ->check(CLI::PositiveNumber);
        c.app->add_option("--limit", c.into->limit, "Maximum number of values")
            ->capture_default_str()
            ->check(CLI::Range(1, 1'000'000));
        add_json(c);
    }
    void add_undo() {
        auto c = add<UndoArguments>("undo", "Undo a batch of changes by hand; an undo can be undone, too",
                                    "embody undo\n  embody undo 12");
        add_database(c);
        c.app->add_option("batch", c.into->batch, "Number of the batch in `embody history` (default: your last)")
            ->check(CLI::PositiveNumber);
        c.app->add_flag("--dry-run", c.into->dry_run,
                        "Print how many and which models would change, and change nothing");
        add_json(c);
    }
    void add_simulate() {
        auto c = add<SimulateArguments>(
            "simulate", "Run a scene without a window and record what happens",
            "embody simulate data/scenes/stack_of_boxes.json --seconds 5 --record out.jsonl --energy");
        add_database(c);
        c.app->add_option("scene", c.into->scene, "Scene file, or a name that `embody scene` lists")->required();
        c.app->add_option("--seconds", c.into->seconds, "Simulated time")
            ->capture_default_str()
            ->check(between(0, 1e6));
        c.app->add_option("--record", c.into->record, "File for JSON lines: every entity's pose, velocities and state");
        c.app->add_option("--rate", c.into->rate, "Samples per simulated second")
            ->capture_default_str()
            ->check(between(1e-3, 1e5));
        c.app->add_flag("--contacts", c.into->contacts, "Record contacts with impulses");
        c.app->add_flag("--energy", c.into->energy,
                        "Say at the end what changed the bodies' energy, and record energy and momenta");
        c.app->add_option("--trace", c.into->trace,
                          "File for the times of each stage of each step on each thread, for chrome://tracing "
                          "or ui.perfetto.dev");
        add_json(c);
    }
    void add_check() {
        auto c = add<CheckArguments>("check", "Say whether scene files can be read and simulated, and what is wrong",
                                     "embody check data/scenes/*.json");
        add_database(c);
        c.app->add_option("scenes", c.into->scenes, "Scene files")->required();
        add_json(c);
    }
    void add_classify() {
        auto c = add<ClassifyArguments>("classify",
                                        "Print the category of a thing of this name, why, and what else it could be",
                                        "embody classify tureen --category Kitchen --size 0.3 0.25 0.2");
        add_taxonomy(c.app);
        c.app->add_option("name", c.into->name, "Name of a model")->required();
        c.app->add_option("--tag", c.into->tags, "A tag of the model; may be given several times")
            ->allow_extra_args(false);
        c.app->add_option("--category", c.into->category, "The catalogue's own category");
        c.app->add_option("--folder", c.into->folder, "Folder of its file");
        c.app->add_option("--size", c.into->size, "Extents of its box, m")->expected(3)->check(between(1e-6, 1e6));
        add_json(c);
    }
    void add_attributes() {
        auto c = add<AttributesArguments>("attributes", "List the physical attributes: unit, default, range, meaning",
                                          "embody attributes friction_dynamic");
        c.app->add_option("name", c.into->name, "One attribute; none: all");
        c.app->add_flag("--markdown", c.into->markdown, "Print the tables of docs/attributes.md");
        add_json(c);
    }
    void add_evaluate() {
        auto c = add<EvaluateArguments>("evaluate", "Compare automatic attributes with what is known of real things",
                                        "embody evaluate mass --truth tests/reference/mass-held-out-dev.csv");
        c.app->require_subcommand(1);
        CLI::App* mass = c.app->add_subcommand("mass", "Predicted masses beside those of measured objects");
        mass->add_option("--truth", c.into->truth,
                         "CSV with the columns id, name, category, dim_x_m, dim_y_m, dim_z_m, mass_kg and perhaps "
                         "mesh_volume_m3")
            ->required()
            ->check(CLI::ExistingFile);
        mass->add_option("--told", c.into->told, "What the predictor knows beside the size: everything, name, category")
            ->capture_default_str()
            ->check(CLI::IsMember({"everything", "name", "category"}).description(""));
        mass->add_flag("--unseen", c.into->unseen,
                       "Hide the category of each object, as if its words were never seen: what WordNet makes of them");
        mass->add_option("--worst", c.into->worst, "Number of the worst predictions to list")
            ->capture_default_str()
            ->check(CLI::NonNegativeNumber);
        CLI::App* catalogue = c.app->add_subcommand(
            "catalogue", "Categories of the database's models, compared with the data of their catalogue");
        c.into->database = catalog::Catalog::default_file();
        catalogue->add_option("--database", c.into->database, "Model database")->capture_default_str();
        catalogue
            ->add_option("--kinds", c.into->kinds,
                         "CSV with the columns words and kinds (parts separated by ;) to compare physical kinds with")
            ->check(CLI::ExistingFile);
        CLI::App* behaviour = c.app->add_subcommand(
            "behaviour", "Behaviour of the database's models in small simulations, compared with their attributes");
        behaviour->add_option("--database", c.into->database, "Model database")->capture_default_str();
        behaviour->add_option("--limit", c.into->limit, "Maximum number of models (0: all)")
            ->capture_default_str()
            ->check(CLI::NonNegativeNumber);
        for (CLI::App* one : {mass, catalogue, behaviour}) {
            one->add_flag("--json", c.into->json, "Print JSON, for programs");
            one->callback([into = c.into, one] { into->what = one->get_name(); });
        }
    }
    void add_scene() {
        auto c = add<SceneArguments>("scene", "List the built-in scenes, or write one as a scene file",
                                     "embody scene table1_f --output wall.json");
        c.app->add_option("name", c.into->name, "Built-in scene; none: list them");
        c.app->add_option("--output", c.into->output, "File to write (default: standard output)");
        add_json(c);
    }
    void add_bench() {
        auto c = add<BenchArguments>("bench",
                                     "Time the paper's scenes beside the paper's own numbers, or race other engines",
                                     "embody bench table1 --scene table1_f --json");
        add_race(c);
        c.app
            ->add_option(
                "suite", c.into->suite,
                "table1; stability: do structures stand without gaps and motion; simbenchmark: accuracy beside "
                "published figures; scaling: cost of 1,000 to 100,000 bodies; matter: cost of cloth, solids, water and "
                "grains in motion; decomposition: convex parts of models of the database; tetrahedra: fillings of soft "
                "ones; grains: slopes of heaps "
                "and cost of grains; cloth: cost of a tablecloth; soft: cost of cushions; fluid: cost of "
                "water with floating boxes; tanks: energy and momenta of closed tanks over a minute; convergence: soft "
                "bodies and liquids beside theory at several resolutions; "
                "catalogue: search in the database, filled with variants")
            ->capture_default_str()
            ->check(
                CLI::IsMember({"table1", "stability", "simbenchmark", "scaling", "matter", "decomposition",
                               "tetrahedra", "grains", "cloth", "soft", "fluid", "tanks", "convergence", "catalogue"})
                    .description(""));
        c.app->add_option("--scene", c.into->scene, "Only this scene, or this model");
        add_database(c);
        c.app->add_option("--bodies", c.into->bodies, "Suite scaling: largest number of bodies")
            ->capture_default_str()
            ->check(CLI::Range(1'000, 1'000'000));
        c.app
            ->add_option(
                "--models", c.into->models,
                "Suite catalogue: fill the database (not the default one) with variants up to this many models")
            ->check(CLI::Range(0, 10'000'000));
        c.app->add_option("--steps", c.into->steps, "Steps of each scene of table1 (default: its own number)")
            ->check(CLI::Range(0, 10'000'000));
        add_json(c);
    }

    /// Options and help of a race are those of the program that runs it.
    void add_race(const Command<BenchArguments>& bench) {
        CLI::App* race = bench.app->add_subcommand("race", "Race other engines: embody bench race --help");
        race->set_help_flag();
        race->allow_extras();
        bench.app->callback([this, race, into = bench.into] {
            if (race->parsed()) *into = {.suite = "race", .race_words = race->remaining()};
            chosen_ = *into;
        });
    }

    CLI::App app_;
    std::optional<Arguments> chosen_;
};

}  // namespace

Parsed parse_arguments(int count, char** words) { return Parser().parse(count, words); }

}  // namespace embody::cli
