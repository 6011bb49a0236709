// SPDX-License-Identifier: MIT
#include "catalog/knowledge_json.h"

#include <nlohmann/json.hpp>

#include "attributes/attribute_json.h"
#include "attributes/facts_json.h"

namespace embody::catalog {
namespace {

using Json = nlohmann::json;
using attributes::AttributeForm;
using attributes::AttributeSet;
using attributes::AttributeValue;
using attributes::ModelFacts;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Result<Json> parsed(std::string_view text, const char* what) {
    Json document = Json::parse(text, nullptr, false);
    if (document.is_discarded()) return Error{what, "is not JSON", "import the model again"};
    return document;
}

// What cannot be read is written anew by an import.
template <class T>
Result<T> with_remedy(Result<T> read) {
    if (read) return read;
    return Error{read.error().where, read.error().why, "import the model again"};
}

}  // namespace

std::string to_json(const AttributeValue& value) { return text_of(attributes::to_json(value, AttributeForm::stored)); }

Result<AttributeValue> value_from_json(std::string_view text) {
    const auto document = parsed(text, "stored attribute");
    if (!document) return document.error();
    return with_remedy(attributes::stored_value_from_json(*document, "stored attribute"));
}

std::string to_json(const AttributeSet& set) { return text_of(attributes::to_json(set, AttributeForm::stored)); }

Result<AttributeSet> set_from_json(std::string_view text) {
    const auto document = parsed(text, "stored attributes");
    if (!document) return document.error();
    return with_remedy(attributes::set_from_json(*document, "stored attributes", AttributeForm::stored));
}

std::string to_json(const ModelFacts& facts) { return text_of(attributes::to_json(facts)); }

Result<ModelFacts> facts_from_json(std::string_view text) {
    const auto document = parsed(text, "stored facts");
    if (!document) return document.error();
    return with_remedy(attributes::facts_from_json(*document));
}

std::string valid_utf8(const std::string& text) {
    // The JSON writer knows how to replace; reading back removes its escapes.
    return Json::parse(text_of(Json(text))).get<std::string>();
}

}  // namespace embody::catalog
