// SPDX-License-Identifier: MIT
import type { ModelSummary, NewEntity } from "../connection/messages";

/** What a model of the database becomes in the scene. */
export function entityOf(model: ModelSummary): NewEntity {
  return { model: model.key };
}
