// SPDX-License-Identifier: MIT
#pragma once

#include "catalog/manual_change.h"
#include "database/change_table.h"
#include "database/model_table.h"
#include "foundation/result.h"

namespace embody::catalog {

/// Changes that persons make to models, each act all or nothing and kept in the audit.
class ManualChanges {
public:
    /// `list_again` renews category, subcategory and kind in the row of a model, inside the transaction.
    ManualChanges(database::Connection& connection, std::function<Result<void>(std::int64_t id)> list_again);

    /// The models of a selection, best match first. Called inside the transaction, so that no model comes in between.
    using Choose = std::function<Result<std::vector<database::ModelRow>>(database::ModelTable&)>;

    /// `asked` says in words which models are meant.
    Result<ChangeReport> change(const Choose& choose, const std::vector<AttributeChange>& changes,
                                const ChangeOptions& options, const Author& author, const std::string& asked);
    /// Reverts the batch; of an undo: repeats what it reverted. 0: the author's last.
    Result<ChangeReport> undo(std::int64_t batch, const ChangeOptions& options, const Author& author);
    /// Newest first.
    Result<std::vector<ChangeRecord>> history(const HistoryQuery& query);
    Result<std::vector<ChangeBatchRecord>> batches(const BatchQuery& query);
    /// The number of the newest batch; 0: none.
    Result<std::int64_t> newest_batch() { return audit_.newest_batch(); }

private:
    struct Step;
    Result<std::vector<Step>> plan(const database::ModelRow& model, const std::vector<AttributeChange>& changes,
                                   const ChangeOptions& options, std::vector<RefusedChange>& refused);
    Result<void> carry_out(std::vector<Step>& steps, const database::ChangeBatch& batch, const ChangeOptions& options,
                           ChangeReport& report);
    Result<void> carry_out(const Step& step, std::int64_t batch);
    Result<database::ChangeBatch> meant(std::int64_t batch, const Author& author);
    Result<std::vector<Step>> plan_undo(const database::ChangeBatch& target, bool again, ChangeReport& report);

    database::Connection& connection_;
    database::ModelTable models_;
    database::ManualAttributeTable manual_;
    database::ChangeTable audit_;
    std::function<Result<void>(std::int64_t)> list_again_;
};

}  // namespace embody::catalog
