// SPDX-License-Identifier: MIT
#include "scene/session/scene_folders.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "scene/file/scene_file.h"
#include "scene/session/file_names.h"

namespace embody::scene {

using nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string autosave_prefix = "autosave/";
const std::string demo_prefix = "demo/";

// A stem made by a person may be one that encoded() never makes, such as "50% off" or "a:b".
bool is_stem(const std::string& name) {
    return !name.empty() && name.size() <= 250 && name.front() != '.' && name.find('/') == std::string::npos &&
           name.find('\0') == std::string::npos;
}

bool is_file(const fs::path& file) {
    std::error_code ignored;
    return fs::is_regular_file(file, ignored);
}

// The file of a scene of that name, existing or not. A file with a stem made by a person is found by that stem.
fs::path file_in(const fs::path& folder, const std::string& name) {
    fs::path file = folder / (encoded(name) + ".json");
    const bool is_ours = encoded(decoded(name)) == name;  // is itself a stem of encoded(), maybe of another name
    if (is_ours || !is_stem(name) || is_file(file)) return file;
    fs::path named_otherwise = folder / (name + ".json");
    return is_file(named_otherwise) ? named_otherwise : file;
}

// The name by which file_in() finds the file.
std::string name_in(const fs::path& file) {
    const std::string stem = file.stem().string();
    std::string name = decoded(stem);
    return encoded(name) == stem ? name : stem;
}

// Reads title and description, and stops where the entities begin: the writer puts those at the top, and scenes can be
// large.
class HeadingReader : public nlohmann::json_sax<nlohmann::json> {
public:
    std::string title, description;

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t& value) override {
        if (depth_ == 1 && key_ == "title") title = value;
        if (depth_ == 1 && key_ == "description") description = value;
        return true;
    }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return ++depth_ < 64; }
    bool key(string_t& value) override {
        if (depth_ == 1) key_ = value;
        return depth_ != 1 || value != "entities";
    }
    bool end_object() override { return --depth_ >= 0; }
    bool start_array(std::size_t) override { return ++depth_ < 64; }
    bool end_array() override { return --depth_ >= 0; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

private:
    int depth_ = 0;
    std::string key_;  ///< of the outermost object
};

HeadingReader heading_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    HeadingReader heading;
    nlohmann::json::sax_parse(in, &heading);
    if (heading.title.empty()) heading.title = file.stem().string();
    return heading;
}

// The scenes of a folder by name; none for a folder that does not exist.
std::vector<ListedScene> list_folder(const fs::path& folder, const std::string& kind, const std::string& prefix) {
    std::vector<ListedScene> scenes;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        std::error_code unreadable;
        if (entry->path().extension() != ".json" || !entry->is_regular_file(unreadable)) continue;
        const auto time = entry->last_write_time(unreadable);
        HeadingReader heading = heading_of(entry->path());
        scenes.push_back({prefix + name_in(entry->path()), std::move(heading.title), std::move(heading.description),
                          kind, unreadable ? std::string() : utc_text(time)});
    }
    std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return scenes;
}

}  // namespace

std::string trimmed_name(const std::string& name) {
    const std::size_t begin = name.find_first_not_of(' ');
    if (begin == std::string::npos) return "Untitled";
    return name.substr(begin, name.find_last_not_of(' ') + 1 - begin);
}

Result<fs::path> saved_file(const SessionOptions& options, const std::string& name) {
    for (const std::string& prefix : {autosave_prefix, demo_prefix})
        if (name.starts_with(prefix))
            return Error{"name", "begins with \"" + prefix + "\", which is not among the saved scenes",
                         "take another name"};
    fs::path file = file_in(options.saved_scenes, name);
    if (file.stem().string().size() <= max_stem_bytes) return file;
    return Error{
        "name", "is longer than a file's name may be",
        "shorten it: at most " + std::to_string(max_stem_bytes) + " letters; signs such as / and : count as three"};
}

