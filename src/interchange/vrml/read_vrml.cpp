// SPDX-License-Identifier: MIT
// Language: ISO/IEC 14772-1:1997 (VRML97). The one place that sees Coin; docs/decisions/0011-vrml.md says why Coin.
#include "interchange/vrml/read_vrml.h"

#ifdef EMBODY_HAS_COIN

#include <Inventor/SbString.h>
#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/SoPath.h>
#include <Inventor/SoPrimitiveVertex.h>
#include <Inventor/VRMLnodes/SoVRMLAudioClip.h>
#include <Inventor/VRMLnodes/SoVRMLBox.h>
#include <Inventor/VRMLnodes/SoVRMLCone.h>
#include <Inventor/VRMLnodes/SoVRMLCylinder.h>
#include <Inventor/VRMLnodes/SoVRMLElevationGrid.h>
#include <Inventor/VRMLnodes/SoVRMLExtrusion.h>
#include <Inventor/VRMLnodes/SoVRMLImageTexture.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/VRMLnodes/SoVRMLMaterial.h>
#include <Inventor/VRMLnodes/SoVRMLShape.h>
#include <Inventor/VRMLnodes/SoVRMLSphere.h>
#include <Inventor/actions/SoCallbackAction.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoMemoryError.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/fields/SoMField.h>
#include <Inventor/misc/SoProto.h>
#include <Inventor/nodes/SoBumpMap.h>
#include <Inventor/nodes/SoFile.h>
#include <Inventor/nodes/SoGroup.h>
#include <Inventor/nodes/SoImage.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoShape.h>
#include <Inventor/nodes/SoTexture2.h>
#include <Inventor/nodes/SoTexture3.h>
#include <Inventor/nodes/SoTextureCubeMap.h>
#include <Inventor/nodes/SoWWWInline.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <string_view>
#include <tuple>

#include "interchange/one_line.h"
#include "interchange/screen_color.h"
#include "interchange/texture_reader.h"

namespace embody::interchange {
namespace {

constexpr std::size_t max_triangles = 20'000'000;
constexpr std::size_t max_nodes = 1'000'000;
constexpr std::size_t max_materials = 1'000;
constexpr std::size_t max_depth = 250;  // nodes in nodes; Coin reads and walks them by recursion

// The first message of Coin since the last reset: it reports through global handlers.
std::string first_complaint;  // NOLINT(cppcoreguidelines-avoid-non-const-global-variables)

void note_complaint(const SoError* error, void*) {
    if (first_complaint.empty()) first_complaint = one_line(error->getDebugString().getString());
}

void leave_inline_out(const SbString&, void*, SoVRMLInline*) {}
SoProto* leave_prototype_out(SoInput*, const SbString*, const int, void*) { return nullptr; }
void* make_group() { return new SoGroup; }

/// A texture that only has its url: Coin's own opens the file while it is read, whatever setDelayFetchURL says.
class UnfetchedTexture final : public SoVRMLImageTexture {
public:
    UnfetchedTexture() { url.enableNotify(FALSE); }
    static void* make() { return new UnfetchedTexture; }

private:
    SbBool readInstance(SoInput* input, unsigned short flags) override {
        return SoVRMLTexture::readInstance(input, flags);
    }
};

/// A sound that only has its url.
class UnfetchedSound final : public SoVRMLAudioClip {
public:
    UnfetchedSound() { url.enableNotify(FALSE); }
    static void* make() { return new UnfetchedSound; }
};

/// Called once a process; after this nothing in the file opens other files.
void start_coin() {
    static const bool started = [] {
        SoDB::init();
        SoError::setHandlerCallback(note_complaint, nullptr);
        SoReadError::setHandlerCallback(note_complaint, nullptr);
        SoMemoryError::setHandlerCallback(note_complaint, nullptr);
        SoDebugError::setHandlerCallback(note_complaint, nullptr);
        SoVRMLInline::setReadAsSoFile(FALSE);
        SoVRMLInline::setFetchURLCallBack(leave_inline_out, nullptr);
        SoProto::setFetchExternProtoCallback(leave_prototype_out, nullptr);
        SoType::overrideType(SoVRMLImageTexture::getClassTypeId(), UnfetchedTexture::make);
        SoType::overrideType(SoVRMLAudioClip::getClassTypeId(), UnfetchedSound::make);
        // Inventor's own nodes are read in VRML files, too; these open the files that they name while they are read.
        for (const SoType& type : {SoFile::getClassTypeId(), SoWWWInline::getClassTypeId(), SoImage::getClassTypeId(),
                                   SoTexture2::getClassTypeId(), SoTexture3::getClassTypeId(),
                                   SoTextureCubeMap::getClassTypeId(), SoBumpMap::getClassTypeId()}) {
            SoType::overrideType(type, make_group);
        }
        return true;
    }();
    static_cast<void>(started);
}

/// The depth of nested braces, outside of comments and strings.
std::size_t depth_of(std::string_view text) {
    std::size_t depth = 0, max_depth_so_far = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '#') {
            i = std::min(text.find_first_of("\r\n", i), text.size());
        } else if (text[i] == '"') {
            for (++i; i < text.size() && text[i] != '"'; ++i) {
                if (text[i] == '\\') ++i;
            }
        } else if (text[i] == '{') {
            max_depth_so_far = std::max(max_depth_so_far, ++depth);
        } else if (text[i] == '}' && depth > 0) {
            --depth;
        }
    }
    return max_depth_so_far;
}

