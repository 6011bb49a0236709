// SPDX-License-Identifier: MIT
import type { Notices } from "./connection/notices";
import type { ModelChoice } from "./connection/messages";
import type { Server } from "./connection/server";
import type { Motion } from "./document/motion";
import type { People } from "./document/people";
import type { PickedModel } from "./document/picked_model";
import type { Opening } from "./document/opening";
import type { Playback } from "./document/playback";
import type { Take } from "./document/take";
import type { SceneDocument } from "./document/scene_document";
import type { Selection } from "./document/selection";
import type { Warnings } from "./document/warnings";
import type { Preferences } from "./preferences";
import type { EntityView } from "./view/entity_view";
import type { Framing } from "./view/framing";
import type { ModelStore } from "./view/model_store";
import type { View } from "./view/view";

/** The result of a search in the model browser. */
export interface Found {
  models: ModelChoice;
  /** Description of the search, such as “chair” in beds. */
  text: string;
}

/** The objects that a page has one of. A panel or tool takes `Pick<Parts, …>`, so that its signature says what it may use. */
export interface Parts {
  readonly preferences: Preferences;
  readonly server: Server;
  readonly notices: Notices;
  readonly document: SceneDocument;
  readonly playback: Playback;
  readonly take: Take;
  readonly selection: Selection;
  readonly picked: PickedModel;
  readonly people: People;
  readonly opening: Opening;
  readonly warnings: Warnings;
  found: Found;
  readonly motion: Motion;
  readonly models: ModelStore;
  readonly entities: EntityView;
  readonly view: View;
  readonly framing: Framing;
}