std::string name_of_scene(const fs::path& file) { return name_in(file); }

// Recoveries
// -----------------------------------------------------------------------------------------------------------

fs::path recovery_folder(const SessionOptions& options) { return options.saved_scenes / "autosave"; }

json recoveries_to_json(const SessionOptions& options) {
    json rows = json::array();
    for (const Recovery& recovery : list_recoveries(recovery_folder(options)))
        rows.push_back({{"name", autosave_prefix + recovery.file.stem().string()},
                        {"title", recovery.title},
                        {"kind", "recovery"},
                        {"modified", recovery.modified},
                        {"edits", recovery.edits},
                        {"scene", recovery.scene}});
    // Autosaves of versions of Embody before the journal.
    for (const ListedScene& scene : list_folder(recovery_folder(options), "recovery", autosave_prefix))
        rows.push_back({{"name", scene.name},
                        {"title", scene.title},
                        {"kind", scene.kind},
                        {"modified", scene.modified},
                        {"edits", nullptr},
                        {"scene", scene.name.substr(autosave_prefix.size())}});
    return rows;
}

Result<fs::path> recovery_file(const SessionOptions& options, const std::string& name) {
    if (is_recovery(name)) {
        const std::string stem = name.substr(autosave_prefix.size());
        for (const Recovery& recovery : list_recoveries(recovery_folder(options)))
            if (recovery.file.stem() == stem) return recovery.file;
        if (const fs::path file = file_in(recovery_folder(options), stem); is_file(file)) return file;
    }
    return Error{"name", "there is no recovered scene \"" + name + "\"", "scene.list names them all"};
}

Result<Recovered> read_recovery(const fs::path& file) {
    if (file.extension() != ".json") return read_journal(file);
    Result<Document> document = load_document(file);
    if (!document.ok()) return document.error();
    return Recovered{std::move(document).value(), name_in(file)};
}

bool is_recovery(const std::string& name) { return name.starts_with(autosave_prefix); }

// Versions
// -------------------------------------------------------------------------------------------------------------

namespace {

fs::path version_folder(const SessionOptions& options, const std::string& scene) {
    return options.saved_scenes / "versions" / encoded(scene);
}

}  // namespace

Result<fs::path> version_file(const SessionOptions& options, const std::string& scene, const std::string& version) {
    fs::path file = version_folder(options, scene) / (encoded(version) + ".json");
    if (version.empty() || file.stem().string().size() > max_stem_bytes)
        return Error{"version", "must be a name of 1 … " + std::to_string(max_stem_bytes) + " letters"};
    return file;
}

std::vector<ListedScene> list_versions(const SessionOptions& options, const std::string& scene) {
    return list_folder(version_folder(options, scene), "version", "");
}

// Scenes
// ---------------------------------------------------------------------------------------------------------------

json scenes_to_json(const SessionOptions& options) {
    json rows = json::array();
    const auto add = [&rows](const std::vector<ListedScene>& scenes) {
        for (const ListedScene& scene : scenes)
            rows.push_back({{"name", scene.name},
                            {"title", scene.title},
                            {"description", scene.description},
                            {"kind", scene.kind},
                            {"modified", scene.modified}});
    };
    add(list_folder(options.saved_scenes, "saved", ""));
    for (json& recovery : recoveries_to_json(options)) rows.push_back(std::move(recovery));
    add(list_folder(options.demo_scenes, "demo", ""));
    return rows;
}

Result<fs::path> find_scene(const SessionOptions& options, const std::string& name) {
    std::vector<fs::path> places;
    if (name.starts_with(demo_prefix)) {
        places = {file_in(options.demo_scenes, name.substr(demo_prefix.size()))};
    } else {
        places = {file_in(options.saved_scenes, name), file_in(options.demo_scenes, name)};
    }
    for (const fs::path& place : places)
        if (is_file(place)) return place;
    return Error{"name", "there is no scene \"" + name + "\"", "scene.list names them all"};
}

}  // namespace embody::scene
