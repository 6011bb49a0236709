// SPDX-License-Identifier: MIT
import "./style/theme.css";
import "./style/layout.css";
import "./style/panels.css";
import "./style/build.css";
import "./style/narrow.css";
import "./style/time.css";
import "./style/values.css";
import { ActionList } from "./panels/action_list";
import { ArrayCard } from "./panels/array_card";
import { ArrangeBar } from "./panels/arrange_bar";
import { AttributeList } from "./panels/attribute_list";
import { BuildBar, buildActions } from "./panels/build_bar";
import { openContextMenu } from "./panels/context_menu";
import { DragIn } from "./panels/drag_in";
import { element, show } from "./panels/element";
import { EntityFields } from "./panels/entity_fields";
import { FileDrop } from "./panels/file_drop";
import { openHelp } from "./panels/help";
import { openHistory } from "./panels/history";
import { HeadsetButtons } from "./panels/headset_buttons";
import { Hierarchy } from "./panels/hierarchy";
import { JointFields } from "./panels/joint_fields";
import { Layout } from "./panels/layout";
import { LevelBar, planActions } from "./panels/level_bar";
import { LibraryProgress } from "./panels/library_progress";
import { ModelBrowser } from "./panels/model_browser";
import { LookFields } from "./panels/look_fields";
import { ModelFields } from "./panels/model_fields";
import { openOptions } from "./panels/options_menu";
import { Overlays } from "./panels/overlays";
import { openPalette } from "./panels/palette";
import { PeopleBar } from "./panels/people_bar";
import { PeopleCards } from "./panels/people_cards";
import { PinFields } from "./panels/pin_fields";
import { PortFields } from "./panels/port_fields";
import { offerRecoveries } from "./panels/recovery";
import { newScene, openRecovery, openScenes, openVersions, saveAs, saveScene, saveVersion } from "./panels/scene_dialogs";
import { SceneFields } from "./panels/scene_fields";
import { SelectionOverlays } from "./panels/selection_overlays";
import { StatusBar } from "./panels/status_bar";
import { Toasts } from "./panels/toasts";
import { Toolbar } from "./panels/toolbar";
import { Tour } from "./panels/tour";
import { ValueSearch } from "./panels/value_search";
import { ValueTools } from "./panels/value_tools";
import { Studio } from "./studio";
import { offerTestHook } from "./test_hook";
import { timeActions } from "./time/time_actions";
import { Recorder } from "./time/recorder";
import { Timeline } from "./time/timeline";
import { BuildTool } from "./tools/build_tool";
import { Measures } from "./tools/measures";
import { keepPoses, makeActions, type UserAction } from "./tools/actions";
import { Gizmo } from "./tools/gizmo";
import { JointTool } from "./tools/joint_tool";
import { Keyboard } from "./tools/keys";
import { Pointer } from "./tools/pointer";
import { ContactSounds } from "./tools/contact_sounds";
import { Touches } from "./tools/touches";
import { VrSession } from "./vr/session";
import { t } from "./language";

const canvas = element("canvas", { tabindex: 0, "aria-label": t("The scene"), "data-testid": "canvas" });
const scene = element("main", { id: "scene" }, canvas);
const app = document.getElementById("app")!;
app.append(scene);

try {
  start();
} catch (error) {
  // Without WebGL only the reason can be shown.
  scene.replaceChildren(
    element("div", { class: "lost", role: "alert" }, element("strong", {}, t("The Studio cannot draw here")), element("p", {}, t("{{message}} The browser needs WebGL 2.", { message: (error as Error).message }))),
  );
}