/// How many values the list of this name has in the node that the field holds; 0 where there is none.
std::size_t count_of(const SoSFNode& field, const char* list) {
    const SoNode* node = field.getValue();
    const SoField* values = node == nullptr ? nullptr : node->getField(list);
    if (values == nullptr || !values->isOfType(SoMField::getClassTypeId())) return 0;
    return static_cast<std::size_t>(static_cast<const SoMField*>(values)->getNum());
}

/// Whether every index is -1 or below `count`; of an index of its own or, where that is empty, of the corners'.
bool reaches_inside(const SoMFInt32& own, const SoMFInt32& corners, std::size_t count) {
    const SoMFInt32& index = own.getNum() > 0 ? own : corners;
    const std::int32_t* values = index.getValues(0);
    return std::all_of(values, values + index.getNum(),
                       [&](std::int32_t i) { return i == -1 || (i >= 0 && static_cast<std::size_t>(i) < count); });
}

std::size_t faces_of(const SoVRMLIndexedFaceSet& set) {
    const std::int32_t* values = set.coordIndex.getValues(0);
    const auto ends = std::count(values, values + set.coordIndex.getNum(), -1);
    return static_cast<std::size_t>(ends) + 1;
}

/// Coin does not check a file's indices: indices out of range would read from anywhere.
bool holds_together(const SoVRMLIndexedFaceSet& set) {
    const auto covers = [&](const SoMFInt32& own, bool per_vertex, std::size_t count) {
        if (per_vertex) return reaches_inside(own, set.coordIndex, count);
        const bool indexed = own.getNum() > 0;
        return indexed ? reaches_inside(own, own, count) && static_cast<std::size_t>(own.getNum()) + 1 >= faces_of(set)
                       : count + 1 >= faces_of(set);
    };
    const auto is_given = [](const SoSFNode& field) { return field.getValue() != nullptr; };
    return reaches_inside(set.coordIndex, set.coordIndex, count_of(set.coord, "point")) &&
           (!is_given(set.texCoord) || covers(set.texCoordIndex, true, count_of(set.texCoord, "point"))) &&
           (!is_given(set.normal) ||
            covers(set.normalIndex, set.normalPerVertex.getValue() != FALSE, count_of(set.normal, "vector"))) &&
           (!is_given(set.color) ||
            covers(set.colorIndex, set.colorPerVertex.getValue() != FALSE, count_of(set.color, "color")));
}

