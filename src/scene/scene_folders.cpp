// SPDX-License-Identifier: MIT
#include "scene/scene_folders.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

namespace embody::scene {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t longest_name = 100;
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

// Stops reading when the title is known: the writer puts it at the top, and scenes can be large.
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

// The scenes of a folder by name; a folder that is not there has none.
std::vector<ListedScene> list_folder(const fs::path& folder, const std::string& kind, const std::string& prefix) {
    std::vector<ListedScene> scenes;
    std::error_code problem;
    for (fs::directory_iterator entry(folder, problem), end; !problem && entry != end; entry.increment(problem)) {
        std::error_code unreadable;
        if (entry->path().extension() != ".json" || !entry->is_regular_file(unreadable)) continue;
        const auto time = entry->last_write_time(unreadable);
        scenes.push_back({prefix + entry->path().stem().string(), title_of(entry->path()), kind,
                          unreadable ? std::string() : utc_text(time)});
    }
    std::sort(scenes.begin(), scenes.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return scenes;
}

}  // namespace

std::string file_name_of(const std::string& name) {
    std::string out;
    for (const char c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool is_plain =
            std::isalnum(byte) || byte >= 0x80 || c == ' ' || c == '-' || c == '_' || c == '(' || c == ')';
        // A dot is fine but at the front, where it hides the file or climbs out of the folder.
        const bool is_dot = c == '.' && !out.empty() && out.back() != '.';
        out += is_plain || is_dot ? c : '_';
    }
    while (!out.empty() && (out.back() == ' ' || out.back() == '.')) out.pop_back();
    out.erase(0, out.find_first_not_of(' ') == std::string::npos ? out.size() : out.find_first_not_of(' '));
    if (out.size() > longest_name) {
        out.resize(longest_name);
        // No half of a UTF-8 character at the end.
        while (!out.empty() && (static_cast<unsigned char>(out.back()) & 0xC0) == 0x80) out.pop_back();
        if (!out.empty() && static_cast<unsigned char>(out.back()) >= 0x80) out.pop_back();
    }
    return out.empty() ? "Untitled" : out;
}

fs::path saved_file(const SessionOptions& options, const std::string& name) {
    return options.saved_scenes / (file_name_of(name) + ".json");
}

fs::path autosave_file(const SessionOptions& options, const std::string& name) {
    return options.saved_scenes / "autosave" / (file_name_of(name) + ".json");
}

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
        places = {options.demo_scenes / (file_name_of(after(demo_prefix)) + ".json")};
    } else {
        places = {saved_file(options, name), options.demo_scenes / (file_name_of(name) + ".json")};
    }
    for (const fs::path& place : places) {
        std::error_code problem;
        if (fs::is_regular_file(place, problem)) return place;
    }
    return Error{"name", "there is no scene \"" + name + "\"", "scene.list names them all"};
}

}  // namespace embody::scene