function start(): void {
  const studio = new Studio(canvas);
  const gizmo = new Gizmo(studio);
  const build = new BuildTool(studio);
  const pointer = new Pointer(studio, gizmo);
  new Measures(studio);
  const dragIn = new DragIn(studio);
  const browser = new ModelBrowser(studio, dragIn);
  const left = leftPanel(browser, new Hierarchy(studio), new LibraryProgress(studio));

  const actions: UserAction[] = makeActions(studio, gizmo, pointer, {
    scenes: () => void openScenes(studio),
    save: () => void saveScene(studio),
    saveAs: () => void saveAs(studio),
    saveVersion: () => saveVersion(studio),
    versions: () => void openVersions(studio),
    newScene: () => void newScene(studio),
    history: () => openHistory(studio),
    help: () => openHelp(studio, actions),
    palette: () => openPalette(studio, actions),
    search: () => {
      left.showModels();
      browser.focusSearch();
    },
  });
  const array = new ArrayCard(studio);
  scene.append(array.root);
  actions.push({ id: "arrange.array", label: t("Copies in rows…"), group: t("Arrange"), keys: ["Ctrl+Shift+D"], icon: "copy", possible: () => studio.selection.indices.length > 0, run: () => array.open() });
  actions.push({ id: "view.options", label: t("View options…"), group: t("View"), keys: [], icon: "options", run: () => openOptions(studio, actions, headsetButtons.offer) });

  const building = buildActions(build);
  const recorder = new Recorder(studio);
  actions.push(...building, ...planActions(studio), ...timeActions(studio, recorder, () => void keepPoses(studio)));
  new Keyboard(studio, actions, pointer);
  pointer.menuWanted.on((at) => openContextMenu(studio, actions, at));
  new FileDrop(studio, () => browser.refresh());
  const toolbar = new Toolbar(studio, gizmo, actions, new PeopleBar(studio).root);
  const timeline = new Timeline(studio, actions);
  studio.connection.frame.on(() => timeline.tick());
  const entityFields = new EntityFields(studio);
  const attributes = new AttributeList(studio);
  const joints = new JointTool(studio, gizmo);
  const right = element("aside", { class: "panel right", "aria-label": t("Properties"), "data-testid": "properties" });
  right.append(
    new ValueSearch(studio, right).root,
    new SceneFields(studio).root,
    new ModelFields(studio).root,
    entityFields.head,
    attributes.essentials,
    new ValueTools(studio).root,
    new SelectionOverlays(studio).root,
    entityFields.root,
    new LookFields(studio).root,
    new PortFields(studio).root,
    new PinFields(studio).root,
    attributes.root,
    new JointFields(studio, joints).root,
    new ActionList(studio).root,
  );
  app.append(toolbar.root, left.root, right, timeline.plots.root, new StatusBar(studio).root);
  const layout = new Layout(studio, app, scene, { left: left.root, right });
  actions.push(...layout.actions);
  dragIn.began.on(() => layout.freeScene());
  new Touches(canvas, studio.view.rig, pointer);
  const tour = new Tour(studio, pointer.grabbed);
  actions.push({ id: "view.tour", label: t("First steps"), group: t("View"), keys: [], run: () => tour.begin() });
  scene.append(timeline.root, recorder.root, new Overlays(studio).root, new PeopleCards(studio).root, new ArrangeBar(studio, actions).root, tour.root, new BuildBar(studio, build, building).root, new LevelBar(studio, build).root);
  build.changed.on(() => toolbar.refresh());
  studio.view.rig.planned.on(() => toolbar.refresh());
  document.body.append(new Toasts(studio).root);

  const setTheme = () => (document.documentElement.dataset["theme"] = studio.preferences.get("theme"));
  studio.historyWanted.on(() => openHistory(studio));
  studio.recovered.on((found) => offerRecoveries(studio, found, (name) => void openRecovery(studio, name)));
  studio.preferences.changed.on(setTheme);
  setTheme();
  addEventListener("beforeunload", (event) => {
    // While others are here the scene stays open.
    if (studio.document.unsaved && studio.people.others.length === 0) event.preventDefault();
  });
  const sounds = new ContactSounds(studio);
  const headset = new VrSession(studio, actions, sounds);
  headset.changed.on(() => gizmo.show(!headset.isRunning));
  const headsetButtons = new HeadsetButtons(studio, headset);
  scene.append(headsetButtons.root);
  studio.connection.event.on((event) => {
    if (event.event === "impacts") sounds.take(event.impacts);
    else if (event.event === "hand" && headset.isRunning) headset.interaction.shake(event.hand, event.impulse);
  });
  offerTestHook(studio, headset, sounds, timeline, joints);
  studio.connection.open();
}

/** Two tabs: the models of the database, and the entities of the scene; above both how far the library is filled. */
function leftPanel(browser: ModelBrowser, hierarchy: Hierarchy, progress: LibraryProgress): { root: HTMLElement; showModels(): void } {
  const pages = [
    { id: "Models", name: t("Models"), root: browser.root },
    { id: "In the scene", name: t("In the scene"), root: hierarchy.root },
  ];
  const choose = (chosen: HTMLElement): void => {
    pages.forEach(({ root }, at) => {
      show(root, root === chosen);
      tabs[at]!.setAttribute("aria-selected", String(root === chosen));
    });
  };
  const tabs = pages.map(({ id, name, root }) => element("button", { role: "tab", "data-testid": `tab-${id}`, onclick: () => choose(root) }, name));
  choose(browser.root);
  const root = element(
    "aside",
    { class: "panel left", "aria-label": t("Models and entities") },
    element("div", { class: "tabs", role: "tablist" }, ...tabs),
    progress.root,
    ...pages.map((page) => page.root),
  );
  return { root, showModels: () => choose(browser.root) };
}
