// SPDX-License-Identifier: MIT
#include "scene/embody/kept_fit.h"

#include <algorithm>
#include <cstdio>

#include "foundation/state_hash.h"

namespace embody::scene {

namespace {

void add(StateHash& hash, const std::string& word) {
    hash.add(static_cast<std::uint64_t>(word.size()));
    hash.add_bytes(word.data(), word.size());
}

// To nine digits: values that are computed may differ in the last ones between machines, and zeros in their sign where
// another program has written the file.
void add(StateHash& hash, double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.9g", number == 0 ? 0.0 : number);
    add(hash, std::string(text));
}

void add(StateHash& hash, const GeometryKey& key) {
    hash.add(static_cast<std::uint64_t>(key.words.size()));
    for (const std::string& word : key.words) add(hash, word);
    hash.add(static_cast<std::uint64_t>(key.numbers.size()));
    for (const double number : key.numbers) add(hash, number);
}

// The key has nothing of compounds.
void add_children(StateHash& hash, const Geometry& geometry) {
    const auto* shape = std::get_if<physics::ShapeDefinition>(&geometry);
    const auto* compound = shape != nullptr ? std::get_if<physics::CompoundShape>(shape) : nullptr;
    if (compound == nullptr) return;
    for (const physics::CompoundChild& child : compound->children) {
        add(hash, std::visit([](const auto& one) { return key_of(physics::ShapeDefinition(one)); }, child.shape));
        const auto& [at, turn] = child.local;
        for (const double number : {at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w}) add(hash, number);
    }
}

template <class Elements>
void add_elements(StateHash& hash, const Elements& elements) {
    for (const auto& element : elements)
        for (const std::uint32_t node : element) hash.add(std::uint64_t{node});
}

StateHash hash_of(const GeometryKey& key, const Geometry& geometry) {
    StateHash hash;
    add(hash, key);
    add_children(hash, geometry);
    return hash;
}

std::string digits(const StateHash& hash) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash.value()));
    return text;
}

std::vector<physics::TornCorner> torn_of(const KeptForm& kept) {
    std::vector<physics::TornCorner> torn;
    for (std::size_t i = 0; i + 2 < kept.torn.size(); i += numbers_per_tear)
        torn.push_back({kept.torn[i], kept.torn[i + 1], kept.torn[i + 2]});
    return torn;
}

constexpr const char* as_modelled = "take the field kept out, or keep the form anew: the thing begins as modelled";

// Nodes that a sheet has got by its tears.
Result<std::size_t> check_torn(const KeptForm& kept, const KeptFit& fit) {
    if (kept.torn.empty()) return std::size_t{0};
    if (fit.triangles.empty()) return Error{"kept.torn", "is of a sheet, which this is not", as_modelled};
    // Any nodes at places of their own: what must be right is which belongs to which.
    physics::DeformableDefinition sheet{.matter = physics::Cloth{.triangles = fit.triangles}};
    for (std::size_t i = 0; i < fit.max_points; ++i) sheet.nodes.push_back({static_cast<double>(i), 0, 0});
    const Result<void> torn = physics::tear(sheet, torn_of(kept));
    std::vector<bool> is_used(sheet.nodes.size(), false);
    for (const auto& triangle : std::get<physics::Cloth>(sheet.matter).triangles)
        for (const std::uint32_t node : triangle) is_used[node] = true;
    if (!torn.ok()) return Error{"kept.torn", torn.error().where + " " + torn.error().why, as_modelled};
    if (std::ranges::find(is_used, false) != is_used.end())
        return Error{"kept.torn", "leaves a node without a triangle", as_modelled};
    return sheet.nodes.size() - fit.max_points;
}

}  // namespace

KeptFit fit_of_particles(const GeometryKey& key, const Geometry& geometry, std::size_t budget, bool is_liquid) {
    return {.fingerprint = digits(hash_of(key, geometry)), .max_points = budget, .is_liquid = is_liquid};
}

KeptFit fit_of_mesh(const GeometryKey& key, const Geometry& geometry, const catalog::SoftMesh& mesh) {
    StateHash hash = hash_of(key, geometry);
    add_elements(hash, mesh.mesh.tetrahedra);
    const std::size_t nodes = mesh.mesh.nodes.size();
    return {.fingerprint = digits(hash),
            .min_points = nodes,
            .max_points = nodes,
            .strains = mesh.mesh.tetrahedra.size() + nodes};
}

