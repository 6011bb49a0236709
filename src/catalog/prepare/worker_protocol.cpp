// SPDX-License-Identifier: MIT
#include "catalog/prepare/worker_protocol.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catalog/prepare/byte_stream.h"
#include "catalog/prepare/part_measurement.h"
#include "foundation/state_hash.h"

namespace embody::catalog {
namespace {

constexpr std::uint32_t magic = 0x57424D45;  // "EMBW"
constexpr std::size_t max_text_bytes = 64 << 10, max_list_length = 4096, max_hull_points = 256;
constexpr std::size_t max_thumbnail_bytes = 4 << 20, max_packed_hull_bytes = 1 << 20;
const Error broken{"import worker", "sent something that is not its protocol"};

std::uint64_t hash_of(std::span<const std::uint8_t> bytes) {
    StateHash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.value();
}

void put(ByteWriter& out, const std::vector<std::string>& texts) {
    const std::size_t count = std::min(texts.size(), max_list_length);
    out.number(static_cast<std::uint64_t>(count));
    for (std::size_t i = 0; i < count; ++i) out.text(std::string_view(texts[i]).substr(0, max_text_bytes));
}
void put(ByteWriter& out, Vec3 v) {
    for (int i = 0; i < 3; ++i) out.number(v[i]);
}
void put(ByteWriter& out, std::optional<bool> answer) { out.number(std::uint8_t(answer ? (*answer ? 2 : 1) : 0)); }

std::vector<std::string> take_texts(ByteReader& in) {
    std::vector<std::string> texts(in.count(max_list_length, sizeof(std::uint64_t)));
    for (std::string& text : texts) text = in.text(max_text_bytes);
    return texts;
}
void put(ByteWriter& out, const std::vector<interchange::Recolor>& recolors) {
    const std::size_t count = std::min(recolors.size(), max_list_length);
    out.number(static_cast<std::uint64_t>(count));
    for (std::size_t i = 0; i < count; ++i) {
        out.text(std::string_view(recolors[i].material).substr(0, max_text_bytes));
        for (const double part : recolors[i].color) out.number(part);
    }
}

double take_finite(ByteReader& in) {
    const auto value = in.number<double>();
    if (!std::isfinite(value)) in.fail();
    return value;
}
std::vector<interchange::Recolor> take_recolors(ByteReader& in) {
    std::vector<interchange::Recolor> recolors(in.count(max_list_length, sizeof(std::uint64_t)));
    for (interchange::Recolor& recolor : recolors) {
        recolor.material = in.text(max_text_bytes);
        for (double& part : recolor.color) part = take_finite(in);
    }
    return recolors;
}
/// Lengths, areas, volumes: not negative, and below what any thing of 10 km measures.
double take_measure(ByteReader& in) {
    const double value = take_finite(in);
    if (value < 0 || value > 1e15) in.fail();
    return value;
}
Vec3 take_vector(ByteReader& in) {
    Vec3 v;
    for (int i = 0; i < 3; ++i) v[i] = take_finite(in);
    return v;
}
bool take_truth(ByteReader& in) {
    const auto value = in.number<std::uint8_t>();
    if (value > 1) in.fail();
    return value == 1;
}
std::optional<bool> take_answer(ByteReader& in) {
    const auto value = in.number<std::uint8_t>();
    if (value > 2) in.fail();
    return value == 0 ? std::nullopt : std::optional(value == 2);
}

void put(ByteWriter& out, const geometry::MassProperties& p) {
    out.number(p.volume);
    put(out, p.center);
    for (int c = 0; c < 3; ++c) put(out, p.inertia.column(c));
}
geometry::MassProperties take_mass_properties(ByteReader& in) {
    geometry::MassProperties p;
    p.volume = take_measure(in);
    p.center = take_vector(in);
    for (int c = 0; c < 3; ++c) p.inertia.column(c) = take_vector(in);
    return p;
}

void put(ByteWriter& out, const std::vector<attributes::PartFacts>& parts) {
    out.number(static_cast<std::uint64_t>(parts.size()));
    for (const attributes::PartFacts& part : parts) {
        out.text(std::string_view(part.material).substr(0, max_text_bytes));
        put(out, part.form.shell);
        put(out, part.form.solid);
    }
}
std::vector<attributes::PartFacts> take_parts(ByteReader& in) {
    std::vector<attributes::PartFacts> parts(in.count(max_parts, sizeof(std::uint64_t)));
    for (attributes::PartFacts& part : parts) {
        part.material = in.text(max_text_bytes);
        part.form.shell = take_mass_properties(in);
        part.form.solid = take_mass_properties(in);
    }
    return parts;
}

void put(ByteWriter& out, const attributes::GeometryFacts& facts) {
    put(out, facts.size);
    out.number(std::uint8_t(facts.closed));
    out.number(facts.volume);
    out.text(facts.volume_method);
    out.number(facts.volume_relative_error);
    put(out, facts.center_of_volume);
    for (int c = 0; c < 3; ++c) put(out, facts.unit_inertia.column(c));
    out.number(facts.hull_volume);
    out.number(facts.hull_concavity);
    out.number(facts.surface_area);
    out.text(facts.fitted_shape);
    put(out, facts.fitted_dimensions);
    put(out, facts.fitted_pose.position);
    const Quat& q = facts.fitted_pose.rotation;
    for (const double part : {q.x, q.y, q.z, q.w}) out.number(part);
    out.number(facts.fitted_error);
    put(out, facts.parts);
}

attributes::GeometryFacts take_geometry_facts(ByteReader& in) {
    attributes::GeometryFacts facts;
    for (int i = 0; i < 3; ++i) facts.size[i] = take_measure(in);
    facts.closed = take_truth(in);
    facts.volume = take_measure(in);
    facts.volume_method = in.text(max_text_bytes);
    facts.volume_relative_error = take_measure(in);
    facts.center_of_volume = take_vector(in);
    for (int c = 0; c < 3; ++c) facts.unit_inertia.column(c) = take_vector(in);
    facts.hull_volume = take_measure(in);
    facts.hull_concavity = take_measure(in);
    facts.surface_area = take_measure(in);
    facts.fitted_shape = in.text(max_text_bytes);
    const auto& shape = facts.fitted_shape;
    if (shape != "box" && shape != "sphere" && shape != "capsule" && shape != "cylinder" && shape != "convex_hull")
        in.fail();
    for (int i = 0; i < 3; ++i) facts.fitted_dimensions[i] = take_measure(in);
    facts.fitted_pose.position = take_vector(in);
    Quat& q = facts.fitted_pose.rotation;
    for (double* part : {&q.x, &q.y, &q.z, &q.w}) *part = take_finite(in);
    if (std::fabs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1) > 1e-6) in.fail();
    facts.fitted_error = take_measure(in);
    facts.parts = take_parts(in);
    return facts;
}

void put(ByteWriter& out, const attributes::ModelFacts& facts) {
    out.text(facts.name);
    put(out, facts.tags);
    out.text(facts.catalogue_category);
    out.text(facts.folder);
    put(out, facts.material_names);
    put(out, facts.movable);
    out.number(std::uint8_t(facts.door_or_window));
    out.number(std::uint8_t(facts.size_is_stated));
    put(out, facts.geometry);
}

attributes::ModelFacts take_model_facts(ByteReader& in) {
    attributes::ModelFacts facts;
    facts.name = in.text(max_text_bytes);
    facts.tags = take_texts(in);
    facts.catalogue_category = in.text(max_text_bytes);
    facts.folder = in.text(max_text_bytes);
    facts.material_names = take_texts(in);
    facts.movable = take_answer(in);
    facts.door_or_window = take_truth(in);
    facts.size_is_stated = take_truth(in);
    facts.geometry = take_geometry_facts(in);
    return facts;
}

}  // namespace

