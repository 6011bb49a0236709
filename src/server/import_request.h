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

/// Imports of uploaded files (POST /import?name=…), one after the other on one thread, and on the same thread what is
/// done while no upload waits.
class ImportRequests {
public:
    ImportRequests(std::filesystem::path database, std::filesystem::path taxonomy_folder);

    static bool is_import(const HttpRequest& request);
    /// The file's name from the request, without any folder; the error is for the client.
    static Result<std::string> file_name(const HttpRequest& request);
    /// `respond` is called once, on the import thread, unless the server stops before.
    void start(std::shared_ptr<Upload> upload, std::function<void(HttpResponse)> respond);

    /// Runs `work` while no upload waits, and again as long as it returns true. It asks must_give_way() often, and then
    /// returns soon.
    void run_between_uploads(std::function<bool()> work);
    /// Whether an upload waits, or the server ends.
    [[nodiscard]] bool must_give_way() const { return stop_ || uploads_ > 0; }
    [[nodiscard]] bool stops() const { return stop_; }

    /// The current import ends after the model that is being read; imports that wait are not started.
    void request_stop();
    bool wait_ended(std::chrono::steady_clock::time_point until) { return queue_.wait_ended(until); }

private:
    [[nodiscard]] HttpResponse import(const Upload& upload) const;

    std::filesystem::path database_, taxonomy_folder_;
    std::atomic<bool> stop_ = false;
    std::atomic<int> uploads_ = 0;  ///< that wait for their import
    WorkQueue queue_{1};            ///< last: its threads end before the members they use are destroyed
};

}  // namespace embody::server
