// SPDX-License-Identifier: MIT
#include "scene/embody/geometry_key.h"

namespace embody::scene {

namespace {

using namespace embody::physics;

std::vector<double> numbers_of(const SphereShape& s) { return {s.radius}; }
std::vector<double> numbers_of(const BoxShape& s) { return {s.half_extents.x, s.half_extents.y, s.half_extents.z}; }
std::vector<double> numbers_of(const CapsuleShape& s) { return {s.radius, s.half_height}; }
std::vector<double> numbers_of(const CylinderShape& s) { return {s.radius, s.half_height}; }
std::vector<double> numbers_of(const ConeShape& s) { return {s.radius, s.half_height}; }

std::vector<double> numbers_of(const HullShape& s) {
    std::vector<double> numbers;
    numbers.reserve(3 * s.points.size());
    for (const Vec3& point : s.points) numbers.insert(numbers.end(), {point.x, point.y, point.z});
    return numbers;
}

std::vector<double> numbers_of(const PlaneShape&) { return {}; }
std::vector<double> numbers_of(const HeightfieldShape&) { return {}; }
std::vector<double> numbers_of(const MeshShape&) { return {}; }
std::vector<double> numbers_of(const CompoundShape&) { return {}; }
std::vector<double> numbers_of(const HasParts auto&) { return {}; }

}  // namespace

GeometryKey key_of(const ShapeDefinition& shape) {
    std::vector<double> numbers = std::visit([](const auto& one) { return numbers_of(one); }, shape);
    if (numbers.empty()) return {};
    return {GeometryKey::Of::primitive, {shape_name(shape)}, std::move(numbers)};
}

GeometryKey key_of_model(const std::string& key) { return {GeometryKey::Of::model, {key}, {}}; }

GeometryKey key_of(const Geometry& geometry) {
    const auto* model = std::get_if<ModelReference>(&geometry);
    return model ? key_of_model(model->key) : key_of(std::get<ShapeDefinition>(geometry));
}

}  // namespace embody::scene