std::vector<std::uint8_t> frame(FrameKind kind, std::span<const std::uint8_t> payload) {
    ByteWriter out;
    out.number(magic);
    out.number(protocol_version);
    out.number(static_cast<std::uint32_t>(kind));
    out.number(static_cast<std::uint32_t>(payload.size()));
    out.raw(payload);
    out.number(hash_of(payload));
    return out.take();
}

Result<FrameHeader> read_frame_header(std::span<const std::uint8_t> bytes) {
    ByteReader in(bytes.first(std::min(bytes.size(), frame_header_size)));
    const bool is_ours = in.number<std::uint32_t>() == magic && in.number<std::uint32_t>() == protocol_version;
    const auto kind = in.number<std::uint32_t>();
    const auto size = in.number<std::uint32_t>();
    const bool known = kind >= static_cast<std::uint32_t>(FrameKind::ready) &&
                       kind <= static_cast<std::uint32_t>(FrameKind::out_of_memory);
    if (!is_ours || !known || size > max_payload_bytes || !in.is_complete()) return broken;
    return FrameHeader{static_cast<FrameKind>(kind), size};
}

Result<std::span<const std::uint8_t>> payload_of(std::span<const std::uint8_t> whole_frame) {
    if (whole_frame.size() < frame_header_size + frame_hash_size) return broken;
    const auto payload =
        whole_frame.subspan(frame_header_size, whole_frame.size() - frame_header_size - frame_hash_size);
    ByteReader hash(whole_frame.last(frame_hash_size));
    if (hash.number<std::uint64_t>() != hash_of(payload)) return broken;
    return payload;
}

