// SPDX-License-Identifier: MIT
import type { ModelSummary, NewEntity } from "../connection/messages";

/** The entity that is added for a model of the database. */
export function entityOf(model: ModelSummary): NewEntity {
  return { model: model.key };
}
