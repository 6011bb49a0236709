// SPDX-License-Identifier: MIT
#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

#include "server/http.h"

namespace embody::server {

/// Imports of uploaded files (POST /import?name=…), one after the other on a thread of their own.
class ImportRequests {
public:
    ImportRequests(std::filesystem::path database, std::filesystem::path taxonomy_folder);
    /// Ends the import after the model in hand; the waiting ones are answered with an error.
    ~ImportRequests();

    static bool is_import(const HttpRequest& request);
    /// `respond` is called once, on the import thread.
    void start(HttpRequest request, std::function<void(HttpResponse)> respond);

private:
    struct Job {
        HttpRequest request;
        std::function<void(HttpResponse)> respond;
    };
    void work();
    [[nodiscard]] HttpResponse import(const HttpRequest& request) const;

    std::filesystem::path database_, taxonomy_folder_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Job> jobs_;
    bool stop_ = false;
    std::thread thread_;
};

}  // namespace embody::server