std::vector<std::uint8_t> to_bytes(const ImportItem& item) {
    ByteWriter out;
    for (const std::string* text : {&item.key, &item.archive, &item.path, &item.icon_path, &item.name, &item.source,
                                    &item.licence, &item.author, &item.category, &item.stated_thing}) {
        out.text(*text);
    }
    put(out, item.tags);
    out.number(std::uint8_t(item.stated_size.has_value()));
    for (const double length : item.stated_size.value_or(std::array<double, 3>{})) out.number(length);
    out.number(std::uint8_t(item.stated_unit.has_value()));
    out.number(item.stated_unit.value_or(0));
    for (const double part : item.stated_rotation) out.number(part);
    put(out, item.recolors);
    put(out, item.movable);
    out.number(std::uint8_t(item.door_or_window));
    return out.take();
}

Result<ImportItem> item_from_bytes(std::span<const std::uint8_t> payload) {
    ByteReader in(payload);
    ImportItem item;
    for (std::string* text : {&item.key, &item.archive, &item.path, &item.icon_path, &item.name, &item.source,
                              &item.licence, &item.author, &item.category, &item.stated_thing}) {
        *text = in.text(max_text_bytes);
    }
    item.tags = take_texts(in);
    const bool has_size = take_truth(in);
    std::array<double, 3> size{};
    for (double& length : size) length = take_measure(in);
    if (has_size) item.stated_size = size;
    const bool has_unit = take_truth(in);
    const double unit = take_measure(in);
    if (has_unit) item.stated_unit = unit;
    for (double& part : item.stated_rotation) part = take_finite(in);
    item.recolors = take_recolors(in);
    item.movable = take_answer(in);
    item.door_or_window = take_truth(in);
    if (!in.is_complete()) return Error{item.path, "its name, tags or numbers are too long or not finite"};
    return item;
}

std::vector<std::uint8_t> to_bytes(const PreparedModel& model) {
    ByteWriter out;
    out.block(model.geometry);
    out.block(model.thumbnail);
    out.number(static_cast<std::uint64_t>(model.hull_points.size()));
    for (const Vec3f p : model.hull_points) {
        for (const float part : {p.x, p.y, p.z}) out.number(part);
    }
    out.number(static_cast<std::int32_t>(model.convex_parts.max_hulls));
    out.number(model.convex_parts.hull_error);
    out.number(model.convex_parts.concavity);
    out.number(model.convex_parts.hull_concavity);
    out.block(pack_hulls(model.convex_parts.hulls));
    put(out, model.facts);
    out.number(model.content_hash);
    for (const std::uint32_t count : {model.vertices, model.triangles, model.parts, model.materials, model.images}) {
        out.number(count);
    }
    out.number(static_cast<std::int32_t>(model.quality));
    put(out, model.warnings);
    return out.take();
}

Result<PreparedModel> model_from_bytes(std::span<const std::uint8_t> payload) {
    ByteReader in(payload);
    PreparedModel model;
    const auto geometry = in.block(max_payload_bytes);
    model.geometry.assign(geometry.begin(), geometry.end());
    const auto thumbnail = in.block(max_thumbnail_bytes);
    model.thumbnail.assign(thumbnail.begin(), thumbnail.end());
    model.hull_points.resize(in.count(max_hull_points, sizeof(Vec3f)));
    for (Vec3f& p : model.hull_points) {
        for (float* part : {&p.x, &p.y, &p.z}) {
            *part = in.number<float>();
            if (!std::isfinite(*part)) in.fail();
        }
    }
    model.convex_parts.max_hulls = in.number<std::int32_t>();
    model.convex_parts.hull_error = take_measure(in);
    model.convex_parts.concavity = take_measure(in);
    model.convex_parts.hull_concavity = take_measure(in);
    auto hulls = unpack_hulls(in.block(max_packed_hull_bytes));
    if (!hulls || model.convex_parts.max_hulls < 0) return broken;
    model.convex_parts.hulls = std::move(*hulls);
    model.facts = take_model_facts(in);
    model.content_hash = in.number<std::uint64_t>();
    for (std::uint32_t* count : {&model.vertices, &model.triangles, &model.parts, &model.materials, &model.images}) {
        *count = in.number<std::uint32_t>();
    }
    model.quality = in.number<std::int32_t>();
    model.warnings = take_texts(in);
    if (!in.is_complete() || model.geometry.empty() || model.quality < 0 || model.quality > 3) return broken;
    return model;
}

std::vector<std::uint8_t> to_bytes(const Error& error) {
    ByteWriter out;
    for (const std::string* text : {&error.where, &error.why, &error.remedy}) {
        out.text(std::string_view(*text).substr(0, max_text_bytes));
    }
    return out.take();
}

Error error_from_bytes(std::span<const std::uint8_t> payload) {
    ByteReader in(payload);
    Error error;
    for (std::string* text : {&error.where, &error.why, &error.remedy}) *text = in.text(max_text_bytes);
    return in.is_complete() && !error.why.empty() ? error : broken;
}

}  // namespace embody::catalog
