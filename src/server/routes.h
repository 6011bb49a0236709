// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "catalog/catalog.h"
#include "server/http.h"

namespace embody::server {

/// Answers of the HTTP face (docs/protocol.md) but imports, which take long and have a thread of their own.
class Routes {
public:
    /// `studio_folder`: the built front-end. `scene_json`, `scene_title`: of the open document.
    Routes(std::unique_ptr<catalog::Catalog> catalog, std::filesystem::path studio_folder,
           std::function<std::string()> scene_json, std::function<std::string()> scene_title);

    /// Never fails: what is wrong becomes a response with its status.
    HttpResponse answer(const HttpRequest& request) const;

private:
    HttpResponse answer_model(const HttpRequest& request, const std::string& path) const;
    HttpResponse answer_file(const std::string& path) const;

    std::unique_ptr<catalog::Catalog> catalog_;
    std::filesystem::path studio_folder_;
    std::function<std::string()> scene_json_, scene_title_;
};

}  // namespace embody::server
