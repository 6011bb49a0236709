// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "catalog/import/importer.h"
#include "database/model_schema.h"
#include "database/temporary_folder.h"
#include "folders.h"
#include "foundation/state_hash.h"
#include "interchange/compact/compact_geometry.h"

namespace embody::catalog {

inline const std::filesystem::path taxonomy_folder = source_folder() / "data/taxonomy";

inline void write_file(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
}

/// A box whose edge, in centimetres, is the length of the file's text: quick to prepare, and its size shows which
/// content was read.
inline Result<PreparedModel> prepare_box(const ImportItem& item) {
    std::ostringstream text;
    text << std::ifstream(item.path, std::ios::binary).rdbuf();
    const std::string bytes = text.str();
    if (bytes.find("broken") != std::string::npos) return Error{item.path, "is broken", {}};
    const float edge = static_cast<float>(bytes.size()) / 100;

    interchange::RawScene scene;
    interchange::RawMesh mesh;
    for (int c = 0; c < 8; ++c) {
        mesh.positions.push_back({c & 1 ? edge : 0.0f, c & 2 ? edge : 0.0f, c & 4 ? edge : 0.0f});
    }
    mesh.triangles = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};
    scene.meshes.push_back(mesh);
    auto compact = interchange::encode(scene);
    if (!compact) return compact.error();

    PreparedModel model;
    model.geometry = compact->bytes;
    model.thumbnail = {0x89, 'P', 'N', 'G'};
    model.hull_points = mesh.positions;
    model.facts.name = item.name;
    model.facts.folder = "folder";
    model.facts.material_names = {"oak"};
    attributes::GeometryFacts& facts = model.facts.geometry;
    facts.size = {edge, edge, edge};
    facts.closed = true;
    facts.volume = facts.hull_volume = edge * edge * edge;
    facts.volume_method = "test";
    facts.unit_inertia = Mat3::diagonal(Vec3{1, 1, 1} * (facts.volume * edge * edge / 6));
    facts.center_of_volume = {0, edge / 2, 0};
    facts.surface_area = 6 * edge * edge;
    facts.fitted_shape = "box";
    facts.fitted_dimensions = facts.size * 0.5;
    facts.fitted_pose.position = facts.center_of_volume;
    StateHash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    model.content_hash = hash.value();
    model.vertices = compact->vertices;
    model.triangles = compact->triangles;
    model.parts = compact->parts;
    model.quality = 3;
    return model;
}

/// Prepares in this process, in order.
inline Result<void> prepare_boxes(const std::vector<ImportItem>& items,
                                  const std::function<bool(std::size_t, Result<PreparedModel>)>& done) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!done(i, prepare_box(items[i]))) break;
    }
    return {};
}

/// A database and a folder of model files.
class ImportTest : public testing::Test {
protected:
    [[nodiscard]] std::filesystem::path database() const { return folder_ / "models.sqlite"; }
    [[nodiscard]] std::filesystem::path models() const { return folder_ / "models"; }
    void write_model(const std::string& name, const std::string& text) const { write_file(models() / name, text); }

    Result<ImportReport> import(const std::vector<std::filesystem::path>& paths, const ImportOptions& options = {},
                                const PrepareModels& prepare = prepare_boxes) const {
        auto taxonomy = attributes::Taxonomy::load(taxonomy_folder);
        if (!taxonomy) return taxonomy.error();
        auto connection = database::open_model_database(database());
        if (!connection) return connection.error();
        return Importer(**connection, **taxonomy, prepare).run(paths, options);
    }
    Result<ImportReport> import() const { return import({models()}); }

    /// The catalogue without its primitives.
    [[nodiscard]] std::unique_ptr<Catalog> open() const {
        auto catalog = Catalog::open(database(), taxonomy_folder);
        EXPECT_TRUE(catalog) << catalog.error().message();
        if (!catalog) return nullptr;
        for (const char* shape : {"box", "sphere", "capsule", "cylinder", "cone", "plane"}) {
            const auto model = (*catalog)->model(std::string("primitive:") + shape);
            EXPECT_TRUE(!model || (*catalog)->remove(model->id));
        }
        return std::move(*catalog);
    }
    [[nodiscard]] std::int64_t stored_models() const {
        auto connection = database::open_model_database(database());
        if (!connection) return -1;
        const auto count = database::ModelTable(**connection).count();
        return count ? *count : -1;
    }

    test::TemporaryFolder folder_;
};

}  // namespace embody::catalog