bool holds_together(const SoVRMLElevationGrid& grid) {
    const std::int64_t columns = grid.xDimension.getValue(), rows = grid.zDimension.getValue();
    if (columns < 2 || rows < 2 || columns > 100'000 || rows > 100'000) return false;
    const std::int64_t corners = columns * rows, faces = (columns - 1) * (rows - 1);
    const auto covers = [&](const SoSFNode& field, bool per_vertex, std::size_t count) {
        return field.getValue() == nullptr || static_cast<std::int64_t>(count) >= (per_vertex ? corners : faces);
    };
    return grid.height.getNum() >= corners && covers(grid.texCoord, true, count_of(grid.texCoord, "point")) &&
           covers(grid.normal, grid.normalPerVertex.getValue() != FALSE, count_of(grid.normal, "vector")) &&
           covers(grid.color, grid.colorPerVertex.getValue() != FALSE, count_of(grid.color, "color"));
}

bool holds_together(const SoVRMLExtrusion& extrusion) {
    const int stations = extrusion.spine.getNum();
    const auto covers = [&](int count) { return count == 1 || count >= stations; };
    return extrusion.crossSection.getNum() >= 2 && stations >= 2 && covers(extrusion.scale.getNum()) &&
           covers(extrusion.orientation.getNum());
}

/// Whether the field, where the node has it, is TRUE as is its default.
bool is_true(const SoNode& node, const char* field) {
    const SoField* found = node.getField(field);
    return found == nullptr || static_cast<const SoSFBool*>(found)->getValue() != FALSE;
}

/// Keeps a node alive as long as it is here.
class Kept {
public:
    explicit Kept(SoNode* node) : node_(node) {
        if (node_ != nullptr) node_->ref();
    }
    ~Kept() {
        if (node_ != nullptr) node_->unref();
    }
    Kept(const Kept&) = delete;
    Kept& operator=(const Kept&) = delete;
    [[nodiscard]] SoNode* get() const { return node_; }

private:
    SoNode* node_;
};

/// Walks the scene and collects its triangles, one mesh a material.
class Walk {
public:
    Walk(const FileSource& source, const std::string& path, RawScene& scene)
        : scene_(scene), textures_(source, path, scene) {}

    Result<void> run(SoNode* root) {
        SoCallbackAction action;
        action.addPreCallback(SoNode::getClassTypeId(), on_node, this);
        action.addTriangleCallback(SoShape::getClassTypeId(), on_triangle, this);
        action.apply(root);
        if (error_) return *error_;
        return {};
    }

private:
    using Key = std::tuple<std::string, std::array<float, 8>, std::string, bool>;

    static SoCallbackAction::Response on_node(void* self, SoCallbackAction* action, const SoNode* node) {
        return static_cast<Walk*>(self)->visit(*action, *node);
    }
    static void on_triangle(void* self, SoCallbackAction* action, const SoPrimitiveVertex* a,
                            const SoPrimitiveVertex* b, const SoPrimitiveVertex* c) {
        static_cast<Walk*>(self)->add(*action, {a, b, c});
    }

    void fail(const char* where, const std::string& why) {
        if (!error_) error_ = Error{where, why};
    }

    SoCallbackAction::Response visit(SoCallbackAction& action, const SoNode& node) {
        if (++nodes_ > max_nodes) fail("nodes", "are more than " + std::to_string(max_nodes));
        // A node may be used inside of itself: then the path never ends.
        if (static_cast<std::size_t>(action.getCurPath()->getLength()) > 2 * max_depth) {
            fail("nodes", "stand deeper in each other than " + std::to_string(max_depth));
        }
        if (node.isOfType(SoVRMLShape::getClassTypeId())) {
            material_name_.clear();
            texture_.clear();
        } else if (node.isOfType(SoVRMLMaterial::getClassTypeId())) {
            material_name_ = node.getName().getString();
        } else if (node.isOfType(SoVRMLImageTexture::getClassTypeId())) {
            const SoMFString& url = static_cast<const SoVRMLImageTexture&>(node).url;
            if (url.getNum() > 0) texture_ = url[0].getString();
        } else if (node.isOfType(SoVRMLInline::getClassTypeId())) {
            scene_.warnings.emplace_back("an Inline is left out: other files are not followed");
        } else if (node.isOfType(SoShape::getClassTypeId())) {
            return visit_geometry(node);
        }
        return error_ ? SoCallbackAction::ABORT : SoCallbackAction::CONTINUE;
    }

