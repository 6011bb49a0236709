// SPDX-License-Identifier: MIT
#include "attributes/surfaces.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "attributes/field_reader.h"
#include "attributes/interval_field.h"
#include "attributes/json_text.h"

namespace embody::attributes {
namespace {

using nlohmann::json;

constexpr std::size_t max_families = 255;

std::pair<physics::SurfaceId, physics::SurfaceId> ordered(physics::SurfaceId a, physics::SurfaceId b) {
    return std::minmax(a, b);
}

struct Family {
    std::string name;
    std::vector<std::string> materials;
};

Result<Family> read_family(const json& object, const std::string& where) {
    Family family;
    FieldReader reader(object, where);
    reader.require({"name", "materials"});
    reader.word("name", family.name);
    reader.words("materials", family.materials);
    if (!reader.finish()) return *reader.error();
    return family;
}

Result<SurfacePairData> read_pair(const json& object, const std::string& where) {
    SurfacePairData pair;
    FieldReader reader(object, where);
    reader.require({"a", "b", "friction_static", "friction_dynamic", "restitution", "source"});
    reader.word("a", pair.a);
    reader.word("b", pair.b);
    read_interval(reader, "friction_static", pair.friction_static, {0, 2});
    read_interval(reader, "friction_dynamic", pair.friction_dynamic, {0, 2});
    read_interval(reader, "restitution", pair.restitution, {0, 1});
    reader.word("source", pair.source);
    const Interval &sliding = pair.friction_dynamic, &rest = pair.friction_static;
    if (sliding.low > rest.low || sliding.typical > rest.typical || sliding.high > rest.high)
        reader.refuse("friction_dynamic", "must not exceed friction_static");
    if (!reader.finish()) return *reader.error();
    return pair;
}

}  // namespace

Result<Surfaces> Surfaces::load(const std::filesystem::path& file, const std::vector<MaterialData>& materials) {
    const auto document = read_json(file);
    if (!document) return document.error();
    const std::string name = file.filename().string();
    FieldReader reader(*document, name);
    std::string description;
    reader.require({"families", "pairs"});
    reader.word("description", description);
    const json* families = reader.list("families");
    const json* pairs = reader.list("pairs");
    if (!reader.finish()) return *reader.error();
    if (families->size() > max_families) return Error{name + ": families", "are more than 255"};

    Surfaces surfaces;
    for (std::size_t i = 0; i < families->size(); ++i) {
        const std::string where = name + ": families[" + std::to_string(i) + "]";
        auto family = read_family((*families)[i], where);
        if (!family) return family.error();
        if (std::ranges::find(surfaces.families_, family->name) != surfaces.families_.end())
            return Error{where + ".name", "\"" + family->name + "\" stands twice"};
        surfaces.families_.push_back(family->name);
        for (const std::string& material : family->materials) {
            if (std::ranges::find(materials, material, &MaterialData::name) == materials.end())
                return Error{where + ".materials", "materials.json has no \"" + material + "\""};
            const auto surface = static_cast<physics::SurfaceId>(surfaces.families_.size());
            if (!surfaces.by_material_.emplace(material, surface).second)
                return Error{where + ".materials", "\"" + material + "\" is in another family already"};
        }
    }
    for (std::size_t i = 0; i < pairs->size(); ++i) {
        const std::string where = name + ": pairs[" + std::to_string(i) + "]";
        auto pair = read_pair((*pairs)[i], where);
        if (!pair) return pair.error();
        if (auto added = surfaces.add_pair(std::move(*pair)); !added)
            return Error{where + "." + added.error().where, added.error().why};
    }
    return surfaces;
}

Result<void> Surfaces::add_pair(SurfacePairData pair) {
    const auto family = [&](const std::string& name) {
        const auto found = std::ranges::find(families_, name);
        return found == families_.end() ? 0 : static_cast<physics::SurfaceId>(found - families_.begin() + 1);
    };
    const auto a = static_cast<physics::SurfaceId>(family(pair.a)), b = static_cast<physics::SurfaceId>(family(pair.b));
    if (a == 0) return Error{"a", "there is no family \"" + pair.a + "\""};
    if (b == 0) return Error{"b", "there is no family \"" + pair.b + "\""};
    if (!index_.emplace(ordered(a, b), pairs_.size()).second)
        return Error{"b", "\"" + pair.a + "\" with \"" + pair.b + "\" stands twice"};
    auto set =
        table_.set(a, b, {pair.friction_static.typical, pair.friction_dynamic.typical, pair.restitution.typical});
    pairs_.push_back(std::move(pair));
    return set;
}

physics::SurfaceId Surfaces::surface_of(std::string_view material) const {
    const auto found = by_material_.find(material);
    return found == by_material_.end() ? physics::SurfaceId{0} : found->second;
}

const SurfacePairData* Surfaces::pair(std::string_view material_a, std::string_view material_b) const {
    const auto found = index_.find(ordered(surface_of(material_a), surface_of(material_b)));
    return found == index_.end() ? nullptr : &pairs_[found->second];
}

}  // namespace embody::attributes
