// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "attributes/attribute.h"

namespace embody::catalog {

/// Who acts, for the audit of manual changes.
struct Author {
    std::string person;   ///< login name
    std::string session;  ///< program or client through which the person acts, such as "Studio client 2"
};

/// A value that a person sets or removes.
struct AttributeChange {
    std::string name;
    std::optional<attributes::AttributeValue> value = {};  ///< none: back to the automatic one
};

struct ChangeOptions {
    bool reset_all = false;     ///< take back all manual values; then no change is named
    bool skip_refused = false;  ///< change the other models where some refuse
    bool dry_run = false;       ///< only report what would happen
    /// After each model, done of total; returns false to stop: then nothing is changed. May be empty.
    std::function<bool(std::size_t done, std::size_t total)> progress = {};
};

/// A model that was changed, or would be.
struct ChangedModel {
    std::int64_t id = 0;  ///< 0: not in the database now, but what persons set stays known
    std::string key, name;
};

/// Why a value of a model was not changed.
struct RefusedChange {
    std::string key, name, attribute, why;
};

struct ChangeReport {
    std::int64_t batch = 0;  ///< of the audit; 0: nothing was changed
    std::string command;     ///< set, reset, set many, reset many, undo, redo
    std::size_t chosen = 0;  ///< models that were meant
    std::size_t values = 0;  ///< that were changed, of all models together
    std::vector<ChangedModel> models;
    std::vector<RefusedChange> refused;  ///< unless skip_refused: one of them and nothing is changed

    std::size_t unchanged = 0;            ///< models that have these values already
    std::vector<std::string> attributes;  ///< names of what was changed, each once
};

struct HistoryQuery {
    std::string model_key = {};  ///< empty: all models
    std::int64_t since = 0;      ///< seconds since 1970, UTC
    std::int64_t batch = 0;      ///< 0: all
    int limit = 100;
};

/// Which acts are listed.
struct BatchQuery {
    std::string model_key = {};  ///< that they changed; empty: all models
    std::int64_t since = 0;      ///< seconds since 1970, UTC
    std::int64_t after = 0;      ///< only batches with a number above this
    std::int64_t before = 0;     ///< only batches with a number below this; 0: all
    int limit = 50;
    int changes = 10;  ///< maximum number of values listed of each
};

/// One value that a person changed.
struct ChangeRecord {
    std::int64_t batch = 0;
    std::int64_t made_at = 0;  ///< seconds since 1970, UTC
    Author author;
    std::string command;         ///< as in ChangeReport
    std::string asked;           ///< which models were meant, in words
    std::int64_t undoes = 0;     ///< of an undo or redo: the batch that it is about
    std::int64_t undone_by = 0;  ///< the undo that is in force; 0: none
    std::string model_key, model_name;
    std::string attribute;
    std::optional<attributes::AttributeValue> before, after;  ///< none: the automatic value acted
};

/// An act: how much it changed, and the first of its values, which say who, when and what.
struct ChangeBatchRecord {
    std::size_t values = 0, models = 0;
    std::vector<ChangeRecord> changes;  ///< at least one, those of the model that was asked for
};

}  // namespace embody::catalog