    /// Points, lines and text have no triangles; nodes other than VRML's are skipped.
    SoCallbackAction::Response visit_geometry(const SoNode& node) {
        bool whole = true;
        if (node.isOfType(SoVRMLIndexedFaceSet::getClassTypeId())) {
            whole = holds_together(static_cast<const SoVRMLIndexedFaceSet&>(node));
        } else if (node.isOfType(SoVRMLElevationGrid::getClassTypeId())) {
            whole = holds_together(static_cast<const SoVRMLElevationGrid&>(node));
        } else if (node.isOfType(SoVRMLExtrusion::getClassTypeId())) {
            whole = holds_together(static_cast<const SoVRMLExtrusion&>(node));
        } else if (!is_solid_primitive(node)) {
            return SoCallbackAction::PRUNE;
        }
        if (!whole) fail("a shape", "has an index or a count that fits none of its points, normals or colours");
        solid_ = is_true(node, "solid");
        clockwise_ = !is_true(node, "ccw");
        return error_ ? SoCallbackAction::ABORT : SoCallbackAction::CONTINUE;
    }

    static bool is_solid_primitive(const SoNode& node) {
        return node.isOfType(SoVRMLBox::getClassTypeId()) || node.isOfType(SoVRMLCone::getClassTypeId()) ||
               node.isOfType(SoVRMLCylinder::getClassTypeId()) || node.isOfType(SoVRMLSphere::getClassTypeId());
    }

    /// The mesh of the surface that is in force, new where there is none yet.
    RawMesh& mesh_of(SoCallbackAction& action, int index) {
        SbColor ambient, diffuse, specular, emission;
        float shininess = 0, transparency = 0;
        action.getMaterial(ambient, diffuse, specular, emission, shininess, transparency, index);
        const Key key{
            material_name_,
            {diffuse[0], diffuse[1], diffuse[2], transparency, shininess, emission[0], emission[1], emission[2]},
            texture_,
            solid_};
        const auto known = meshes_.find(key);
        if (known != meshes_.end()) return scene_.meshes[known->second];
        // One material for each vertex colour would be too many.
        if (meshes_.size() >= max_materials) return scene_.meshes.back();

        RawMaterial material;
        material.name = material_name_.empty() ? "material " + std::to_string(meshes_.size() + 1) : material_name_;
        material.base_color = {linear_from_srgb(diffuse[0]), linear_from_srgb(diffuse[1]), linear_from_srgb(diffuse[2]),
                               1 - unit_range(transparency)};
        material.emissive = {linear_from_srgb(emission[0]), linear_from_srgb(emission[1]),
                             linear_from_srgb(emission[2])};
        // The standard's shininess is an exponent divided by 128.
        material.roughness = roughness_from_exponent(128 * unit_range(shininess));
        material.double_sided = !solid_;
        if (!texture_.empty()) {
            material.base_color_image = textures_.index_of(texture_);
            if (material.base_color_image >= 0) material.base_color = {1, 1, 1, material.base_color[3]};
        }
        RawMesh mesh;
        mesh.name = material.name;
        mesh.material = static_cast<int>(scene_.materials.size());
        scene_.materials.push_back(std::move(material));
        scene_.meshes.push_back(std::move(mesh));
        meshes_.emplace(key, scene_.meshes.size() - 1);
        return scene_.meshes.back();
    }

    void take_transform(const SbMatrix& model) {
        if (to_scene_ == model && has_transform_) return;
        has_transform_ = true;
        to_scene_ = model;
        mirrored_ = model.det3() < 0;
        for_normals_ = model.det4() != 0 ? model.inverse().transpose() : SbMatrix::identity();
    }

