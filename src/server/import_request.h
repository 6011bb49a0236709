// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "foundation/result.h"
#include "server/http.h"
#include "server/upload_store.h"
#include "server/work_queue.h"

namespace embody::server {

/// Imports of uploaded files (POST /import?name=…), one after the other on a thread of their own.
class ImportRequests {
public:
    ImportRequests(std::filesystem::path database, std::filesystem::path taxonomy_folder);

    static bool is_import(const HttpRequest& request);
    /// The name that the request gives its file, without any folder; the error is for who asked.
    static Result<std::string> file_name(const HttpRequest& request);
    /// `respond` is called once, on the import thread, unless the server stops before.
    void start(std::shared_ptr<Upload> upload, std::function<void(HttpResponse)> respond);

    /// The import in hand ends after the model that is being read; those that wait are not begun.
    void request_stop();
    bool wait_ended(std::chrono::steady_clock::time_point until) { return queue_.wait_ended(until); }

private:
    [[nodiscard]] HttpResponse import(const Upload& upload) const;

    std::filesystem::path database_, taxonomy_folder_;
    std::atomic<bool> stop_ = false;
    WorkQueue queue_{1};  ///< last: it ends before what its work uses
};

}  // namespace embody::server
