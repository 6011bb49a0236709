// SPDX-License-Identifier: MIT
#include "server/routes.h"

#include <charconv>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "foundation/version.h"
#include "scene/file/scene_file.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;

const std::map<std::string, std::string>& content_types() {
    static const std::map<std::string, std::string> types = {
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".mjs", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".jpg", "image/jpeg"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".wasm", "application/wasm"},
        {".glb", "model/gltf-binary"},
        {".hdr", "application/octet-stream"},
        {".txt", "text/plain; charset=utf-8"},
    };
    return types;
}

bool is_read(const HttpRequest& request) { return request.method == "GET" || request.method == "HEAD"; }

/// "/models/17/geometry.glb" → 17 and "geometry.glb"; id 0 where the path is no file of a model.
struct ModelPath {
    std::int64_t id = 0;
    std::string part;
};
ModelPath split_model_path(const std::string& path) {
    static const std::string prefix = "/models/";
    const std::size_t slash = path.find('/', prefix.size());
    if (slash == std::string::npos) return {};
    ModelPath split;
    const char* const end = path.data() + slash;
    const auto [stop, error] = std::from_chars(path.data() + prefix.size(), end, split.id);
    if (error != std::errc{} || stop != end || split.id <= 0) return {};
    split.part = path.substr(slash + 1);
    return split;
}

}  // namespace

class Routes::Loan {
public:
    explicit Loan(const Routes& routes) : routes_(routes) {
        const std::lock_guard lock(routes.mutex_);
        catalog_ = std::move(routes.idle_catalogs_.back());
        routes.idle_catalogs_.pop_back();
    }
    ~Loan() {
        const std::lock_guard lock(routes_.mutex_);
        routes_.idle_catalogs_.push_back(std::move(catalog_));
    }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;
    const catalog::Catalog* operator->() const { return catalog_.get(); }

private:
    const Routes& routes_;
    std::unique_ptr<catalog::Catalog> catalog_;
};

Routes::Routes(std::vector<std::unique_ptr<catalog::Catalog>> catalogs, fs::path studio_folder,
               std::function<std::string()> scene_title)
    : idle_catalogs_(std::move(catalogs)),
      studio_folder_(std::move(studio_folder)),
      scene_title_(std::move(scene_title)) {}

bool Routes::is_page(const HttpRequest& request) {
    const std::string path = decoded_path(request.target);
    return is_read(request) && !path.starts_with("/api/") && !path.starts_with("/models/") && path != "/scene.json";
}

bool Routes::is_scene(const HttpRequest& request) {
    return is_read(request) && decoded_path(request.target) == "/scene.json";
}

HttpResponse Routes::answer(const HttpRequest& request) const {
    if (!is_read(request)) return error_response(405, request.target, "only GET is answered here");
    const std::string path = decoded_path(request.target);
    if (path.empty() || path.front() != '/') return error_response(400, request.target, "is not a path");
    if (path == "/api/health") return answer_health();
    if (path.starts_with("/models/")) return answer_model(request, path);
    return answer_file(path);
}

HttpResponse Routes::answer_scene(const scene::Document& document) const {
    HttpResponse response;
    response.body = scene::document_to_json(document).dump(2, ' ', false, nlohmann::json::error_handler_t::replace);
    response.headers["Content-Disposition"] = "attachment; filename=\"scene.json\"";
    return response;
}

HttpResponse Routes::answer_health() const {
    const Loan catalog(*this);
    const nlohmann::json body = {
        {"name", "embody"}, {"version", version_text}, {"scene", scene_title_()}, {"models", catalog->model_count()}};
    HttpResponse response;
    response.body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    return response;
}

HttpResponse Routes::answer_model(const HttpRequest& request, const std::string& path) const {
    const ModelPath model = split_model_path(path);
    if (model.id == 0 || (model.part != "thumbnail.png" && model.part != "geometry.glb"))
        return error_response(404, path, "there is no such page", "see docs/protocol.md for the addresses");
    const bool thumbnail = model.part == "thumbnail.png";
    const Loan catalog(*this);
    auto bytes = thumbnail ? catalog->thumbnail(model.id) : catalog->geometry_glb(model.id);
    if (!bytes) return error_response(404, path, bytes.error().message());
    HttpResponse response;
    response.content_type = thumbnail ? "image/png" : "model/gltf-binary";
    response.body.assign(bytes->begin(), bytes->end());
    // With the content's hash in the address, the content at that address never changes.
    const bool versioned = !query_parameter(request.target, "v").empty();
    response.headers["Cache-Control"] = versioned ? "public, max-age=31536000, immutable" : "no-cache";
    return response;
}

HttpResponse Routes::answer_file(const std::string& path) const {
    // Resolves links and dots, then checks that the file lies inside the front-end's folder.
    std::error_code error;
    const fs::path root = fs::weakly_canonical(studio_folder_, error);
    const fs::path file = fs::weakly_canonical(root / (path == "/" ? "index.html" : path.substr(1)), error);
    const fs::path inside = file.lexically_relative(root);
    if (inside.empty() || *inside.begin() == "..") return error_response(404, path, "there is no such page");
    std::ifstream stream(file, std::ios::binary);
    if (!fs::is_regular_file(file, error) || !stream) {
        if (path == "/")
            return error_response(503, "the Studio", "is not built: " + file.string() + " is missing",
                                  "start with ./run, or: cd studio && npm ci && npm run build");
        return error_response(404, path, "there is no such page");
    }
    HttpResponse response;
    response.body.assign(std::istreambuf_iterator<char>(stream), {});
    const auto type = content_types().find(file.extension().string());
    response.content_type = type == content_types().end() ? "application/octet-stream" : type->second;
    // The bundler puts a hash in the names below assets/.
    response.headers["Cache-Control"] =
        path.starts_with("/assets/") ? "public, max-age=31536000, immutable" : "no-cache";
    return response;
}

}  // namespace embody::server
