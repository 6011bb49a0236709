// SPDX-License-Identifier: MIT
#include "scene/session/scene_folders.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "foundation/state_hash.h"

namespace embody::scene {

namespace fs = std::filesystem;

namespace {

/// Maximum length of a file's name without ".json", bytes: file systems allow 255, and a draft's name is longer.
constexpr std::size_t max_stem_bytes = 200;
/// Number of bytes of a longer title in the name of its autosave.
constexpr std::size_t kept_of_long_title = 150;
const std::string autosave_prefix = "autosave/";
const std::string demo_prefix = "demo/";

std::string utc_text(fs::file_time_type time) {
    const auto system = std::chrono::time_point_cast<std::chrono::seconds>(time - fs::file_time_type::clock::now() +
                                                                           std::chrono::system_clock::now());
    const std::time_t seconds = std::chrono::system_clock::to_time_t(system);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

// Whether a file's name may contain the byte in every file system and shell.
bool is_plain(unsigned char byte) {
    return std::isalnum(byte) != 0 || byte >= 0x80 ||
           std::string_view(" -_().").find(static_cast<char>(byte)) != std::string_view::npos;
}

// A name as a file's stem, the inverse of decoded(): bytes that are not plain become "%" and two digits, and so does a
// dot at the front, which would hide the file. Different names have different stems.
std::string encoded(const std::string& name) {
    static constexpr char digits[] = "0123456789ABCDEF";
    std::string stem;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        if (is_plain(byte) && !(c == '.' && stem.empty())) {
            stem += c;
        } else {
            stem += {'%', digits[byte >> 4], digits[byte & 15]};
        }
    }
    return stem;
}

std::string decoded(const std::string& stem) {
    std::string name;
    for (std::size_t i = 0; i < stem.size(); ++i) {
        unsigned code = 0;
        const char* begin = stem.data() + i + 1;
        const bool is_code =
            stem[i] == '%' && i + 2 < stem.size() && std::from_chars(begin, begin + 2, code, 16).ptr == begin + 2;
        name += is_code ? static_cast<char>(code) : stem[i];
        if (is_code) i += 2;
    }
    return name;
}

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

// Stops reading at the title: the writer puts it at the top, and scenes can be large.
class TitleFinder : public nlohmann::json_sax<nlohmann::json> {
public:
    std::string title;

    bool null() override { return true; }
    bool boolean(bool) override { return true; }
    bool number_integer(number_integer_t) override { return true; }
    bool number_unsigned(number_unsigned_t) override { return true; }
    bool number_float(number_float_t, const string_t&) override { return true; }
    bool string(string_t& value) override {
        if (depth_ != 1 || !is_title_) return true;
        title = value;
        return false;
    }
    bool binary(binary_t&) override { return true; }
    bool start_object(std::size_t) override { return ++depth_ < 64; }
    bool key(string_t& value) override {
        is_title_ = value == "title";
        return true;
    }
    bool end_object() override { return --depth_ >= 0; }
    bool start_array(std::size_t) override { return ++depth_ < 64; }
    bool end_array() override { return --depth_ >= 0; }
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

private:
    int depth_ = 0;
    bool is_title_ = false;
};

std::string title_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    TitleFinder finder;
    nlohmann::json::sax_parse(in, &finder);
    return finder.title.empty() ? file.stem().string() : finder.title;
}

// The scenes of a folder by name; none for a folder that does not exist.
std::vector<ListedScene> list_folder(const fs::path& folder, const std::string& kind, const std::string& prefix) {
    std::vector<ListedScene> scenes;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        std::error_code unreadable;
        if (entry->path().extension() != ".json" || !entry->is_regular_file(unreadable)) continue;
        const auto time = entry->last_write_time(unreadable);
        scenes.push_back({prefix + name_in(entry->path()), title_of(entry->path()), kind,
                          unreadable ? std::string() : utc_text(time)});
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

fs::path autosave_file(const SessionOptions& options, const std::string& name) {
    const fs::path folder = options.saved_scenes / "autosave";
    fs::path file = file_in(folder, name);
    const std::string stem = file.stem().string();
    if (stem.size() <= max_stem_bytes) return file;
    // A title may be of any length: the stem has its beginning, up to a whole character, and a part that tells it from
    // others. encoded() never makes a "%~".
    std::size_t kept = kept_of_long_title;
    while ((static_cast<unsigned char>(stem[kept]) & 0xC0) == 0x80) --kept;
    StateHash hash;
    hash.add_bytes(stem.data(), stem.size());
    return folder / (stem.substr(0, kept) + "%~" + std::to_string(hash.value()) + ".json");
}

std::string name_of_scene(const fs::path& file) { return name_in(file); }

std::vector<ListedScene> list_scenes(const SessionOptions& options) {
    std::vector<ListedScene> scenes = list_folder(options.saved_scenes, "saved", "");
    for (ListedScene& scene : list_folder(options.saved_scenes / "autosave", "recovery", autosave_prefix))
        scenes.push_back(std::move(scene));
    for (ListedScene& scene : list_folder(options.demo_scenes, "demo", "")) scenes.push_back(std::move(scene));
    return scenes;
}

Result<fs::path> find_scene(const SessionOptions& options, const std::string& name) {
    const auto after = [&name](const std::string& prefix) { return name.substr(prefix.size()); };
    std::vector<fs::path> places;
    if (name.starts_with(autosave_prefix)) {
        places = {autosave_file(options, after(autosave_prefix))};
    } else if (name.starts_with(demo_prefix)) {
        places = {file_in(options.demo_scenes, after(demo_prefix))};
    } else {
        places = {file_in(options.saved_scenes, name), file_in(options.demo_scenes, name)};
    }
    for (const fs::path& place : places)
        if (is_file(place)) return place;
    return Error{"name", "there is no scene \"" + name + "\"", "scene.list names them all"};
}

}  // namespace embody::scene