KeptFit fit_of_mesh(const GeometryKey& key, const Geometry& geometry, const ThinForm& form) {
    StateHash hash = hash_of(key, geometry);
    if (const auto* line = std::get_if<LineForm>(&form)) {
        const std::size_t nodes = line->nodes.size();
        return {.fingerprint = digits(hash),
                .min_points = nodes,
                .max_points = nodes,
                .segments = nodes - 1,
                .bends = nodes};
    }
    const auto& sheet = std::get<attributes::SheetMesh>(form);
    add_elements(hash, sheet.triangles);
    return {.fingerprint = digits(hash),
            .min_points = sheet.nodes.size(),
            .max_points = sheet.nodes.size(),
            .bends = sheet.triangles.size(),
            .triangles = sheet.triangles};
}

Result<void> check_kept(const KeptForm& kept, const KeptFit& fit) {
    if (kept.fingerprint != fit.fingerprint)
        return Error{"kept.fingerprint",
                     "is of another form than the thing has now: its kind, geometry, scale or mesh is another one",
                     as_modelled};
    const Result<std::size_t> new_points = check_torn(kept, fit);
    if (!new_points.ok()) return new_points.error();
    const std::size_t points = kept.places.values.size() / 3;
    const std::size_t least = fit.min_points + *new_points, most = fit.max_points + *new_points;
    if (points < least || points > most) {
        std::string count = std::to_string(most);
        if (least != most) count = std::to_string(least) + " … " + count;
        return Error{"kept.places", "must be of " + count + " points, got " + std::to_string(points), as_modelled};
    }
    const std::size_t strains = kept.plastic_strain.values.size() / numbers_per_strain;
    if (strains != 0 && strains != fit.strains)
        return Error{
            "kept.plastic_strain",
            "must be of " + std::to_string(fit.strains) + " tetrahedra and nodes, got " + std::to_string(strains),
            as_modelled};
    const std::size_t bends = kept.bend.values.size() / numbers_per_bend;
    if (bends != 0 && bends != fit.bends)
        return Error{"kept.bend",
                     "must be of " + std::to_string(fit.bends) + " triangles or nodes, got " + std::to_string(bends),
                     as_modelled};
    if (!kept.broken.empty() && kept.broken.back() >= fit.segments)
        return Error{"kept.broken", "has a segment that the thing has not, which has " + std::to_string(fit.segments),
                     as_modelled};
    constexpr double min_cell_size = 1e-3;  // m, limit of the physics
    if (fit.is_liquid != (kept.cell_size > 0) || (fit.is_liquid && kept.cell_size < min_cell_size))
        return Error{"kept.cell_size",
                     fit.is_liquid ? "of a liquid must be 0.001 … 1 m" : "is of a liquid, which this is not",
                     as_modelled};
    return {};
}

std::vector<Vec3> places_of(const KeptForm& kept) {
    const std::vector<double>& values = kept.places.values;
    std::vector<Vec3> places;
    places.reserve(values.size() / 3);
    for (std::size_t i = 0; i + 2 < values.size(); i += 3) places.push_back({values[i], values[i + 1], values[i + 2]});
    return places;
}

namespace {

template <std::size_t n>
std::vector<std::array<double, n>> unpacked(const PackedNumbers& numbers) {
    std::vector<std::array<double, n>> rows(numbers.values.size() / n);
    for (std::size_t i = 0; i < rows.size(); ++i)
        std::copy_n(numbers.values.begin() + static_cast<std::ptrdiff_t>(n * i), n, rows[i].begin());
    return rows;
}

}  // namespace

physics::LastingDeformation lasting_of(const KeptForm& kept) {
    physics::LastingDeformation lasting;
    lasting.plastic_strain = unpacked<numbers_per_strain>(kept.plastic_strain);
    lasting.broken_segments = kept.broken;
    lasting.bend = unpacked<numbers_per_bend>(kept.bend);
    lasting.torn_corners = torn_of(kept);
    return lasting;
}

std::vector<std::uint32_t> packed(const std::vector<physics::TornCorner>& corners) {
    std::vector<std::uint32_t> numbers;
    for (const auto& [corner, from, node] : corners) numbers.insert(numbers.end(), {corner, from, node});
    return numbers;
}

PackedNumbers packed(const std::vector<Vec3>& places) {
    PackedNumbers numbers;
    numbers.values.reserve(3 * places.size());
    for (const Vec3 place : places) numbers.values.insert(numbers.values.end(), {place.x, place.y, place.z});
    return numbers;
}

}  // namespace embody::scene
