// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "catalog/catalog.h"
#include "scene/document/document.h"
#include "server/http.h"

namespace embody::server {

/// Answers all HTTP requests (docs/protocol.md) but imports, which take long and run on a thread of their own.
/// Thread-safe.
class Routes {
public:
    /// `catalogs`: the same database, opened once for each thread that answers. `studio_folder`: the built front-end.
    /// `scene_title`: title of the open document; may be called from any thread.
    Routes(std::vector<std::unique_ptr<catalog::Catalog>> catalogs, std::filesystem::path studio_folder,
           std::function<std::string()> scene_title);

    /// Whether the request is for the Studio's own page and files, not for data of the scene or the database.
    static bool is_page(const HttpRequest& request);
    /// Whether the request is for the open document, which answer() does not have.
    static bool is_scene(const HttpRequest& request);

    /// Never fails: an error becomes a response with its status.
    HttpResponse answer(const HttpRequest& request) const;
    HttpResponse answer_scene(const scene::Document& document) const;

private:
    /// Reserves a catalogue while the object lives; there are as many catalogues as threads that answer.
    class Loan;
    HttpResponse answer_health() const;
    HttpResponse answer_model(const HttpRequest& request, const std::string& path) const;
    HttpResponse answer_file(const std::string& path) const;

    mutable std::mutex mutex_;  ///< guards the list
    mutable std::vector<std::unique_ptr<catalog::Catalog>> idle_catalogs_;
    std::filesystem::path studio_folder_;
    std::function<std::string()> scene_title_;
};

}  // namespace embody::server