    void add(SoCallbackAction& action, std::array<const SoPrimitiveVertex*, 3> corners) {
        if (error_) return;
        if (++triangles_ > max_triangles) return fail("triangles", "are more than " + std::to_string(max_triangles));
        take_transform(action.getModelMatrix());
        RawMesh& mesh = mesh_of(action, corners[0]->getMaterialIndex());
        // The last mesh may have got triangles of another surface.
        const bool textured = scene_.materials[static_cast<std::size_t>(mesh.material)].base_color_image >= 0;
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        for (const SoPrimitiveVertex* corner : corners) {
            SbVec3f p, n;
            to_scene_.multVecMatrix(corner->getPoint(), p);
            for_normals_.multDirMatrix(corner->getNormal(), n);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) {
                return fail("a vertex", "has a coordinate that is not a finite number");
            }
            const float length = std::sqrt(n.dot(n));
            const bool usable = std::isfinite(length) && length > 0;
            mesh.positions.push_back({p[0], p[1], p[2]});
            mesh.normals.push_back(usable ? Vec3f{n[0] / length, n[1] / length, n[2] / length} : Vec3f{0, 1, 0});
            if (textured) add_texture_coordinates(action, *corner, mesh);
        }
        const std::uint32_t second = clockwise_ != mirrored_ ? 2 : 1;
        mesh.triangles.push_back({first, first + second, first + 3 - second});
    }

    // The standard's texture origin is the lower left.
    static void add_texture_coordinates(SoCallbackAction& action, const SoPrimitiveVertex& corner, RawMesh& mesh) {
        SbVec4f uv;
        action.getTextureMatrix().multVecMatrix(corner.getTextureCoords(), uv);
        const bool usable = std::isfinite(uv[0]) && std::isfinite(uv[1]);
        mesh.texture_coordinates.push_back(usable ? std::array{uv[0], 1 - uv[1]} : std::array{0.0f, 0.0f});
    }

    RawScene& scene_;
    TextureReader textures_;
    std::optional<Error> error_;
    std::size_t nodes_ = 0, triangles_ = 0;
    std::map<Key, std::size_t> meshes_;

    // Of the present shape.
    std::string material_name_, texture_;
    SbMatrix to_scene_, for_normals_;
    bool solid_ = true, clockwise_ = false, has_transform_ = false, mirrored_ = false;
};

}  // namespace

Result<void> can_read_vrml() { return {}; }

Result<RawScene> read_vrml(const FileSource& source, const std::string& path) {
    const std::string where = source.describe(path);
    const auto bytes = source.read(path);
    if (!bytes) return bytes.error();
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (text.empty()) return Error{where, "is empty"};
    if (!text.starts_with("#VRML V2.0")) return Error{where, "is no VRML 2.0 text", "save it as VRML97 or glTF"};
    if (depth_of(text) > max_depth) {
        return Error{where, "nests nodes deeper than " + std::to_string(max_depth)};
    }

    start_coin();
    first_complaint.clear();
    SoInput input;
    input.setBuffer(text.data(), text.size());
    const Kept root(SoDB::readAll(&input));
    if (root.get() == nullptr) {
        return Error{where, first_complaint.empty() ? "holds no VRML node" : first_complaint};
    }
    RawScene scene;
    if (const auto walked = Walk(source, path, scene).run(root.get()); !walked) {
        return Error{where + ": " + walked.error().where, walked.error().why};
    }
    if (scene.meshes.empty()) return Error{where, "holds no triangles"};
    return scene;
}

}  // namespace embody::interchange

#else

namespace embody::interchange {

Result<void> can_read_vrml() {
    return Error{"VRML", "is not read by this build", "install libcoin-dev, then configure (cmake) and build again"};
}

Result<RawScene> read_vrml(const FileSource& source, const std::string& path) {
    const Error no_reader = can_read_vrml().error();
    return Error{source.describe(path), "VRML " + no_reader.why, no_reader.remedy};
}

}  // namespace embody::interchange

#endif
