// SPDX-License-Identifier: MIT
import type { Parts } from "../parts";
import type { UserAction } from "../tools/actions";
import { keysOf } from "../tools/keys";
import { openDialog } from "./dialogs";
import { element } from "./element";
import { t } from "../language";

/** The command palette: type a part of a name, Enter runs the marked command. */
export function openPalette(parts: Pick<Parts, "preferences">, actions: readonly UserAction[]): void {
  let marked = 0;
  let found: UserAction[] = [];
  const list = element("ul", { role: "listbox", id: "palette-list", class: "palette-list" });
  const words = element("input", {
    type: "text",
    placeholder: t("What do you want to do?"),
    role: "combobox",
    "aria-expanded": "true",
    "aria-controls": "palette-list",
    "aria-label": t("Command"),
    "data-testid": "palette-input",
    oninput: () => fill(),
    onkeydown: (event: KeyboardEvent) => key(event),
  });
  const dialog = openDialog(t("All commands"), "palette", words, list);

  const run = (action: UserAction): void => {
    dialog.close();
    if (action.possible?.() ?? true) action.run();
  };
  const fill = (): void => {
    const wanted = words.value.toLowerCase().split(/\s+/).filter(Boolean);
    found = actions.filter((action) => {
      const text = `${action.group} ${action.label}`.toLowerCase();
      return action.id !== "view.palette" && wanted.every((word) => text.includes(word));
    });
    marked = 0;
    list.replaceChildren(
      ...found.map((action) =>
        element(
          "li",
          { role: "option", "aria-disabled": String(!(action.possible?.() ?? true)), onclick: () => run(action) },
          element("span", { class: "note" }, action.group),
          element("span", {}, action.label),
          element("kbd", {}, keysOf(parts, action)[0] ?? ""),
        ),
      ),
    );
    if (found.length === 0) list.append(element("li", { class: "note" }, t("No command has these words")));
    mark();
  };
  const mark = (): void => {
    [...list.children].forEach((row, at) => row.setAttribute("aria-selected", String(at === marked)));
    list.children[marked]?.scrollIntoView({ block: "nearest" });
  };
  const key = (event: KeyboardEvent): void => {
    if (event.key === "ArrowDown") marked = Math.min(marked + 1, found.length - 1);
    else if (event.key === "ArrowUp") marked = Math.max(marked - 1, 0);
    else if (event.key === "Enter") {
      const action = found[marked];
      if (action) run(action);
    } else return;
    event.preventDefault();
    mark();
  };
  fill();
  words.focus();
}
