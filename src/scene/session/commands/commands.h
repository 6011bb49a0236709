// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "foundation/result.h"
#include "scene/file/json/field_reader.h"
#include "scene/session/placement.h"
#include "scene/session/rights.h"
#include "scene/session/session_state.h"

namespace embody::scene {

/// One command of docs/protocol.md: reads its parameters strictly, executes, and returns its result.
struct Command {
    const char* name;
    Result<nlohmann::json> (*execute)(SessionState& state, const nlohmann::json& params);
    Need need = Need::edit;
};

// One list for each family of commands, each in one file.
std::span<const Command> catalog_commands();
std::span<const Command> catalog_change_commands();
std::span<const Command> people_commands();
std::span<const Command> scene_commands();
std::span<const Command> entity_commands();
std::span<const Command> placement_commands();
std::span<const Command> room_commands();
std::span<const Command> arrange_commands();
std::span<const Command> group_commands();
std::span<const Command> part_commands();
std::span<const Command> attribute_commands();
std::span<const Command> value_commands();
std::span<const Command> joint_and_action_commands();
std::span<const Command> simulation_commands();
std::span<const Command> time_commands();

/// Reads a field that must be there.
bool need_text(FieldReader& reader, const char* name, const char* what, std::string& value);
bool need_index(FieldReader& reader, const char* name, EntityIndex& value);
bool need_vector(FieldReader& reader, const char* name, const char* what, Vec3& value);
/// Reads indices of entities of the document, each once, ascending; at least one.
bool need_indices(FieldReader& reader, const SessionState& state, std::vector<EntityIndex>& indices);

/// Ends a command that has no result.
Result<nlohmann::json> done(const Result<void>& result);

/// The rows of the properties panel: the protocol's AttributeEntry. `own` tells whether a name is overridden.
nlohmann::json attribute_rows(const attributes::AttributeSet& acting, const attributes::AttributeSet& automatic,
                              const std::vector<std::string>& own, const std::vector<attributes::Issue>& issues);
/// What makes no sense of an entity's values, in its scene.
Result<std::vector<attributes::Issue>> issues_of(SessionState& state, const Entity& entity);
/// {why, remedy, reset}
nlohmann::json warning_json(const attributes::Issue& issue);

/// The model database that is open, or an error that says how to open one.
Result<catalog::Catalog*> open_catalog(const SessionState& state);
/// The rows of a model of the catalogue.
Result<nlohmann::json> model_attribute_rows(const catalog::Catalog& catalog, std::int64_t id);

/// Where a pointer drops something: {origin, direction, snap?}.
struct Drop {
    PointerRay ray;
    bool snap = true;
};
/// Reads the field `drop`, where there is one.
void read_drop(FieldReader& reader, std::optional<Drop>& drop);
/// An error where the document has no room for `count` more entities.
Result<void> check_room(const Document& document, std::size_t count);

}  // namespace embody::scene
