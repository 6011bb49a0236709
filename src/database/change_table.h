// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "database/attribute_table.h"

namespace embody::database {

/// One act of a person: what was changed by hand at once.
struct ChangeBatch {
    std::int64_t id = 0;       ///< given by the database, rising
    std::int64_t made_at = 0;  ///< seconds since 1970, UTC; given by the database
    std::string person, session, command, asked;
    std::int64_t undoes = 0;     ///< of an undo or redo: the batch that it is about
    std::int64_t undone_by = 0;  ///< the undo that is in force; 0: none
};

/// One value that a batch changed.
struct ManualChange {
    std::int64_t id = 0;  ///< given by the database, rising
    std::string model_key, name;
    std::optional<ManualAttribute> before;  ///< none: there was no manual value
    std::optional<std::string> value;       ///< after it, as JSON; none: there is no manual value any more
};

/// A change with its batch.
struct RecordedChange {
    ManualChange change;
    ChangeBatch batch;
    std::string model_name;  ///< empty where the model is not in the database now
};

struct ChangeSearch {
    std::string model_key = {};  ///< empty: all
    std::int64_t since = 0;      ///< seconds since 1970, UTC
    std::int64_t batch = 0;      ///< 0: all
    int limit = 100;
};

/// A batch and how much it changed.
struct CountedBatch {
    ChangeBatch batch;
    std::int64_t values = 0, models = 0;
};

struct BatchSearch {
    std::string model_key = {};  ///< that it changed; empty: all
    std::int64_t since = 0;      ///< seconds since 1970, UTC
    std::int64_t after = 0;      ///< only numbers above this
    std::int64_t before = 0;     ///< only numbers below this; 0: all
    int limit = 50;
};

/// The audit of manual changes. Writers are to be called inside a Transaction.
class ChangeTable {
public:
    explicit ChangeTable(Connection& connection) : connection_(connection) {}

    /// Returns the batch's id.
    Result<std::int64_t> begin_batch(const ChangeBatch& batch);
    Result<void> add(std::int64_t batch, const ManualChange& change);
    /// Stores which undo reverted the batch; 0: it is in force again.
    Result<void> mark_undone(std::int64_t batch, std::int64_t undone_by);

    Result<std::optional<ChangeBatch>> find_batch(std::int64_t id);
    /// The last batch of this person that can be undone: no undo itself, and not undone.
    Result<std::optional<ChangeBatch>> last_batch(std::string_view person);
    /// All changes in the order in which they were made.
    Result<std::vector<ManualChange>> changes_of(std::int64_t batch);
    /// The batch that last changed the same value after `change` and is in force; undo and redo do not count.
    Result<std::optional<ChangeBatch>> changed_since(const ManualChange& change);
    /// Changes, newest first.
    Result<std::vector<RecordedChange>> search(const ChangeSearch& search);
    /// Batches, newest first.
    Result<std::vector<CountedBatch>> batches(const BatchSearch& search);
    /// The number of the newest batch; 0: none.
    Result<std::int64_t> newest_batch();

private:
    Connection& connection_;
};

}  // namespace embody::database
