// SPDX-License-Identifier: MIT
// One reader for all formats: they differ in a few options only
// (docs/decisions/0002-importers-and-compact-geometry.md).
#include <assimp/importerdesc.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/BaseImporter.h>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>
#include <new>
#include <span>
#include <sstream>
#include <string_view>

#include "interchange/assimp/assimp_materials.h"
#include "interchange/assimp/read_by_assimp.h"
#include "interchange/assimp/refusal.h"
#include "interchange/assimp/source_files.h"
#include "interchange/read_model.h"

namespace embody::interchange {
namespace {

constexpr std::size_t max_triangles = 20'000'000;
constexpr std::size_t max_nodes = 1'000'000;

// Those of read_model()'s formats that have no reader of their own.
constexpr std::array<std::string_view, 6> our_extensions{"obj", "stl", "dae", "gltf", "glb", "ac"};

/// Removes all loaders except those of the formats that we read, so that a file cannot select another by its first
/// bytes.
void keep_our_formats(Assimp::Importer& importer) {
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const aiImporterDesc* description = importer.GetImporterInfo(i);
        std::istringstream extensions(description == nullptr ? "" : description->mFileExtensions);
        bool ours = false;
        for (std::string extension; extensions >> extension;) {
            ours |= std::ranges::find(our_extensions, extension) != our_extensions.end();
        }
        if (ours) continue;
        const std::unique_ptr<Assimp::BaseImporter> loader(importer.GetImporter(i));
        importer.UnregisterLoader(loader.get());
    }
}

MaterialReading material_reading_of(const std::string& extension, std::span<const std::uint8_t> bytes) {
    MaterialReading reading;
    if (extension == ".gltf" || extension == ".glb") {
        reading.linear_colors = true;
        reading.texture_replaces_color = reading.double_sided = false;
    }
    if (extension == ".obj") {
        const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        reading.names_stand_for_materials = text.find("mtllib") == std::string_view::npos;
    }
    return reading;
}

/// `read` placed by `to_scene`, its polygons as triangles; points and lines are skipped.
Result<RawMesh> mesh_of(const aiMesh& read, const aiMatrix4x4& to_scene) {
    RawMesh mesh;
    mesh.name = read.mName.C_Str();
    mesh.material = static_cast<int>(read.mMaterialIndex);
    const aiMatrix3x3 linear(to_scene);
    const aiMatrix3x3 for_normals = aiMatrix3x3(linear).Inverse().Transpose();
    const bool mirrored = linear.Determinant() < 0;

    // Positions and normals in the scene's frame.
    mesh.positions.reserve(read.mNumVertices);
    for (unsigned i = 0; i < read.mNumVertices; ++i) {
        const aiVector3D p = to_scene * read.mVertices[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            return Error{"vertex " + std::to_string(i), "has a coordinate that is not a finite number"};
        }
        mesh.positions.push_back({p.x, p.y, p.z});
    }
    for (unsigned i = 0; read.HasNormals() && i < read.mNumVertices; ++i) {
        aiVector3D n = for_normals * read.mNormals[i];
        n.NormalizeSafe();
        if (!std::isfinite(n.x) || !std::isfinite(n.y) || !std::isfinite(n.z)) n = {0, 1, 0};
        mesh.normals.push_back({n.x, n.y, n.z});
    }

    // assimp's texture origin is the lower left.
    for (unsigned i = 0; read.HasTextureCoords(0) && i < read.mNumVertices; ++i) {
        const aiVector3D uv = read.mTextureCoords[0][i];
        const bool usable = std::isfinite(uv.x) && std::isfinite(uv.y);
        mesh.texture_coordinates.push_back(usable ? std::array{uv.x, 1 - uv.y} : std::array{0.0f, 0.0f});
    }

    mesh.triangles.reserve(read.mNumFaces);
    for (unsigned i = 0; i < read.mNumFaces; ++i) {
        const aiFace& face = read.mFaces[i];
        if (face.mNumIndices != 3) continue;
        std::array<std::uint32_t, 3> triangle{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
        if (std::max({triangle[0], triangle[1], triangle[2]}) >= read.mNumVertices) {
            return Error{"face " + std::to_string(i), "refers to a vertex that does not exist"};
        }
        if (mirrored) std::swap(triangle[1], triangle[2]);
        mesh.triangles.push_back(triangle);
    }
    return mesh;
}

/// Walks the nodes and adds each mesh at its node's place.
Result<void> add_meshes(const aiScene& read, RawScene& scene) {
    struct Visit {
        const aiNode* node;
        aiMatrix4x4 to_scene;
    };
    std::vector<Visit> open{{read.mRootNode, read.mRootNode->mTransformation}};
    std::size_t nodes = 0, triangles = 0;
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        if (++nodes > max_nodes) return Error{"nodes", "are more than " + std::to_string(max_nodes)};
        for (unsigned i = 0; i < visit.node->mNumMeshes; ++i) {
            if (visit.node->mMeshes[i] >= read.mNumMeshes) return Error{visit.node->mName.C_Str(), "refers to no mesh"};
            auto mesh = mesh_of(*read.mMeshes[visit.node->mMeshes[i]], visit.to_scene);
            if (!mesh) return mesh.error();
            triangles += mesh->triangles.size();
            if (triangles > max_triangles) return Error{"triangles", "are more than " + std::to_string(max_triangles)};
            if (mesh->material >= static_cast<int>(scene.materials.size())) mesh->material = -1;
            if (!mesh->triangles.empty()) scene.meshes.push_back(std::move(*mesh));
        }
        // Last child first, so that meshes come in the file's order.
        for (unsigned i = visit.node->mNumChildren; i-- > 0;) {
            const aiNode* child = visit.node->mChildren[i];
            open.push_back({child, visit.to_scene * child->mTransformation});
        }
    }
    return {};
}

}  // namespace

Result<RawScene> read_by_assimp(const FileSource& source, const std::string& path) {
    const std::string where = source.describe(path);
    // Read before the library reads it, since the library would not say why it cannot.
    const auto bytes = source.read(path);
    if (!bytes) return Error{where, bytes.error().why, bytes.error().remedy};
    if (bytes->empty()) return Error{where, "is empty"};
    Assimp::Importer importer;
    keep_our_formats(importer);
    importer.SetIOHandler(new_source_files(source));  // the importer owns and deletes it
    // No bones, animations, cameras or lights: what is not requested cannot fail.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, aiComponent_ANIMATIONS | aiComponent_BONEWEIGHTS |
                                                            aiComponent_CAMERAS | aiComponent_LIGHTS |
                                                            aiComponent_TANGENTS_AND_BITANGENTS);
    // AC3D's subdivision grows fourfold a level, and the level is the file's: the surface is taken as it was drawn.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_EVAL_SUBDIVISION, false);
    const aiScene* read = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_RemoveComponent);
    if (read == nullptr || read->mRootNode == nullptr) {
        // assimp catches errors of memory, and reports no more than their name.
        const std::string told = importer.GetErrorString();
        if (told == "std::bad_alloc") throw std::bad_alloc();
        return Error{where, reason_of_refusal(source, path, *bytes, told)};
    }

    RawScene scene;
    add_materials(*read, source, path, material_reading_of(extension_of(path), *bytes), scene);
    if (const auto added = add_meshes(*read, scene); !added)
        return Error{where + ": " + added.error().where, added.error().why};
    if (scene.meshes.empty()) return without_triangles(where);
    return scene;
}

}  // namespace embody::interchange
