// SPDX-License-Identifier: MIT
#include "server/import_request.h"

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "catalog/catalog.h"

namespace embody::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// The file name without any folder, or empty where it is none.
std::string plain_file_name(const std::string& name) {
    const std::string file = fs::path(name).filename().string();
    return file == "." || file == ".." ? std::string() : file;
}

/// A folder of its own for one upload; gone with the object.
class UploadFolder {
public:
    UploadFolder() {
        std::string pattern = (fs::temp_directory_path() / "embody-upload-XXXXXX").string();
        if (const char* made = mkdtemp(pattern.data())) path_ = made;
    }
    ~UploadFolder() {
        std::error_code ignored;
        if (!path_.empty()) fs::remove_all(path_, ignored);
    }
    UploadFolder(const UploadFolder&) = delete;
    UploadFolder& operator=(const UploadFolder&) = delete;
    [[nodiscard]] const fs::path& path() const { return path_; }

private:
    fs::path path_;
};

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
    : database_(std::move(database)), taxonomy_folder_(std::move(taxonomy_folder)), thread_([this] { work(); }) {}

ImportRequests::~ImportRequests() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    thread_.join();
    for (const Job& job : jobs_) job.respond(error_response(503, "import", "the server is stopping"));
}

bool ImportRequests::is_import(const HttpRequest& request) {
    return request.method == "POST" && decoded_path(request.target) == "/import";
}

void ImportRequests::start(HttpRequest request, std::function<void(HttpResponse)> respond) {
    {
        const std::lock_guard lock(mutex_);
        jobs_.push_back({std::move(request), std::move(respond)});
    }
    changed_.notify_all();
}

void ImportRequests::work() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return stop_ || !jobs_.empty(); });
            if (stop_) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        // What the libraries throw (memory, files) fails this import and nothing else.
        try {
            job.respond(import(job.request));
        } catch (const std::exception& thrown) {
            job.respond(error_response(500, "import", std::string("failed: ") + thrown.what()));
        }
    }
}

HttpResponse ImportRequests::import(const HttpRequest& request) const {
    const std::string name = plain_file_name(query_parameter(request.target, "name"));
    if (name.empty())
        return error_response(400, "name", "must be the file's name",
                              "POST /import?name=chair.glb with the file as body");
    // The importers read files, so the upload becomes one for a moment.
    const UploadFolder folder;
    const fs::path file = folder.path() / name;
    std::ofstream stream(file, std::ios::binary);
    stream << request.body;
    stream.close();
    if (folder.path().empty() || !stream)
        return error_response(507, name, "cannot be kept for the import", "is the disk full?");
    auto catalog = catalog::Catalog::open(database_, taxonomy_folder_);
    if (!catalog) return error_response(500, "database", catalog.error().message());
    catalog::ImportOptions options;
    options.progress = [this](const catalog::ImportProgress&) {
        const std::lock_guard lock(mutex_);
        return !stop_;
    };
    auto report = (*catalog)->import({file}, options);
    if (!report) return error_response(422, name, report.error().why, report.error().remedy);
    HttpResponse response;
    response.body = report_json(*report).dump(-1, ' ', false, json::error_handler_t::replace);
    if (report->added + report->updated + report->unchanged == 0) response.status = 422;
    return response;
}

}  // namespace embody::server
