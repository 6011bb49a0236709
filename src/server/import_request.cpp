// SPDX-License-Identifier: MIT
#include "server/import_request.h"

#include <nlohmann/json.hpp>
#include <string>

#include "catalog/catalog.h"
#include "interchange/sweethome/sweethome_home.h"
#include "scene/file/scene_file.h"
#include "scene/home/home_document.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json report_json(const catalog::ImportReport& report) {
    json failures = json::array();
    for (const catalog::ImportFailure& failure : report.failures)
        failures.push_back({{"path", fs::path(failure.path).filename().string()}, {"why", failure.error.why}});
    return {{"added", report.added},
            {"updated", report.updated},
            {"unchanged", report.unchanged},
            {"failures", std::move(failures)},
            {"keys", report.keys}};
}

}  // namespace

ImportRequests::ImportRequests(fs::path database, fs::path taxonomy_folder)
    : database_(std::move(database)), taxonomy_folder_(std::move(taxonomy_folder)) {}

bool ImportRequests::is_import(const HttpRequest& request) {
    return request.method == "POST" && decoded_path(request.target) == "/import";
}

Result<std::string> ImportRequests::file_name(const HttpRequest& request) {
    const std::string name = fs::path(query_parameter(request.target, "name")).filename().string();
    if (!name.empty() && name != "." && name != "..") return name;
    return Error{"name", "must be the file's name", "POST /import?name=chair.glb with the file as body"};
}

void ImportRequests::start(std::shared_ptr<Upload> upload, std::function<void(HttpResponse)> respond) {
    ++uploads_;
    queue_.post([this, upload = std::move(upload), respond = std::move(respond)]() mutable {
        --uploads_;
        // An exception of a library (memory, files) fails this import and nothing else.
        HttpResponse response;
        try {
            response = import(*upload);
        } catch (const std::exception& thrown) {
            response = error_response(500, "import", std::string("failed: ") + thrown.what());
        }
        // The upload is removed before the client hears that the import is done, so that its next upload finds room.
        upload.reset();
        respond(std::move(response));
    });
}

void ImportRequests::run_between_uploads(std::function<bool()> work) {
    queue_.post([this, work = std::move(work)]() mutable {
        if (work()) run_between_uploads(std::move(work));
    });
}

void ImportRequests::request_stop() {
    stop_ = true;
    queue_.request_stop();
}

HttpResponse ImportRequests::import(const Upload& upload) const {
    const std::string name = upload.file().filename().string();
    auto catalog = catalog::Catalog::open(database_, taxonomy_folder_);
    if (!catalog) return error_response(500, "database", catalog.error().message());
    catalog::ImportOptions options;
    options.progress = [this](const catalog::ImportProgress&) { return !stop_; };
    auto report = (*catalog)->import({upload.file()}, options);
    if (!report) return error_response(422, name, report.error().why, report.error().remedy);
    HttpResponse response;
    json answer = report_json(*report);
    if (interchange::is_sweethome_home(upload.file())) {
        // Its furniture is in the database now; the client opens its plan.
        const auto home = interchange::read_sweethome_home(upload.file());
        if (!home) return error_response(422, name, home.error().why, home.error().remedy);
        const auto made = scene::document_of_home(*home, upload.file().stem().string(),
                                                  [&](const std::string& key) { return (*catalog)->model(key).ok(); });
        answer["scene"] = scene::document_to_json(made.document);
        answer["notes"] = made.notes;
    }
    response.body = answer.dump(-1, ' ', false, json::error_handler_t::replace);
    if (!answer.contains("scene") && report->added + report->updated + report->unchanged == 0) response.status = 422;
    return response;
}

}  // namespace embody::server
